#include "polygonize/tube_mesh.h"

#include "polygonize/mesh_border.h"
#include "polygonize/tube_join.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace cambium {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
constexpr std::size_t kRunsPerTask = 8;

struct BuiltTube {
  Tube tube;
  double largest_error = 0;
  std::array<bool, 2> joined{false, false};   // at its ends
  bool sound() const { return joined[0] && joined[1]; }
};

/// Of a run: the loop at its begin and at its end.
struct Ends {
  std::array<std::uint32_t, 2> loops{};
  std::array<int, 2> count{0, 0};
};

class TubeBuilder {
 public:
  TubeBuilder(const TubeRuns& runs, const MeshBorder& border, double tolerance, const Mesh& mesh)
      : runs_(runs), border_(border), tolerance_(tolerance), mesh_(mesh) {}

  /// Not joined if cancelled.
  BuiltTube build(const TubeRun& run, const Ends& ends, const RunOptions& options) const {
    if (ends.count != std::array<int, 2>{1, 1}) return {};
    const ChainPath& path = runs_.path(run);
    BuiltTube built;
    Tube& tube = built.tube;
    std::vector<std::uint32_t> first;   // vertex of each ring
    for (const TubeRing& ring : run.rings) {
      if (options.cancelled()) return built;
      for (std::uint32_t k = 0; k < ring.sides; ++k) {
        const std::uint32_t vertex = tube.add(ring_corner(path, ring, k));
        if (k == 0) first.push_back(vertex);
      }
    }
    for (std::size_t i = 0; i + 1 < run.rings.size(); ++i) {
      const std::size_t begin = tube.triangles.size();
      add_wall(first[i], run.rings[i].sides, first[i + 1], run.rings[i + 1].sides, tube.triangles);
      measure(path, begin, (run.rings[i].at + run.rings[i + 1].at) / 2, built);
    }
    const std::size_t walls = tube.triangles.size();
    built.joined[0] = join(run, ends, 0).add_to(tube, first.front());
    measure(path, walls, run.rings.front().at, built);
    const std::size_t others = tube.triangles.size();
    built.joined[1] = join(run, ends, 1).add_to(tube, first.back());
    measure(path, others, run.rings.back().at, built);
    return built;
  }

  TubeJoin join(const TubeRun& run, const Ends& ends, int end) const {
    return {runs_.path(run), end ? run.rings.back() : run.rings.front(), end == 1, mesh_, border_, ends.loops[end], tolerance_};
  }

 private:
  // Whichever of the next corners comes first around is taken first.
  static void add_wall(std::uint32_t lower, std::uint32_t lower_sides, std::uint32_t upper, std::uint32_t upper_sides,
                       std::vector<Triangle>& triangles) {
    for (std::uint32_t i = 0, j = 0; i < lower_sides || j < upper_sides;) {
      const std::uint32_t a = lower + i % lower_sides, b = upper + j % upper_sides;
      const bool from_lower = std::uint64_t{2 * i + 1} * upper_sides <= std::uint64_t{2 * j + 1} * lower_sides;
      if (j == upper_sides || (i < lower_sides && from_lower)) {
        triangles.push_back({a, lower + (i + 1) % lower_sides, b});
        ++i;
      } else {
        triangles.push_back({a, upper + (j + 1) % upper_sides, b});
        ++j;
      }
    }
  }

  // Triangles from `begin` on, which are near `at` on the chain.
  void measure(const ChainPath& path, std::size_t begin, double at, BuiltTube& built) const {
    const Tube& tube = built.tube;
    for (std::size_t t = begin; t < tube.triangles.size(); ++t) {
      const auto corner = [&](int k) { return tube.position(mesh_, tube.triangles[t][k]); };
      built.largest_error = std::max(built.largest_error, path.distance_of(corner(0), corner(1), corner(2), at));
    }
  }

  const TubeRuns& runs_;
  const MeshBorder& border_;
  const double tolerance_;
  const Mesh& mesh_;
};

/// By run, the loops at its ends. Loops that belong to none leave some end without one.
std::vector<Ends> assign_loops(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& contour, const TubeRuns& runs,
                               const MeshBorder& border, const Mesh& mesh) {
  std::vector<Ends> ends(runs.size());
  for (std::uint32_t loop = 0; loop < border.loops.size(); ++loop) {
    for (const std::uint32_t vertex : border.loops[loop]) {
      if (vertex >= contour.patches.size()) continue;   // on a face between two others
      const std::uint32_t cell = tree.leaves()[contour.patches[vertex].leaf].cell;
      const auto end = runs.nearest_end(cover.cube_field(cell), mesh.positions[vertex]);
      if (!end) continue;   // in a cell of none of their chains
      ends[end->run].loops[end->end] = loop;
      ++ends[end->run].count[end->end];
      break;
    }
  }
  return ends;
}

/// Smooths knots in the lines at the ends of tubes that failed: quicker than to contour what they stand for.
class BorderEaser {
 public:
  BorderEaser(const SurfaceCover& cover, const Contour& contour, const MeshBorder& border, const TubeBuilder& builder, Mesh& mesh)
      : cover_(cover), border_(border), builder_(builder), mesh_(mesh), fixed_(mesh.positions.size(), 0) {
    for (std::size_t v = 0; v < contour.vertices.size(); ++v) fixed_[v] = contour.vertices[v].crease;
    fix_between_loops();
  }

  /// Builds a tube again until it fits. If it never does the mesh is as it was.
  void mend(const TubeRun& run, const Ends& ends, BuiltTube& built, const RunOptions& options) {
    if (built.sound() || ends.count != std::array<int, 2>{1, 1}) return;
    moved_.clear();
    for (int round = 0; round < kMostEased && !built.sound() && !options.cancelled(); ++round) {
      const bool untangled = ease_ends(run, ends, built.joined);
      built = builder_.build(run, ends, options);
      if (!untangled) built.joined = {false, false};
    }
    if (built.sound()) return;
    for (auto was = moved_.rbegin(); was != moved_.rend(); ++was) {
      mesh_.positions[was->vertex] = was->position;
      mesh_.normals[was->vertex] = was->normal;
    }
  }

 private:
  struct Moved {   // with what it was
    std::uint32_t vertex = 0;
    Vec3 position{0.0};
    glm::vec3 normal{0.0f};
  };

  // What is near two loops matters to two tubes.
  void fix_between_loops() {
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> loop_of(mesh_.positions.size(), kNone);
    for (std::uint32_t loop = 0; loop < border_.loops.size(); ++loop)
      for (const std::uint32_t t : border_.triangles[loop])
        for (const std::uint32_t v : mesh_.triangles[t]) {
          if (loop_of[v] != kNone && loop_of[v] != loop) fixed_[v] = 1;
          loop_of[v] = loop;
        }
  }

  bool ease_ends(const TubeRun& run, const Ends& ends, const std::array<bool, 2>& joined) {
    bool untangled = true;
    for (const int end : {0, 1}) {
      if (joined[end]) continue;
      const TubeJoin join = builder_.join(run, ends, end);
      for (const auto& [vertex, to] : join.eased()) {
        if (fixed_[vertex] || !is_surface(to.position)) continue;
        moved_.push_back({vertex, mesh_.positions[vertex], mesh_.normals[vertex]});
        mesh_.positions[vertex] = to.position;
        mesh_.normals[vertex] = glm::vec3(to.normal);
      }
      untangled = untangled && join.is_untangled();
    }
    return untangled;
  }

  // Of the whole field, not just of the chain.
  bool is_surface(const Vec3& p) {
    const auto cell = cover_.find(p);
    return cell && std::abs(evaluator_.value(cover_.cube_field(*cell), p) - kIso) < kRounding;
  }

  static constexpr int kMostEased = 4;         // times
  static constexpr double kRounding = 1e-9;    // of values of the field
  const SurfaceCover& cover_;
  const MeshBorder& border_;
  const TubeBuilder& builder_;
  Mesh& mesh_;
  std::vector<std::uint8_t> fixed_;            // by vertex: it may not move
  Evaluator evaluator_;
  std::vector<Moved> moved_;
};

}  // namespace

std::optional<TubeReport> add_tubes(const SurfaceOctree& tree, const SurfaceCover& cover, const Contour& contour, const TubeRuns& runs,
                                    double tolerance, DualMesh& built, const RunOptions& run) {
  if (runs.size() == 0) return TubeReport{};
  Mesh& mesh = built.mesh;
  std::vector<std::uint8_t> may_be_open(mesh.positions.size(), 0);
  std::fill_n(may_be_open.begin() + static_cast<std::ptrdiff_t>(contour.patches.size()), built.face_vertices, std::uint8_t{1});
  for (std::size_t p = 0; p < contour.patches.size(); ++p) may_be_open[p] = contour.patches[p].open;
  const MeshBorder border = find_border(mesh, may_be_open);
  const std::vector<Ends> ends = assign_loops(tree, cover, contour, runs, border, mesh);
  const TubeBuilder builder(runs, border, tolerance, mesh);
  std::vector<BuiltTube> tubes(runs.size());
  tbb::parallel_for(std::size_t{0}, (runs.size() + kRunsPerTask - 1) / kRunsPerTask, [&](std::size_t task) {
    for (std::size_t i = task * kRunsPerTask; i < std::min(runs.size(), (task + 1) * kRunsPerTask) && !run.cancelled(); ++i) {
      tubes[i] = builder.build(runs[i], ends[i], run);
    }
  });
  if (run.cancelled()) return std::nullopt;
  if (std::any_of(tubes.begin(), tubes.end(), [](const BuiltTube& tube) { return !tube.sound(); })) {
    BorderEaser easer(cover, contour, border, builder, mesh);
    for (std::size_t i = 0; i < tubes.size(); ++i) easer.mend(runs[i], ends[i], tubes[i], run);   // few need it
  }
  if (run.cancelled()) return std::nullopt;
  TubeReport report;
  for (std::uint32_t i = 0; i < tubes.size(); ++i)
    if (!tubes[i].sound()) report.failed.push_back(i);
  if (!report.failed.empty()) return report;
  for (BuiltTube& built_tube : tubes) {
    const Tube tube = std::move(built_tube.tube);
    const auto before = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), tube.positions.begin(), tube.positions.end());
    mesh.normals.insert(mesh.normals.end(), tube.normals.begin(), tube.normals.end());
    for (Triangle corners : tube.triangles) {
      for (std::uint32_t& v : corners)
        if (v & Tube::kOwn) v = before + (v & ~Tube::kOwn);
      mesh.triangles.push_back(corners);
    }
    report.largest_error = std::max(report.largest_error, built_tube.largest_error);
  }
  return report;
}

}  // namespace cambium
