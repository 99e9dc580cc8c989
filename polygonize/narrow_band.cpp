#include "polygonize/narrow_band.h"

#include "blobtree/cell_grid.h"
#include "blobtree/progress_meter.h"
#include "polygonize/surface_points.h"
#include "polygonize/volume_samples.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace cambium {
namespace {

constexpr float kSlack = 0.9f;           // voxels: the nearest point of the surface has one of its points this near
constexpr int kRounds = 7;               // of closest-point steps; smooth places take three
constexpr float kOnSurface = 0.05f;      // voxels
constexpr double kStepRadii = 0.7;       // of the thinnest branch near by
constexpr float kArrived = 0.02f;        // voxels
constexpr float kSameSheet = 0.9f;       // cosine between two tangent planes
constexpr float kDoubtfulValue = 1e-3f;  // as when contouring: nearer to kIso a sign is decided in double

// The points by block, and the blocks that the band reaches.
struct Bins {
  const std::vector<SurfacePoint>& points;
  std::unordered_map<std::uint64_t, std::pair<std::uint32_t, std::uint32_t>> range;
  std::vector<CellPlace> leaves;         // ascending by key
};

CellPlace place_of(std::uint64_t key) {
  CellPlace place{};
  for (int bit = 0; bit < kMostLevels; ++bit)
    for (int a = 0; a < 3; ++a) place[a] |= static_cast<std::uint32_t>(key >> (3 * bit + a) & 1) << bit;
  return place;
}

Bins make_bins(const std::vector<SurfacePoint>& points, float reach) {
  Bins bins{points, {}, {}};
  std::vector<std::uint64_t> keys;
  for (std::size_t begin = 0; begin < points.size();) {
    std::size_t end = begin;
    glm::vec3 lo(std::numeric_limits<float>::max()), hi(std::numeric_limits<float>::lowest());
    for (; end < points.size() && points[end].block == points[begin].block; ++end) {
      lo = glm::min(lo, points[end].at);
      hi = glm::max(hi, points[end].at);
    }
    bins.range[points[begin].block] = {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
    const CellPlace at = place_of(points[begin].block);
    const auto first = [&](int a) { return lo[a] - reach < 0 ? -1 : 0; };
    const auto last = [&](int a) { return hi[a] + reach >= kBlockCells ? 1 : 0; };
    for (int x = first(0); x <= last(0); ++x)
      for (int y = first(1); y <= last(1); ++y)
        for (int z = first(2); z <= last(2); ++z) keys.push_back(morton_key({at[0] + x, at[1] + y, at[2] + z}));
    begin = end;
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  for (const std::uint64_t key : keys) bins.leaves.push_back(place_of(key));
  return bins;
}

// Scratch of one thread.
class BandMaker {
 public:
  BandMaker(const Field& field, const Lattice& lattice, float half_width, const Bins& bins)
      : field_(field), lattice_(lattice), half_width_(half_width), bins_(bins) {}

  /// False if no voxel of the leaf is active.
  bool make(const CellPlace& place, BandLeaf& leaf) {
    collect(place);
    if (!find_nearest()) return false;
    const double voxel = lattice_.voxel;
    const Box box = lattice_.box(place);
    const PrunedField pruned = field_.prune(box.padded((half_width_ + 1) * voxel));
    corner_ = box.lo - pruned.origin();
    longest_step_ = static_cast<float>(std::min(1.0, kStepRadii * pruned.smallest_radius() / voxel));
    measure(pruned);
    sample(pruned, place);
    bound_by_crossings(pruned, place);
    finish(place, leaf);
    return leaf.active.any();
  }

 private:
  static glm::vec3 voxel_at(int i) { return {static_cast<float>(i >> 6), static_cast<float>(i >> 3 & 7), static_cast<float>(i & 7)}; }

  // The points that may matter, in voxels from this leaf's corner.
  void collect(const CellPlace& place) {
    near_.clear();
    const float reach = half_width_ + kSlack;
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const auto found = bins_.range.find(morton_key({place[0] + x, place[1] + y, place[2] + z}));
          if (found == bins_.range.end()) continue;
          const glm::vec3 shift = static_cast<float>(kBlockCells) * glm::vec3(x, y, z);
          for (std::uint32_t i = found->second.first; i < found->second.second; ++i) {
            const glm::vec3 at = bins_.points[i].at + shift;
            const glm::vec3 off = glm::max(glm::max(-at, at - float(kBlockCells - 1)), glm::vec3(0.0f));
            if (glm::dot(off, off) < reach * reach) near_.push_back({at, bins_.points[i].normal});
          }
        }
  }

  bool find_nearest() {
    const float reach = half_width_ + kSlack;
    nearest2_.fill(reach * reach);
    nearest_.fill(-1);
    for (std::size_t n = 0; n < near_.size(); ++n) {
      const glm::vec3 at = near_[n].at;
      const auto from = [&](int a) { return std::max(0, static_cast<int>(std::ceil(at[a] - reach))); };
      const auto to = [&](int a) { return std::min(kBlockCells - 1, static_cast<int>(std::floor(at[a] + reach))); };
      for (int x = from(0); x <= to(0); ++x)
        for (int y = from(1); y <= to(1); ++y) {
          const float dx = static_cast<float>(x) - at.x, dy = static_cast<float>(y) - at.y, across = dx * dx + dy * dy;
          if (!(across < reach * reach)) continue;
          float* const best = &nearest2_[static_cast<std::size_t>(64 * x + 8 * y)];
          std::int32_t* const which = &nearest_[static_cast<std::size_t>(64 * x + 8 * y)];
          for (int z = 0; z < kBlockCells; ++z) {   // all eight: one vector
            const float dz = static_cast<float>(z) - at.z, d = across + dz * dz;
            const bool nearer = d < best[z];
            best[z] = nearer ? d : best[z];
            which[z] = nearer ? static_cast<std::int32_t>(n) : which[z];
          }
        }
    }
    return std::any_of(nearest_.begin(), nearest_.end(), [](std::int32_t n) { return n >= 0; });
  }

  // One voxel's way to its nearest point of the surface.
  struct Search {
    int voxel = 0;
    glm::vec3 foot{0.0f};       // where the field is looked at next, in voxels from the leaf's corner
    glm::vec3 normals[2]{};     // of the last two tangent planes,
    float offsets[2]{};         // normal . x on them
    bool on_crease = false;     // the steps have gone from one sheet to another and back
  };

  // From the nearest of the points by closest-point steps. Every foot that is on the surface is an upper bound, so steps that lead
  // astray do no harm.
  void measure(const PrunedField& pruned) {
    const float voxel = static_cast<float>(lattice_.voxel);
    searches_.clear();
    for (int i = 0; i < 512; ++i) {
      const std::int32_t nearest = nearest_[static_cast<std::size_t>(i)];
      if (nearest < 0) continue;
      const Near& near = near_[static_cast<std::size_t>(nearest)];
      Search search;
      search.voxel = i;
      search.normals[0] = near.normal;
      search.offsets[0] = glm::dot(near.normal, near.at);
      search.foot = near.at + limited(closest_on_plane(voxel_at(i), search) - near.at);
      searches_.push_back(search);
    }
    for (int round = 0; round < kRounds && !searches_.empty(); ++round) {
      const std::size_t n = searches_.size();
      for (auto* v : {&x_, &y_, &z_, &f_, &gx_, &gy_, &gz_}) v->resize(n);
      for (std::size_t k = 0; k < n; ++k) {
        x_[k] = static_cast<float>(corner_.x) + voxel * searches_[k].foot.x;
        y_[k] = static_cast<float>(corner_.y) + voxel * searches_[k].foot.y;
        z_[k] = static_cast<float>(corner_.z) + voxel * searches_[k].foot.z;
      }
      evaluator_.samples(pruned, x_, y_, z_, f_, gx_, gy_, gz_);
      std::size_t kept = 0;
      for (std::size_t k = 0; k < n; ++k) {
        if (step(searches_[k], f_[k], glm::vec3(gx_[k], gy_[k], gz_[k]))) searches_[kept++] = searches_[k];
      }
      searches_.resize(kept);
    }
  }

  // False once it has arrived.
  bool step(Search& search, float f, const glm::vec3& gradient) {
    const float slope = glm::length(gradient);
    if (!(slope > 0)) return false;
    const glm::vec3 normal = -gradient / slope, p = voxel_at(search.voxel);
    const float height = (static_cast<float>(kIso) - f) / (slope * static_cast<float>(lattice_.voxel));
    if (std::abs(height) < kOnSurface) {
      const glm::vec3 off = p - (search.foot - height * normal);
      float& nearest2 = nearest2_[static_cast<std::size_t>(search.voxel)];
      nearest2 = std::min(nearest2, glm::dot(off, off));
    }
    if (glm::dot(normal, search.normals[0]) < kSameSheet) {
      search.on_crease = search.on_crease || glm::dot(normal, search.normals[1]) > kSameSheet;
      search.normals[1] = search.normals[0];
      search.offsets[1] = search.offsets[0];
    }
    search.normals[0] = normal;
    search.offsets[0] = glm::dot(normal, search.foot) - height;
    const glm::vec3 next = search.on_crease ? closest_on_both(p, search) : closest_on_plane(p, search);
    const glm::vec3 move = limited(next - search.foot);
    search.foot += move;
    return std::abs(height) > kArrived || glm::dot(move, move) > kArrived * kArrived;
  }

  static glm::vec3 closest_on_plane(const glm::vec3& p, const Search& s) {
    return p - (glm::dot(s.normals[0], p) - s.offsets[0]) * s.normals[0];
  }
  static glm::vec3 closest_on_both(const glm::vec3& p, const Search& s) {
    const float c = glm::dot(s.normals[0], s.normals[1]), sine2 = 1 - c * c;
    const float a = glm::dot(s.normals[0], p) - s.offsets[0], b = glm::dot(s.normals[1], p) - s.offsets[1];
    return p - ((a - c * b) * s.normals[0] + (b - c * a) * s.normals[1]) / sine2;
  }

  // A longer step from a thin twig would leave its field.
  glm::vec3 limited(const glm::vec3& step) const {
    const float length = glm::length(step);
    return length > longest_step_ ? longest_step_ / length * step : step;
  }

  // The field at the leaf's voxels and at those around it.
  void sample(const PrunedField& pruned, const CellPlace& place) {
    const double voxel = lattice_.voxel;
    for (auto* v : {&x_, &y_, &z_, &f_}) v->resize(kAround * kAround * kAround);
    std::size_t k = 0;
    for (int x = -1; x <= kBlockCells; ++x)
      for (int y = -1; y <= kBlockCells; ++y)
        for (int z = -1; z <= kBlockCells; ++z, ++k) {
          x_[k] = static_cast<float>(corner_.x + voxel * x);
          y_[k] = static_cast<float>(corner_.y + voxel * y);
          z_[k] = static_cast<float>(corner_.z + voxel * z);
        }
    evaluator_.values(pruned, x_, y_, z_, f_);
    k = 0;
    for (int x = -1; x <= kBlockCells; ++x)
      for (int y = -1; y <= kBlockCells; ++y)
        for (int z = -1; z <= kBlockCells; ++z, ++k) {
          f_[k] -= static_cast<float>(kIso);
          if (!(std::abs(f_[k]) > kDoubtfulValue)) f_[k] = static_cast<float>(evaluator_.value(pruned, world(place, x, y, z)) - kIso);
        }
  }

  // Where the field changes sign on the way to a neighbour the surface is no farther than that, however steep and narrow the
  // crevice: closest-point steps may have missed it.
  void bound_by_crossings(const PrunedField& pruned, const CellPlace& place) {
    for (int i = 0; i < 512; ++i) {
      const int x = i >> 6, y = i >> 3 & 7, z = i & 7;
      const float here = f_[around(x, y, z)];
      for (int side = 0; side < 6; ++side) {
        const int step = side & 1 ? 1 : -1;
        const int nx = x + (side / 2 == 0) * step, ny = y + (side / 2 == 1) * step, nz = z + (side / 2 == 2) * step;
        const float there = f_[around(nx, ny, nz)];
        if ((here >= 0) == (there >= 0)) continue;
        float& nearest2 = nearest2_[static_cast<std::size_t>(i)];
        if (nearest2 < 1 && std::sqrt(nearest2) < here / (here - there) + kOnSurface) continue;
        const Vec3 a = world(place, x, y, z), b = world(place, nx, ny, nz);
        double low = 0, high = 1;
        while (high - low > kOnSurface / 2) {
          const double middle = 0.5 * (low + high);
          ((evaluator_.value(pruned, glm::mix(a, b, middle)) >= kIso) == (here >= 0) ? low : high) = middle;
        }
        nearest2 = std::min(nearest2, static_cast<float>(low * low));
        nearest_[static_cast<std::size_t>(i)] = std::max(nearest_[static_cast<std::size_t>(i)], 0);
      }
    }
  }

  void finish(const CellPlace& place, BandLeaf& leaf) const {
    const float voxel = static_cast<float>(lattice_.voxel), width = half_width_ * voxel;
    for (int a = 0; a < 3; ++a)
      leaf.first[a] = static_cast<std::int32_t>(lattice_.first(a) + std::int64_t{place[a]} * kBlockCells);
    for (int i = 0; i < 512; ++i) {
      const std::size_t k = static_cast<std::size_t>(i);
      const float distance = std::min(voxel * std::sqrt(nearest2_[k]), width);
      leaf.active[k] = nearest_[k] >= 0 && distance < width;
      leaf.distances[k] = std::copysign(leaf.active[k] ? distance : width, f_[around(i >> 6, i >> 3 & 7, i & 7)] >= 0 ? -1.0f : 1.0f);
    }
  }

  static constexpr int kAround = kBlockCells + 2;
  static std::size_t around(int x, int y, int z) {
    return static_cast<std::size_t>((x + 1) * kAround * kAround + (y + 1) * kAround + z + 1);
  }

  // A point of the lattice, to the last bit; coordinates count from the leaf's corner.
  Vec3 world(const CellPlace& place, int x, int y, int z) const {
    const auto index = [&](int a, int at) { return std::uint64_t{place[a]} * kBlockCells + static_cast<std::uint64_t>(std::int64_t{at}); };
    return lattice_.point(index(0, x), index(1, y), index(2, z));
  }

  struct Near {
    glm::vec3 at, normal;
  };
  const Field& field_;
  const Lattice& lattice_;
  const float half_width_;
  const Bins& bins_;
  Evaluator evaluator_;
  Vec3 corner_{0.0};                      // of the leaf, from the pruned field's origin
  float longest_step_ = 1;                // voxels
  std::vector<Near> near_;
  std::array<float, 512> nearest2_{};     // square voxels
  std::array<std::int32_t, 512> nearest_{};
  std::vector<Search> searches_;
  std::vector<float> x_, y_, z_, f_, gx_, gy_, gz_;
};

}  // namespace

std::optional<std::vector<std::unique_ptr<BandLeaf>>> narrow_band(const Field& field, double voxel, double half_width,
                                                                  const RunOptions& run) {
  std::vector<std::unique_ptr<BandLeaf>> leaves;
  if (field.bounds().empty()) return leaves;
  // The band may stick out of the field's bounds.
  const Lattice lattice = make_indexed_lattice(field.bounds().padded((half_width + 1) * voxel), voxel);
  bool complete = false;
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    const auto points = surface_points(field, lattice, run);
    if (!points) return;
    const float width = static_cast<float>(half_width);
    const Bins bins = make_bins(*points, width + kSlack);
    leaves.resize(bins.leaves.size());
    tbb::enumerable_thread_specific<std::unique_ptr<BandMaker>> makers(
        [&] { return std::make_unique<BandMaker>(field, lattice, width, bins); });
    ProgressMeter progress(run, "measuring distances");
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, leaves.size(), 8), [&](const auto& range) {
      BandMaker& maker = *makers.local();
      for (std::size_t i = range.begin(); i < range.end() && !run.cancelled(); ++i) {
        auto leaf = std::make_unique<BandLeaf>();
        if (maker.make(bins.leaves[i], *leaf)) leaves[i] = std::move(leaf);
      }
      progress.add(static_cast<double>(range.size()) / static_cast<double>(leaves.size()));
    });
    std::erase(leaves, nullptr);
    complete = !run.cancelled();
  });
  if (!complete) return std::nullopt;
  return leaves;
}

}  // namespace cambium
