#include "tests/raytrace/sampled_surface.h"

#include <algorithm>
#include <array>
#include <utility>

namespace cambium {
namespace {

constexpr double kLeafRadii = 3;         // edges that are no longer are not split
constexpr double kSmallestPart = 1e-3;   // of the bounds: nor are those where no radius is known
constexpr double kFinestRadii = 1e-3;    // stretches that no interval proves empty are sampled when they are this short
constexpr double kNearTouching = 2e-3;   // and searched for their highest place if f may reach the level there, rising by no more
                                         // than this on a quarter of the stretch: 8 for each radius, ten times a lone branch's slope
constexpr double kGolden = 0.6180339887498949;

double longest_edge(const Box& box) { return std::max({box.size().x, box.size().y, box.size().z}); }

std::array<Box, 8> octants(const Box& box) {
  std::array<Box, 8> out;
  const Vec3 middle = box.center();
  for (int i = 0; i < 8; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const bool high = i >> axis & 1;
      out[i].lo[axis] = high ? middle[axis] : box.lo[axis];
      out[i].hi[axis] = high ? box.hi[axis] : middle[axis];
    }
  return out;
}

/// The field along one ray in one leaf.
class AlongRay {
 public:
  AlongRay(Evaluator& evaluator, const PrunedField& field, const Ray& ray, double level)
      : evaluator_(evaluator), field_(field), ray_(ray), level_(level) {
    const double radius = field.smallest_radius();
    finest_ = kFinestRadii * (radius < kInfinity ? radius : longest_edge(field.box()));
  }

  std::optional<double> first_reaching(const RaySegment& part) const {
    const double middle = 0.5 * (part.begin + part.end);
    if (evaluator_.interval(field_, Ball{ray_.at(middle), 0.5 * (part.end - part.begin) * (1 + 1e-9)}).hi < level_) return std::nullopt;
    if (part.end - part.begin <= finest_) return first_sampled(part);
    if (const auto t = first_reaching({part.begin, middle})) return t;
    return first_reaching({middle, part.end});
  }

 private:
  double value(double t) const { return evaluator_.value(field_, ray_.at(t)); }

  std::optional<double> first_sampled(const RaySegment& part) const {
    if (value(part.begin) >= level_) return part.begin;
    const double middle = 0.5 * (part.begin + part.end);
    if (value(middle) >= level_) return bisected(part.begin, middle);
    if (value(part.end) >= level_) return bisected(part.begin, part.end);
    const auto inside = place_reaching(part);
    return inside ? std::optional(bisected(part.begin, *inside)) : std::nullopt;
  }

  /// Golden section towards the highest place, until it reaches the level or can not any more, by how f may go.
  std::optional<double> place_reaching(RaySegment part) const {
    const double steepest = kNearTouching / (0.25 * (part.end - part.begin));
    double a = part.end - kGolden * (part.end - part.begin), b = part.begin + kGolden * (part.end - part.begin);
    double at_a = value(a), at_b = value(b);
    for (int i = 0; i < 60; ++i) {
      if (std::max(at_a, at_b) >= level_) return at_a >= level_ ? a : b;
      if (std::max(at_a, at_b) + steepest * (part.end - part.begin) < level_) return std::nullopt;
      if (at_a < at_b) {
        part.begin = std::exchange(a, b);
        at_a = at_b;
        b = part.begin + kGolden * (part.end - part.begin);
        at_b = value(b);
      } else {
        part.end = std::exchange(b, a);
        at_b = at_a;
        a = part.end - kGolden * (part.end - part.begin);
        at_a = value(a);
      }
    }
    return std::nullopt;
  }

  double bisected(double outside, double inside) const {
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (outside + inside);
      (value(middle) < level_ ? outside : inside) = middle;
    }
    return inside;
  }

  Evaluator& evaluator_;
  const PrunedField& field_;
  const Ray& ray_;
  double level_, finest_;
};

}  // namespace

SampledSurface::SampledSurface(const Field& field) {
  Evaluator evaluator;
  nodes_.push_back({field.bounds(), 0, 0, {}});
  split(0, field, field.active(field.bounds()), evaluator);
}

void SampledSurface::split(std::size_t node, const Field& field, const ActiveSet& active, Evaluator& evaluator) {
  const Box box = nodes_[node].box;
  const PrunedField pruned = field.prune(active, box);
  if (longest_edge(box) <= std::max(kLeafRadii * (pruned.smallest_radius() < kInfinity ? pruned.smallest_radius() : 0),
                                    kSmallestPart * longest_edge(field.bounds()))) {
    nodes_[node].leaf = leaves_.size();
    leaves_.push_back(pruned);
    return;
  }
  const std::size_t first = nodes_.size();
  std::vector<ActiveSet> active_in;
  for (const Box& octant : octants(box)) {
    ActiveSet narrowed = field.narrow(active, octant);
    if (evaluator.interval(field.prune(narrowed, octant), octant).hi < kIso - 2 * kTouching) continue;
    nodes_.push_back({octant, 0, 0, {}});
    active_in.push_back(std::move(narrowed));
  }
  nodes_[node].first = first;
  nodes_[node].count = active_in.size();
  for (std::size_t i = 0; i < active_in.size(); ++i) split(first + i, field, active_in[i], evaluator);
}

void SampledSurface::pass(std::size_t number, const Ray& ray, const RaySegment& segment, std::vector<Passage>& out) const {
  const Node& node = nodes_[number];
  const auto part = clip(ray, node.box, segment);
  if (!part) return;
  for (std::size_t i = 0; i < node.count; ++i) pass(node.first + i, ray, segment, out);
  if (node.leaf) out.push_back({*part, *node.leaf});
}

std::optional<double> SampledSurface::first_reaching(Evaluator& evaluator, const Ray& ray, double level, double end) const {
  std::vector<Passage> passages;
  pass(0, ray, {0, end}, passages);
  std::ranges::sort(passages, {}, [](const Passage& p) { return p.part.begin; });
  for (const Passage& passage : passages)
    if (const auto t = AlongRay(evaluator, leaves_[passage.leaf], ray, level).first_reaching(passage.part)) return t;
  return std::nullopt;
}

std::optional<double> SampledSurface::first_reaching_in_any(Evaluator& evaluator, const Ray& ray, double level) const {
  std::optional<double> first;
  for (const PrunedField& leaf : leaves_) {
    const auto part = clip(ray, leaf.box(), {0, kInfinity});
    if (!part) continue;
    const auto t = AlongRay(evaluator, leaf, ray, level).first_reaching(*part);
    if (t && (!first || *t < *first)) first = t;
  }
  return first;
}

}  // namespace cambium
