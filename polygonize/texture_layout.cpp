#include "polygonize/texture_layout.h"

#include "polygonize/texture_scale.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

namespace cambium {
namespace {

constexpr std::size_t kBlock = 8192;               // triangles of a task
constexpr double kTurn = 2 * std::numbers::pi;
constexpr std::uint32_t kNoPlace = 0xffffffffu;

// A place can be used in several ways by the triangles around it, each of them a bit: so many steps (wraps_of_step) more or
// fewer around than its own radius asks for, once round the seam or not; or plane, as seen along the branch, from its tip or base.
constexpr int kSteps = 3;                          // each way
constexpr int kPlane = 2 * (2 * kSteps + 1), kPlaneMirrored = kPlane + 1;
static_assert(kPlaneMirrored < 16);

/// What all vertices of one branch agree on.
struct BranchLayout {
  std::uint32_t branch = 0;
  std::complex<double> hidden{0};                  // its argument is where the branch faces the hidden side
  double least_v = kInfinity;
  double seam = 0;                                 // turns
  double v_begin = 0;                              // a whole number of repeats, so that coordinates stay small and precise
};

class TextureLayout {
 public:
  TextureLayout(const Mesh& mesh, const SurfacePlaces& places, const MeshAttributeOptions& options, MeshAttributes& out,
                const RunOptions& run)
      : mesh_(mesh), places_(places), options_(options), out_(out), run_(run) {}

  bool run() {
    find_branches();
    if (run_.cancelled()) return false;
    choose_tile();
    find_steps();
    choose_places();
    if (run_.cancelled()) return false;
    write_coordinates();
    return !run_.cancelled();
  }

 private:
  template <class Work>
  void for_blocks(std::size_t count, const Work& work) const {
    tbb::parallel_for(std::size_t{0}, (count + kBlock - 1) / kBlock, [&](std::size_t block) {
      if (!run_.cancelled()) work(block, block * kBlock, std::min(count, (block + 1) * kBlock));
    });
  }

  std::uint32_t branch_of(std::uint32_t id) const {
    const auto found =
        std::lower_bound(branches_.begin(), branches_.end(), id, [](const BranchLayout& b, std::uint32_t i) { return b.branch < i; });
    return static_cast<std::uint32_t>(found - branches_.begin());
  }

  void find_branches() {
    const auto& places = places_.places;
    const std::size_t blocks = (std::max(places.size(), mesh_.positions.size()) + kBlock - 1) / kBlock;
    std::vector<std::vector<std::uint32_t>> parts(blocks);   // ids, mostly one run after the other
    for_blocks(places.size(), [&](std::size_t block, std::size_t begin, std::size_t end) {
      auto& ids = parts[block];
      for (std::size_t i = begin; i < end; ++i)
        if (ids.empty() || places[i].branch != ids.back()) ids.push_back(places[i].branch);
      std::sort(ids.begin(), ids.end());
      ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    });
    std::vector<std::uint32_t> ids;
    for (const auto& part : parts) ids.insert(ids.end(), part.begin(), part.end());
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    for (const std::uint32_t id : ids) branches_.push_back({id, {}, kInfinity, 0, 0});
    layout_of_place_.resize(places.size());
    for_blocks(places.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const bool same = i > begin && places[i].branch == places[i - 1].branch;
        layout_of_place_[i] = same ? layout_of_place_[i - 1] : branch_of(places[i].branch);
      }
    });
    find_seams(blocks);
  }

  void find_seams(std::size_t blocks) {
    struct Run {   // of vertices of one branch
      std::uint32_t layout = 0;
      double least_v = kInfinity;
      std::complex<double> hidden{0};
    };
    std::vector<std::vector<Run>> parts(blocks);
    const glm::vec3 hidden(options_.hidden_side);
    for_blocks(mesh_.positions.size(), [&](std::size_t block, std::size_t begin, std::size_t end) {
      auto& runs = parts[block];
      for (std::size_t v = begin; v < end; ++v) {
        const SurfacePlace* const place = places_.heaviest(static_cast<std::uint32_t>(v));
        if (!place) continue;
        const std::uint32_t layout = layout_of_place_[places_.first[v]];
        if (runs.empty() || runs.back().layout != layout) runs.push_back({layout, kInfinity, {}});
        runs.back().least_v = std::min(runs.back().least_v, static_cast<double>(place->v));
        const float facing = mesh_.normals.empty() ? 0.0f : glm::dot(mesh_.normals[v], hidden);
        const float angle = static_cast<float>(kTurn) * place->turns;
        runs.back().hidden += std::complex<double>(facing * std::cos(angle), facing * std::sin(angle));
      }
    });
    // In the order of the vertices: sums that the threads do not change.
    for (const auto& runs : parts)
      for (const Run& run : runs) {
        BranchLayout& layout = branches_[run.layout];
        layout.least_v = std::min(layout.least_v, run.least_v);
        layout.hidden += run.hidden;
      }
    for (BranchLayout& layout : branches_) {
      if (std::abs(layout.hidden) > 0) layout.seam = std::arg(layout.hidden) / kTurn;
      layout.seam -= std::floor(layout.seam);
    }
  }

  void choose_tile() {
    if (options_.tile) {
      out_.tile = *options_.tile;
    } else {
      std::vector<RadiusAreas> parts((mesh_.triangles.size() + kBlock - 1) / kBlock);
      for_blocks(mesh_.triangles.size(), [&](std::size_t block, std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
          const auto& corners = mesh_.triangles[t];
          if (const SurfacePlace* place = places_.heaviest(corners[0])) parts[block].add(place->radius, area(corners));
        }
      });
      RadiusAreas areas;
      for (const RadiusAreas& part : parts) areas.add(part);
      out_.tile = areas.best_repeat() / options_.aspect;
    }
    if (!(out_.tile > 0)) out_.tile = 1;
    for (BranchLayout& layout : branches_)
      layout.v_begin = layout.least_v < kInfinity ? out_.tile * std::floor(layout.least_v / out_.tile) : 0;
  }

  double area(const std::array<std::uint32_t, 3>& corners) const {
    const Vec3& a = mesh_.positions[corners[0]];
    return 0.5 * glm::length(glm::cross(mesh_.positions[corners[1]] - a, mesh_.positions[corners[2]] - a));
  }

  int step_of(double radius) const { return step_of_wraps(kTurn * radius / (out_.tile * options_.aspect)); }
  void find_steps() {
    step_of_place_.resize(places_.places.size());
    for_blocks(step_of_place_.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) step_of_place_[i] = static_cast<std::int8_t>(step_of(places_.places[i].radius));
    });
  }
  /// From the seam on, [seam, seam + 1): where the seam lies is then all that differs between levels of detail.
  double turns_of(std::uint32_t place) const {
    const double turns = places_.places[place].turns;
    return turns < branches_[layout_of_place_[place]].seam ? turns + 1 : turns;
  }
  glm::dvec2 plane_of(std::uint32_t place, bool mirrored) const {
    const SurfacePlace& at = places_.places[place];
    const double angle = kTurn * at.turns, x = at.from_axis * std::cos(angle), y = at.from_axis * std::sin(angle);
    return {mirrored ? -x : x, y};
  }

  using Three = std::array<std::uint32_t, 3>;

  /// The place at a vertex on the primitive, or on any of the branch where `primitive` is unset; kNoPlace if it has none.
  std::uint32_t place_at(std::uint32_t vertex, std::uint32_t branch, const std::uint32_t* primitive) const {
    std::uint32_t best = kNoPlace;
    for (std::uint32_t i = places_.first[vertex]; i < places_.first[vertex] + places_.count[vertex]; ++i) {
      const SurfacePlace& place = places_.places[i];
      if (primitive ? place.primitive != *primitive : place.branch != branch) continue;
      if (best == kNoPlace || place.weight > places_.places[best].weight) best = i;
    }
    return best;
  }

  /// Corners that have no place on what was chosen get kNoPlace; all do where the field is nothing.
  Three common_places(const Three& corners) const {
    const auto only = [&](int c) { return places_.count[corners[c]] == 1; };
    if (only(0) && only(1) && only(2)) {   // nearly all
      const Three at{places_.first[corners[0]], places_.first[corners[1]], places_.first[corners[2]]};
      const std::uint32_t branch = places_.places[at[0]].branch;
      if (places_.places[at[1]].branch == branch && places_.places[at[2]].branch == branch) return at;
    }
    Three best{kNoPlace, kNoPlace, kNoPlace};
    double most = 0;
    for (const bool by_primitive : {true, false}) {
      for (const SurfacePlace& candidate : places_[corners[0]]) {
        Three found;
        double weight = 0;
        bool all = true;
        for (int c = 0; c < 3 && all; ++c) {
          found[c] = place_at(corners[c], candidate.branch, by_primitive ? &candidate.primitive : nullptr);
          all = found[c] != kNoPlace;
          if (all) weight += places_.places[found[c]].weight;
        }
        if (all && weight > most) {
          most = weight;
          best = found;
        }
      }
      if (most > 0) return best;
    }
    for (int c = 0; c < 3; ++c) {
      const SurfacePlace* const place = places_.heaviest(corners[c]);
      if (!place || place->weight <= most) continue;
      most = place->weight;
      for (int k = 0; k < 3; ++k) best[k] = place_at(corners[k], place->branch, nullptr);
    }
    return best;
  }

  /// Squared length of the gradient of v over a triangle: 1 along a branch, 0 across its end.
  double slope_of_v(const Three& corners, const Three& at) const {
    const Vec3& a = mesh_.positions[corners[0]];
    const Vec3 p = mesh_.positions[corners[1]] - a, q = mesh_.positions[corners[2]] - a, n = glm::cross(p, q);
    const double dp = static_cast<double>(places_.places[at[1]].v) - places_.places[at[0]].v;
    const double dq = static_cast<double>(places_.places[at[2]].v) - places_.places[at[0]].v;
    const double doubled = glm::dot(n, n);
    if (!(doubled > 0)) return 1;
    return (dp * dp * glm::dot(q, q) - 2 * dp * dq * glm::dot(p, q) + dq * dq * glm::dot(p, p)) / doubled;
  }

  /// How each corner uses its place; all three alike but for the seam.
  std::array<std::uint8_t, 3> uses_of(const Three& corners, const Three& at) const {
    constexpr double kFacingAlong = 0.25;          // within 30 degrees of the axis
    std::array<double, 3> turns;
    for (int c = 0; c < 3; ++c) turns[c] = turns_of(at[c]);
    std::array<int, 3> round{0, 0, 0};
    const auto spread = [&] {
      const auto [low, high] = std::minmax({turns[0] + round[0], turns[1] + round[1], turns[2] + round[2]});
      return high - low;
    };
    if (const double high = std::max({turns[0], turns[1], turns[2]}); spread() > 0.5)
      for (int c = 0; c < 3; ++c) round[c] = high - turns[c] > 0.5 ? 1 : 0;
    if (spread() > 0.5 || slope_of_v(corners, at) < kFacingAlong) {
      const glm::dvec2 a = plane_of(at[0], false), b = plane_of(at[1], false) - a, c = plane_of(at[2], false) - a;
      const std::uint8_t use = b.x * c.y - b.y * c.x < 0 ? kPlaneMirrored : kPlane;
      return {use, use, use};
    }
    const auto& place = places_.places;
    const std::array<int, 3> own{step_of_place_[at[0]], step_of_place_[at[1]], step_of_place_[at[2]]};
    const bool alike = own[0] == own[1] && own[0] == own[2];
    const int step = alike ? own[0] : step_of((place[at[0]].radius + place[at[1]].radius + place[at[2]].radius) / 3);
    std::array<std::uint8_t, 3> uses{};
    for (int c = 0; c < 3; ++c)
      uses[c] = static_cast<std::uint8_t>(2 * (std::clamp(step - own[c], -kSteps, kSteps) + kSteps) + round[c]);
    return uses;
  }

  /// Leaves places in uv_triangles and what is used of each place in used_.
  void choose_places() {
    const std::size_t n = mesh_.triangles.size();
    out_.uv_triangles.resize(n);
    out_.triangle_order.assign(n, 0);
    uses_.resize(n);
    used_.assign(places_.places.size(), 0);
    for_blocks(n, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        const Three& corners = mesh_.triangles[t];
        const Three at = common_places(corners);
        out_.uv_triangles[t] = at;
        for (const std::uint32_t place : at)
          if (place != kNoPlace)
            out_.triangle_order[t] = static_cast<std::uint16_t>(std::min<std::uint32_t>(places_.places[place].order, 0xffff));
        if (std::find(at.begin(), at.end(), kNoPlace) != at.end()) {   // every one that there is, as it comes
          some_without_.store(true, std::memory_order_relaxed);
          for (int c = 0; c < 3; ++c) uses_[t][c] = 2 * kSteps;
        } else {
          uses_[t] = uses_of(corners, at);
        }
        for (int c = 0; c < 3; ++c) {
          if (at[c] == kNoPlace) continue;
          const std::atomic_ref used(used_[at[c]]);
          const auto bit = static_cast<std::uint16_t>(1u << uses_[t][c]);
          if (!(used.load(std::memory_order_relaxed) & bit)) used.fetch_or(bit, std::memory_order_relaxed);
        }
      }
    });
  }

  void write_coordinates() {
    std::vector<std::uint32_t> first(used_.size()), of_block((used_.size() + kBlock - 1) / kBlock + 1, 0);
    for_blocks(used_.size(), [&](std::size_t block, std::size_t begin, std::size_t end) {
      std::uint32_t count = 0;
      for (std::size_t i = begin; i < end; ++i) {
        first[i] = count;
        count += static_cast<std::uint32_t>(std::popcount(used_[i]));
      }
      of_block[block + 1] = count;
    });
    std::partial_sum(of_block.begin(), of_block.end(), of_block.begin());
    out_.uvs.resize(of_block.back());
    out_.unrolled.resize(of_block.back());
    for_blocks(used_.size(), [&](std::size_t block, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        std::uint32_t at = first[i] += of_block[block];
        for (unsigned bits = used_[i]; bits; bits &= bits - 1) write_use(static_cast<std::uint32_t>(i), std::countr_zero(bits), at++);
      }
    });
    for_blocks(mesh_.triangles.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        for (int c = 0; c < 3; ++c) {
          std::uint32_t& uv = out_.uv_triangles[t][c];
          if (uv == kNoPlace) continue;
          const unsigned before = used_[uv] & ((1u << uses_[t][c]) - 1);
          uv = first[uv] + static_cast<std::uint32_t>(std::popcount(before));
        }
    });
    // Few or none: where cells are larger than what a branch reaches.
    if (!some_without_) return;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      Three& uv = out_.uv_triangles[t];
      if (std::find(uv.begin(), uv.end(), kNoPlace) == uv.end()) continue;
      const auto known = std::find_if(uv.begin(), uv.end(), [](std::uint32_t i) { return i != kNoPlace; });
      const bool none = known == uv.end();
      const glm::vec2 at = none ? glm::vec2(0.0f) : out_.uvs[*known], along = none ? glm::vec2(0.0f) : out_.unrolled[*known];
      for (std::uint32_t& i : uv) {
        if (i != kNoPlace) continue;
        i = static_cast<std::uint32_t>(out_.uvs.size());
        out_.uvs.push_back(at);
        out_.unrolled.push_back(along);
      }
    }
  }

  void write_use(std::uint32_t place, int use, std::uint32_t at) const {
    const SurfacePlace& from = places_.places[place];
    const double tile = out_.tile, v = from.v - branches_[layout_of_place_[place]].v_begin;
    const int round = use < kPlane ? use & 1 : 0;
    const double turns = turns_of(place) + round;
    out_.unrolled[at] = {turns, from.v};
    if (use >= kPlane) {
      const glm::dvec2 plane = plane_of(place, use == kPlaneMirrored);
      out_.uvs[at] = {plane.x / (tile * options_.aspect), plane.y / tile};
    } else {
      const int step = std::max(0, step_of_place_[place] + use / 2 - kSteps);
      out_.uvs[at] = {turns * wraps_of_step(step), v / tile};
    }
  }

  const Mesh& mesh_;
  const SurfacePlaces& places_;
  const MeshAttributeOptions& options_;
  MeshAttributes& out_;
  const RunOptions& run_;
  std::vector<BranchLayout> branches_;             // ascending by id
  std::vector<std::uint32_t> layout_of_place_;
  std::vector<std::int8_t> step_of_place_;
  std::vector<std::array<std::uint8_t, 3>> uses_;  // by corner
  std::vector<std::uint16_t> used_;                // by place
  std::atomic<bool> some_without_{false};          // a triangle has a corner without a place
};

}  // namespace

bool lay_out_texture(const Mesh& mesh, const SurfacePlaces& places, const MeshAttributeOptions& options, MeshAttributes& out,
                     const RunOptions& run) {
  return TextureLayout(mesh, places, options, out, run).run();
}

}  // namespace cambium
