#include "polygonize/surface_places.h"

#include "blobtree/progress_meter.h"
#include "blobtree/surface_cover.h"
#include "polygonize/vertex_spacing.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr std::size_t kChunk = 1024;   // vertices of a task: mostly neighbours in space, so its results are small and its tapes few

/// The field around one vertex after the other.
class FieldAround {
 public:
  FieldAround(const Field& field, const SurfaceCover& cover) : field_(field), cover_(cover) {}

  const PrunedField& at(const Vec3& p) {
    // Most neighbours in a mesh share a cell.
    if (glm::all(glm::greaterThanEqual(p, cube_.lo)) && glm::all(glm::lessThan(p, cube_.hi))) return pruned_;
    if (const auto cell = cover_.find(p)) {
      cube_ = cover_.cube(*cell);
      pruned_ = cover_.field(*cell);
    } else {   // a vertex that is not quite on the surface may lie beside every cell of it
      cube_ = {};
      pruned_ = field_.prune(Box{p, p});
    }
    return pruned_;
  }

 private:
  const Field& field_;
  const SurfaceCover& cover_;
  Box cube_;
  PrunedField pruned_;
};

/// Colours of vertices, where they are asked for.
class VertexColors {
 public:
  VertexColors(const Mesh& mesh, const SurfaceColor& color, const RunOptions& run)
      : mesh_(mesh), color_(color), spacing_(color ? vertex_spacing(mesh, run) : std::vector<float>{}) {}

  explicit operator bool() const { return static_cast<bool>(color_); }
  std::array<std::uint8_t, 4> at(std::uint32_t vertex, std::span<const Contribution> contributions, const SurfaceTraits& traits) const {
    return color_(contributions, traits, {mesh_.positions[vertex], Vec3(mesh_.normals[vertex]), spacing_[vertex]});
  }

 private:
  const Mesh& mesh_;
  const SurfaceColor& color_;
  const std::vector<float> spacing_;
};

/// One thread's share of the work.
class VertexReader {
 public:
  void read(const PrunedField& field, const Mesh& mesh, std::uint32_t vertex, const VertexColors& colors, MeshAttributes& out,
            std::vector<SurfacePlace>& places) {
    const Vec3& p = mesh.positions[vertex];
    evaluator_.contributions(field, p, contributions_);
    // A ridge takes two that meet.
    const bool meeting = contributions_.size() > 1;
    const SurfaceTraits traits = colors || meeting ? evaluator_.surface_traits(field, p) : SurfaceTraits{};
    if (colors) out.colors[vertex] = colors.at(vertex, contributions_, traits);
    if (meeting) out.ridge[vertex] = static_cast<float>(traits.ridge);
    keep_axes();
    if (contributions_.empty()) return;
    share_out();
    double radius = 0, arc = 0;
    for (const Contribution& c : contributions_) {
      radius += c.weight * c.radius;
      arc += c.weight * c.v;
    }
    out.radius[vertex] = static_cast<float>(radius);
    out.arc_length[vertex] = static_cast<float>(arc);
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

  /// Makes shares of the weights, which add up to 1: the vertex belongs to the primitive whose own surface is nearest, and changes
  /// over to another within the thinner one's radius. The field's weights themselves would give a thin twig to the trunk as far
  /// as the trunk's support reaches, several of the twig's diameters along it.
  void share_out() {
    if (contributions_.size() == 1) {
      contributions_[0].weight = 1;
      return;
    }
    constexpr double kLeast = 1e-6;   // whatever contributes has some share
    const Contribution* nearest = &contributions_[0];
    for (Contribution& c : contributions_) {
      // Back from the weight to the distance from its own surface, which is that far out for a primitive by itself.
      const double radii = kSupportPerRadius * std::sqrt(std::max(0.0, 1 - std::cbrt(std::min(c.weight, 1.0))));
      c.weight = std::max(0.0, (radii - 1) * c.radius);
      if (c.weight < nearest->weight) nearest = &c;
    }
    const double best = nearest->weight, radius = nearest->radius;
    double total = 0;
    for (Contribution& c : contributions_) {
      const double farther = (c.weight - best) / std::max(std::min(c.radius, radius), 1e-12);
      c.weight = std::max(kLeast, 1 - farther);
      total += c.weight;
    }
    for (Contribution& c : contributions_) c.weight /= total;
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
  const VertexColors colors(mesh, color, run);
  ProgressMeter progress(run, "reading attributes");
  const std::size_t chunks = (n + kChunk - 1) / kChunk;
  std::vector<std::vector<SurfacePlace>> parts(chunks);
  tbb::enumerable_thread_specific<VertexReader> readers;
  tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
    if (run.cancelled()) return;
    VertexReader& reader = readers.local();
    FieldAround around(field, *cover);
    const std::size_t begin = chunk * kChunk, end = std::min(n, begin + kChunk);
    parts[chunk].reserve(kChunk + kChunk / 4);
    for (std::size_t i = begin; i < end; ++i) {
      const auto vertex = static_cast<std::uint32_t>(i);
      const std::size_t before = parts[chunk].size();
      reader.read(around.at(mesh.positions[i]), mesh, vertex, colors, out, parts[chunk]);
      found.first[i] = static_cast<std::uint32_t>(before);
      found.count[i] = static_cast<std::uint8_t>(std::min<std::size_t>(parts[chunk].size() - before, 255));
      if (colors && run.cancelled()) return;
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
      found.first[i] += static_cast<std::uint32_t>(first_place[chunk]);
    parts[chunk] = {};
  });
  progress.finish();
  return found;
}

}  // namespace cambium
