#include "polygonize/surface_places.h"

#include "blobtree/progress_meter.h"
#include "blobtree/surface_cover.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace cambium {
namespace {

constexpr std::size_t kChunk = 1024;   // vertices of a task: neighbours in space, so its results are small and its tapes few

/// Vertices in the order of the cover's cells, those in no cell last.
struct ByCell {
  std::vector<std::uint32_t> cell;       ///< by vertex
  std::vector<std::uint32_t> vertices;
};

ByCell sort_by_cell(const Mesh& mesh, const SurfaceCover& cover, const RunOptions& run) {
  ByCell sorted;
  const std::size_t n = mesh.positions.size();
  const auto none = static_cast<std::uint32_t>(cover.size());
  sorted.cell.assign(n, none);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, 4096), [&](const auto& range) {
    if (run.cancelled()) return;
    Box cube;
    std::uint32_t cell = none;
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const Vec3& p = mesh.positions[i];
      // Most neighbours in a mesh share a cell.
      const bool same = cell != none && glm::all(glm::greaterThanEqual(p, cube.lo)) && glm::all(glm::lessThan(p, cube.hi));
      if (!same) {
        const std::optional<std::size_t> found = cover.find(p);
        cell = found ? static_cast<std::uint32_t>(*found) : none;
        if (found) cube = cover.cube(*found);
      }
      sorted.cell[i] = cell;
    }
  });
  std::vector<std::uint32_t> next(cover.size() + 2, 0);
  for (const std::uint32_t cell : sorted.cell) ++next[cell + 1];
  for (std::size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];
  sorted.vertices.resize(n);
  for (std::size_t i = 0; i < n; ++i) sorted.vertices[next[sorted.cell[i]]++] = static_cast<std::uint32_t>(i);
  return sorted;
}

/// One thread's share of the work.
class VertexReader {
 public:
  void read(const PrunedField& field, const Mesh& mesh, std::uint32_t vertex, const SurfaceColor& color, MeshAttributes& out,
            std::vector<SurfacePlace>& places) {
    const Vec3& p = mesh.positions[vertex];
    evaluator_.contributions(field, p, contributions_);
    if (color) out.colors[vertex] = color(evaluator_, field, p, Vec3(mesh.normals[vertex]));
    // A ridge takes two that meet.
    if (contributions_.size() > 1) out.ridge[vertex] = static_cast<float>(evaluator_.surface_traits(field, p).ridge);
    keep_axes();
    if (contributions_.empty()) return;
    double total = 0, radius = 0, arc = 0;
    for (const Contribution& c : contributions_) {
      total += c.weight;
      radius += c.weight * c.radius;
      arc += c.weight * c.v;
    }
    out.radius[vertex] = static_cast<float>(radius / total);
    out.arc_length[vertex] = static_cast<float>(arc / total);
    const Contribution& main = contributions_[heaviest()];
    out.branch[vertex] = main.branch;
    out.order[vertex] = main.order;
    add(main, places);
    for (const Contribution& c : contributions_)
      if (&c != &main) add(c, places);
  }

 private:
  /// The stub of a scar carries its branch's id, but its coordinates are its own: of one branch what is much thinner than the
  /// rest is not the branch itself.
  void keep_axes() {
    constexpr double kThinner = 0.75;
    if (contributions_.size() < 2) return;
    thick_.clear();
    for (const Contribution& c : contributions_) {
      double most = 0;
      for (const Contribution& other : contributions_)
        if (other.branch == c.branch) most = std::max(most, other.radius);
      if (c.radius >= kThinner * most) thick_.push_back(c);
    }
    contributions_.swap(thick_);
  }

  /// The heaviest primitive of the heaviest branch; of equals the first.
  std::size_t heaviest() const {
    std::size_t best = 0;
    double best_branch = -1;
    for (std::size_t i = 0; i < contributions_.size(); ++i) {
      double of_branch = 0;
      for (const Contribution& c : contributions_)
        if (c.branch == contributions_[i].branch) of_branch += c.weight;
      const bool heavier = of_branch > best_branch ||
                           (of_branch == best_branch && contributions_[i].weight > contributions_[best].weight);
      if (heavier) {
        best = i;
        best_branch = of_branch;
      }
    }
    return best;
  }

  static void add(const Contribution& c, std::vector<SurfacePlace>& places) {
    places.push_back({c.primitive, c.branch, static_cast<float>(c.weight), static_cast<float>(c.u), static_cast<float>(c.v),
                      static_cast<float>(c.radius), static_cast<float>(c.from_axis), c.order});
  }

  Evaluator evaluator_;
  std::vector<Contribution> contributions_, thick_;
};

void resize_for(const Mesh& mesh, bool colors, MeshAttributes& out) {
  const std::size_t n = mesh.positions.size();
  out.branch.assign(n, 0);
  out.order.assign(n, 0);
  out.radius.assign(n, 0);
  out.arc_length.assign(n, 0);
  out.ridge.assign(n, 0);
  out.colors.assign(colors ? n : 0, {});
}

}  // namespace

std::optional<SurfacePlaces> surface_places(const Field& field, const Mesh& mesh, const SurfaceColor& color, MeshAttributes& out,
                                            const RunOptions& run) {
  resize_for(mesh, static_cast<bool>(color), out);
  const std::size_t n = mesh.positions.size();
  SurfacePlaces found;
  found.first.assign(n, 0);
  found.count.assign(n, 0);
  if (n == 0) return found;
  const auto cover = cover_surface(field, {}, run);
  if (!cover) return std::nullopt;
  const ByCell sorted = sort_by_cell(mesh, *cover, run);
  if (run.cancelled()) return std::nullopt;

  ProgressMeter progress(run, "reading attributes");
  const std::size_t chunks = (n + kChunk - 1) / kChunk;
  std::vector<std::vector<SurfacePlace>> parts(chunks);
  tbb::enumerable_thread_specific<VertexReader> readers;
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
    if (run.cancelled()) return;
    VertexReader& reader = readers.local();
    PrunedField pruned;
    std::uint32_t cell = 0;
    const std::size_t begin = chunk * kChunk, end = std::min(n, begin + kChunk);
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t vertex = sorted.vertices[i], at = sorted.cell[vertex];
      const bool outside = at == cover->size();
      // A vertex that is not quite on the surface may lie beside every cell of it.
      if (outside) pruned = field.prune(Box{mesh.positions[vertex], mesh.positions[vertex]});
      else if (i == begin || at != cell) pruned = cover->field(at);
      cell = at;
      const std::size_t before = parts[chunk].size();
      reader.read(pruned, mesh, vertex, color, out, parts[chunk]);
      found.first[vertex] = static_cast<std::uint32_t>(before);
      found.count[vertex] = static_cast<std::uint8_t>(std::min<std::size_t>(parts[chunk].size() - before, 255));
      if (color && run.cancelled()) return;
    }
    progress.add(1.0 / static_cast<double>(chunks));
  });
  if (run.cancelled()) return std::nullopt;

  std::vector<std::size_t> first_place(chunks + 1, 0);
  for (std::size_t i = 0; i < chunks; ++i) first_place[i + 1] = first_place[i] + parts[i].size();
  found.places.resize(first_place.back());
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
    std::copy(parts[chunk].begin(), parts[chunk].end(), found.places.begin() + static_cast<std::ptrdiff_t>(first_place[chunk]));
    for (std::size_t i = chunk * kChunk; i < std::min(n, (chunk + 1) * kChunk); ++i)
      found.first[sorted.vertices[i]] += static_cast<std::uint32_t>(first_place[chunk]);
    parts[chunk] = {};
  });
  progress.finish();
  return found;
}

}  // namespace cambium
