#include "polygonize/surface_points.h"

#include "blobtree/cell_search.h"
#include "blobtree/progress_meter.h"
#include "polygonize/thinnest_radius.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>

namespace cambium {
namespace {

constexpr double kCellRadii = 2;         // a twig's cells are about as long as it is thick
constexpr double kSpacingRadii = 1;      // of points on it: six around, and the nearest is off by an eighth of the radius at most
constexpr double kFinest = 1.0 / 8;      // voxels: what is thinner has points in single file
constexpr int kPieceSeeds = 8;           // seeds along a piece, so that a batch is at most 512
constexpr float kSeedReach = 0.9f;       // of the spacing: half a seed's cube is 0.87 across; farther ones leave it to others
constexpr int kRounds = 3;
constexpr float kOnSurface = 0.05f;      // voxels

struct Part {
  std::uint64_t key = 0;                 // of the first cell of the run
  std::vector<SurfacePoint> points;
};

class PointRun final : public CellRun {
 public:
  struct Shared {
    const Lattice& lattice;
    const RunOptions& run;
    std::mutex mutex;
    std::vector<Part> parts;
  };
  explicit PointRun(Shared& shared) : shared_(shared) {}

  void found(Evaluator& evaluator, const FoundCell& cell) override {
    if (part_.points.empty()) part_.key = morton_key(cell.place);
    const double voxel = shared_.lattice.voxel, radius = cell.field.smallest_radius();
    const double spacing = std::clamp(kSpacingRadii * radius, kFinest * voxel, voxel);
    const double edge = cell.box.hi.x - cell.box.lo.x;
    const int pieces = static_cast<int>(std::ceil(edge / (kPieceSeeds * spacing) - 1e-9));
    for (int x = 0; x < pieces && !shared_.run.cancelled(); ++x)
      for (int y = 0; y < pieces; ++y)
        for (int z = 0; z < pieces; ++z) {
          const Vec3 lo = cell.box.lo + edge / pieces * Vec3(x, y, z), hi = cell.box.lo + edge / pieces * Vec3(x + 1, y + 1, z + 1);
          const Box piece{lo, pieces == 1 ? cell.box.hi : hi};
          if (pieces > 1 && !evaluator.interval(cell.field, piece).contains(kIso)) continue;
          add_points(evaluator, cell, piece, static_cast<int>(std::ceil(edge / pieces / spacing - 1e-9)));
        }
  }

  void finish() override {
    if (part_.points.empty()) return;
    const std::lock_guard lock(shared_.mutex);
    shared_.parts.push_back(std::move(part_));
  }

 private:
  // A grid of seeds, each of which steps down or up the field to the surface. The field holds inside the cell only.
  void add_points(Evaluator& evaluator, const FoundCell& cell, const Box& piece, int seeds) {
    const double edge = piece.hi.x - piece.lo.x;
    const Vec3 corner = piece.lo - cell.field.origin();
    resize(0);
    for (int x = 0; x < seeds; ++x)
      for (int y = 0; y < seeds; ++y)
        for (int z = 0; z < seeds; ++z) {
          x_.push_back(static_cast<float>(corner.x + edge * (x + 0.5) / seeds));
          y_.push_back(static_cast<float>(corner.y + edge * (y + 0.5) / seeds));
          z_.push_back(static_cast<float>(corner.z + edge * (z + 0.5) / seeds));
        }
    const float spacing = static_cast<float>(edge / seeds), on_surface = kOnSurface * static_cast<float>(shared_.lattice.voxel);
    for (int round = 0; round <= kRounds && !x_.empty(); ++round) {
      resize(x_.size());
      evaluator.samples(cell.field, x_, y_, z_, f_, gx_, gy_, gz_);
      std::size_t kept = 0;
      for (std::size_t i = 0; i < x_.size(); ++i) {
        const float slope2 = gx_[i] * gx_[i] + gy_[i] * gy_[i] + gz_[i] * gz_[i];
        const float slope = std::sqrt(slope2), step = (f_[i] - static_cast<float>(kIso)) / slope;
        if (!(std::abs(step) < kSeedReach * spacing)) continue;   // no gradient included
        if (round == kRounds) {
          if (std::abs(step) < on_surface) keep(cell, Vec3(x_[i], y_[i], z_[i]), -glm::vec3(gx_[i], gy_[i], gz_[i]) / slope);
          continue;
        }
        const float along = step / slope;
        x_[kept] = x_[i] - along * gx_[i];
        y_[kept] = y_[i] - along * gy_[i];
        z_[kept] = z_[i] - along * gz_[i];
        ++kept;
      }
      resize(kept);
    }
  }

  void keep(const FoundCell& cell, const Vec3& from_origin, const glm::vec3& normal) {
    const Vec3 p = cell.field.origin() + from_origin;
    if (!cell.box.contains(p)) return;
    const Lattice& lattice = shared_.lattice;
    CellPlace place{};
    SurfacePoint point;
    for (int a = 0; a < 3; ++a) {
      const double at = p[a] / lattice.voxel - static_cast<double>(lattice.first(a));
      place[a] = static_cast<std::uint32_t>(at / kBlockCells);
      point.at[a] = static_cast<float>(at - static_cast<double>(place[a]) * kBlockCells);
    }
    point.block = morton_key(place);
    point.normal = normal;
    part_.points.push_back(point);
  }

  void resize(std::size_t n) {
    for (auto* v : {&x_, &y_, &z_, &f_, &gx_, &gy_, &gz_}) v->resize(n);
  }

  Shared& shared_;
  Part part_;
  std::vector<float> x_, y_, z_, f_, gx_, gy_, gz_;
};

}  // namespace

std::optional<std::vector<SurfacePoint>> surface_points(const Field& field, const Lattice& lattice, const RunOptions& run) {
  // Cells from a block of voxels down to what the thinnest twig asks for.
  const double thinnest = thinnest_radius(field);
  const double block = lattice.voxel * kBlockCells;
  double smallest = block;
  while (smallest > kCellRadii * thinnest && smallest > kFinest * block) smallest /= 2;
  PointRun::Shared shared{lattice, run, {}, {}};
  CellRule rule;
  rule.radii = rule.sparse_radii = kCellRadii;
  ProgressMeter progress(run, "finding the surface");
  const auto make_run = [&] { return std::make_unique<PointRun>(shared); };
  if (!search_cells(field, cell_grid(field.bounds(), smallest), Wanted::kSurface, rule, make_run, run, &progress)) return std::nullopt;
  if (run.cancelled()) return std::nullopt;
  std::sort(shared.parts.begin(), shared.parts.end(), [](const Part& a, const Part& b) { return a.key < b.key; });
  std::vector<SurfacePoint> points;
  std::size_t count = 0;
  for (const Part& part : shared.parts) count += part.points.size();
  points.reserve(count);
  for (Part& part : shared.parts) {
    points.insert(points.end(), part.points.begin(), part.points.end());
    part.points = {};
  }
  if (run.cancelled()) return std::nullopt;
  std::stable_sort(points.begin(), points.end(), [](const SurfacePoint& a, const SurfacePoint& b) { return a.block < b.block; });
  return points;
}

}  // namespace cambium
