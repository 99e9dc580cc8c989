#include "polygonize/surface_samples.h"

#include "blobtree/surface_cover.h"
#include "polygonize/fixed_random.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace cambium {
namespace {

constexpr double kCellPitches = 4;        // edge of a cover's cell, in spacings: cells share out what a tape costs
constexpr double kStepRadii = 0.5;        // of a scan along a line, in smallest radii
constexpr int kMostSteps = 1024;          // along one line in one cell
constexpr double kBatchError = 3e-4;      // a batch and the field in double differ by 1e-4 at most
constexpr std::size_t kBatch = 4096;

// Crossings of the lattice's lines and the surface in one cell; scratch for one thread.
class LineSampler {
 public:
  void sample(const PrunedField& field, double pitch, const std::function<void(const Vec3&)>& take) {
    field_ = &field;
    take_ = &take;
    const Box& box = field.box();
    const double step = kStepRadii * field.smallest_radius();
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const double length = box.hi[axis] - box.lo[axis];
      const int steps = std::clamp(static_cast<int>(std::ceil(std::min(length / step, 1.0 * kMostSteps))), 1, kMostSteps);
      const auto index = [&](double at) { return static_cast<std::int64_t>(std::floor(at / pitch)); };
      for (std::int64_t iv = index(box.lo[v]); iv <= index(box.hi[v]); ++iv) {
        for (std::int64_t iu = index(box.lo[u]); iu <= index(box.hi[u]); ++iu) {
          const auto line = static_cast<std::uint64_t>(axis);
          const auto a = static_cast<std::uint64_t>(iu), b = static_cast<std::uint64_t>(iv);
          Line at{axis, steps, Vec3(0), mixed(line + 3 * mixed(a + mixed(b)))};
          at.from[u] = pitch * (static_cast<double>(iu) + chance(line, a, b, 0));
          at.from[v] = pitch * (static_cast<double>(iv) + chance(line, a, b, 1));
          at.from[axis] = box.lo[axis];
          if (at.from[u] < box.lo[u] || at.from[u] >= box.hi[u] || at.from[v] < box.lo[v] || at.from[v] >= box.hi[v]) continue;
          lines_.push_back(at);
          points_ += static_cast<std::size_t>(steps) + 1;
          if (points_ >= kBatch) flush();
        }
      }
    }
    flush();
  }

 private:
  struct Line {
    int axis, steps;
    Vec3 from;                 // where it enters the cell
    std::uint64_t number;
  };
  struct End {
    double t;                  // the coordinate along the line
    double over;               // f - kIso
    double slope;              // of f along the line
    bool inside() const { return over >= 0; }
  };

  double scan_place(const Line& line, int i) const {
    const Box& box = field_->box();
    if (i == line.steps) return box.hi[line.axis];   // the next cell's first, to the last bit
    return box.lo[line.axis] + (box.hi[line.axis] - box.lo[line.axis]) * i / line.steps;
  }

  Vec3 point(const Line& line, double t) const {
    Vec3 p = line.from;
    p[line.axis] = t;
    return p;
  }

  End end_at(const Line& line, double t) {
    const Sample s = evaluator_.sample(*field_, point(line, t));
    return {t, s.value - kIso, s.gradient[line.axis]};
  }

  void flush() {
    for (auto* v : {&x_, &y_, &z_, &f_, &gx_, &gy_, &gz_}) v->resize(points_);
    std::size_t n = 0;
    for (const Line& line : lines_) {
      for (int i = 0; i <= line.steps; ++i, ++n) {
        const Vec3 p = point(line, scan_place(line, i)) - field_->origin();
        x_[n] = static_cast<float>(p.x), y_[n] = static_cast<float>(p.y), z_[n] = static_cast<float>(p.z);
      }
    }
    if (n > 0) evaluator_.samples(*field_, x_, y_, z_, f_, gx_, gy_, gz_);
    n = 0;
    for (const Line& line : lines_) {
      End low{};
      for (int i = 0; i <= line.steps; ++i, ++n) {
        const std::vector<float>& g = line.axis == 0 ? gx_ : line.axis == 1 ? gy_ : gz_;
        End high{scan_place(line, i), double{f_[n]} - kIso, double{g[n]}};
        // Signs come from the field in double wherever a batch could be mistaken: cells that share a point agree about it.
        if (std::abs(high.over) < kBatchError) high = end_at(line, high.t);
        if (i > 0) between(line, low, high);
        low = high;
      }
    }
    lines_.clear();
    points_ = 0;
  }

  void between(const Line& line, End low, End high) {
    if (low.inside() != high.inside()) return cross(line, low, high);
    // On one side at both ends: there is a pair of crossings if the field turns beyond kIso between them.
    const double side = low.inside() ? -1 : 1;
    for (int round = 0; round < 8; ++round) {
      const double rise = side * low.slope, fall = -side * high.slope, length = high.t - low.t;
      if (!(rise > 0) || !(fall > 0)) return;
      // Where the tangents meet the field would be as far as a field of one turn can get; half as much again for others.
      const double turn = (side * (high.over - low.over) + fall * length) / (rise + fall);
      const double gain = rise * std::clamp(turn, 0.0, length);
      if (side * low.over + 1.5 * gain < 0) return;
      // The slope's zero, if it were straight; well inside, so that the bracket shrinks.
      const End middle = end_at(line, low.t + length * std::clamp(rise / (rise + fall), 0.1, 0.9));
      if (middle.inside() != low.inside()) {
        cross(line, low, middle);
        cross(line, middle, high);
        return;
      }
      (side * middle.slope > 0 ? low : high) = middle;
    }
  }

  // Regula falsi (Illinois), with bisection where it is slow.
  void cross(const Line& line, End low, End high) {
    double a = low.t, b = high.t, fa = low.over, fb = high.over, t = a;
    Sample s;
    for (int round = 0; round < 60; ++round) {
      t = round % 8 == 7 ? 0.5 * (a + b) : a - fa * (b - a) / (fb - fa);
      t = std::clamp(t, a, b);
      s = evaluator_.sample(*field_, point(line, t));
      const double over = s.value - kIso;
      if (std::abs(over) < 1e-12 || b - a < 1e-13 * (std::abs(a) + std::abs(b))) break;
      if ((over >= 0) == (fa >= 0)) {
        a = t, fa = over;
        if (round % 2) fb *= 0.5;
      } else {
        b = t, fb = over;
        if (round % 2) fa *= 0.5;
      }
    }
    const double steepness = glm::length(s.gradient);
    const Vec3 n = glm::abs(s.gradient);
    const double favour = steepness > 0 ? (n.x + n.y + n.z) / steepness : 1.5;
    if (chance(line.number, std::bit_cast<std::uint64_t>(t), 2, 0) * favour < 1) (*take_)(point(line, t));
  }

  Evaluator evaluator_;
  const PrunedField* field_ = nullptr;
  const std::function<void(const Vec3&)>* take_ = nullptr;
  std::vector<Line> lines_;
  std::size_t points_ = 0;
  std::vector<float> x_, y_, z_, f_, gx_, gy_, gz_;
};

struct Pass {
  std::vector<Vec3> points;
  std::size_t cells = 0;
};

std::optional<Pass> cross_lines(const Field& field, double pitch, const RunOptions& run) {
  CoverOptions options;
  options.cell = kCellPitches * pitch;
  RunOptions quiet = run;
  quiet.progress = {};
  const auto cover = cover_surface(field, options, quiet);
  if (!cover) return std::nullopt;
  constexpr std::size_t kGroup = 64;
  std::vector<std::vector<Vec3>> groups((cover->size() + kGroup - 1) / kGroup);
  tbb::enumerable_thread_specific<LineSampler> samplers;
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
    const std::function<void(const Vec3&)> take = [&](const Vec3& p) { groups[g].push_back(p); };
    for (std::size_t i = g * kGroup; i < std::min(cover->size(), (g + 1) * kGroup) && !run.cancelled(); ++i) {
      samplers.local().sample(cover->field(i), pitch, take);
    }
  });
  if (run.cancelled()) return std::nullopt;
  Pass pass;
  pass.cells = cover->size();
  for (const auto& group : groups) pass.points.insert(pass.points.end(), group.begin(), group.end());
  return pass;
}

// Where bounds tell little, as of warped fields, most cells are without surface and fill space: their number grows as the cube.
double finest_pitch(double pitch, const Pass& pass) {
  constexpr double kMostCells = 4'000'000;
  if (pass.points.size() >= pass.cells) return 0;
  return pitch * std::cbrt(static_cast<double>(pass.cells) / kMostCells);
}

std::optional<SurfaceSamples> sample_in_arena(const Field& field, std::size_t count, const RunOptions& run) {
  SurfaceSamples samples;
  if (field.bounds().empty() || count == 0) return samples;
  const Vec3 size = field.bounds().size();
  const double extent = std::max({size.x, size.y, size.z});
  // Coarse lines first, finer until there are enough of them to tell the area.
  const std::size_t enough = std::min<std::size_t>(count, 4000);
  for (double pitch = extent / 64;; pitch /= 3) {
    auto pass = cross_lines(field, pitch, run);
    if (!pass) return std::nullopt;
    const double finest = finest_pitch(pitch, *pass);
    if (pass->points.size() < enough && pass->cells > 0 && pitch > std::max(extent * 0x1p-16, 3 * finest)) continue;
    const double found = static_cast<double>(pass->points.size());
    samples.spacing = pitch;
    if (found < 0.9 * static_cast<double>(count) || found > 1.1 * static_cast<double>(count)) {
      if (found == 0) return samples;
      samples.spacing = std::max(finest, pitch * std::sqrt(found / static_cast<double>(count)));
      pass = cross_lines(field, samples.spacing, run);
      if (!pass) return std::nullopt;
    }
    samples.points = std::move(pass->points);
    return samples;
  }
}

}  // namespace

std::optional<SurfaceSamples> sample_surface(const Field& field, std::size_t count, const RunOptions& run) {
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  return arena.execute([&] { return sample_in_arena(field, count, run); });
}

}  // namespace cambium
