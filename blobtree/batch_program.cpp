#include "blobtree/batch_program.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace cambium {
namespace {

/// Distance from a shape's anchor over support radius. One shape's float value differs from the double one by at most 6e-7
/// up to 4, 8e-7 at 8, 1.4e-6 at 16 and 2.1e-6 at 32 (cones; others less). Blocks of a mesh with voxels as large as a twig
/// is thick have about 8.
constexpr double kLargestRatio = 16;

template <class T>
void assign(T (&to)[3], const Vec3& v) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<T>(v[i]);
}

/// Places shapes relative to one origin and notes how hard they are for floats.
template <class T>
class ShapePlacer {
 public:
  ShapePlacer(BatchProgram<T>& out) : out_(out) {}

  /// The space in which the following shapes are: its origin, and how far from it points may be.
  void enter(const Vec3& origin, double reach) {
    origin_ = origin;
    reach_ = reach;
  }
  double largest_ratio() const { return largest_ratio_; }

  void place(const CompiledPrimitive& p, Step& step) {
    per_support_ = p.inverse_support;
    strength_ = p.strength;
    std::visit([&](const auto& shape) { add(shape, step); }, p.shape);
  }

  void add_segment(const SweptSegment<double>& k, double strength) {
    const double s = nearest(k.a, k.axis, k.begin, k.end);
    LocalSwept<T>& local = out_.swept.emplace_back();
    const Vec3 anchor = k.a + s * k.axis - origin_;
    assign(local.a, anchor);
    assign(local.axis, k.axis);
    local.begin = static_cast<T>(k.begin - s);
    local.end = static_cast<T>(k.end - s);
    local.radius = static_cast<T>(k.radius_at(s));
    local.slope = static_cast<T>(k.slope);
    const double away = reach_ + glm::length(anchor);
    const double thinner_end = std::min(k.radius_at(k.begin), k.radius_at(k.end));
    const double thinnest = std::max(thinner_end, k.radius_at(s) - std::abs(k.slope) * away);
    note(away * kRadiusPerSupport / thinnest * std::max(1.0, std::abs(strength)));
  }

  /// Of the segments that the step has: what widens them, if anything does in the batch's reach.
  void add(const CompiledFlare& flare, Step& step) {
    const Vec3 at = flare.local(origin_);
    if (at.x - reach_ >= flare.height) return;
    step.kind = StepKind::kFlare;
    step.flare = index(out_.flares);
    const double rho = std::hypot(at.y, at.z), azimuth = std::atan2(at.z, at.y), c = std::cos(azimuth), s = std::sin(azimuth);
    LocalFlare<T>& local = out_.flares.emplace_back();
    row(local.rest, flare.axis / -flare.height, 1 - at.x / flare.height);
    row(local.x, c * flare.x + s * flare.y, rho);
    row(local.y, c * flare.y - s * flare.x, 0);
    local.spread = static_cast<T>(flare.spread);
    local.sharpness = static_cast<T>(flare.sharpness);
    local.section = flare.section;
    local.first_gap = index(out_.flare_gaps);
    double narrowest = kInfinity;
    for (const FlareGap& gap : gaps_in_arc(flare, arc_of_ball(azimuth, rho, reach_ * (1 + 1e-6)))) {
      out_.flare_gaps.push_back({static_cast<T>(gap.begin - azimuth), static_cast<T>(1 / gap.width), static_cast<T>(gap.length),
                                 static_cast<T>(gap.next_length - gap.length)});
      narrowest = std::min(narrowest, gap.width);
    }
    local.gap_count = index(out_.flare_gaps) - local.first_gap;
    const double scale = std::max(1.0, std::abs(step.width));
    note(0.2 * scale * (std::abs(at.x) + reach_) / flare.height * (flare.spread + flare.sharpness * flare.longest));
    note(2 * scale / narrowest);
  }

  void add(const CompiledHalfSpace& h, Step& step) {
    step.kind = StepKind::kHalfSpace;
    step.first = index(out_.half_spaces);
    LocalHalfSpace<T>& local = out_.half_spaces.emplace_back();
    assign(local.point, -glm::dot(origin_ - h.point, h.normal) * h.normal);   // of the plane, the nearest to the origin
    assign(local.normal, h.normal);
    local.inverse_two_widths = static_cast<T>(0.5 / h.width);
    note(reach_ / h.width);
  }

  void add(const Lateral& l) {
    LocalLateral<T>& local = out_.laterals.emplace_back();
    assign(local.point, l.point - origin_);
    assign(local.direction, l.direction);
    local.half_per_softness = static_cast<T>(0.5 / l.softness);
    local.reach = static_cast<T>(l.reach);
    local.per_reach = static_cast<T>(1 / l.reach);
    note(reach_ / l.softness);
  }

 private:
  template <class Shapes>
  static std::uint32_t index(const Shapes& shapes) {
    return static_cast<std::uint32_t>(shapes.size());
  }
  double nearest(const Vec3& a, const Vec3& axis, double begin, double end) const {
    return std::clamp(glm::dot(origin_ - a, axis), begin, end);
  }
  static void row(T (&to)[4], const Vec3& direction, double offset) {
    for (int i = 0; i < 3; ++i) to[i] = static_cast<T>(direction[i]);
    to[3] = static_cast<T>(offset);
  }
  void note(double ratio) { largest_ratio_ = std::max(largest_ratio_, ratio); }

  /// Of distances in units of `unit` metres.
  LocalFalloff<T> falloff(double unit) const {
    const double per_unit = per_support_ * unit;
    const double per_square = per_unit * per_unit;
    return {static_cast<T>(per_square), static_cast<T>(strength_), static_cast<T>(-6 * strength_ * per_square)};
  }
  /// Notes a shape that is measured from `anchor`, and gives its kind and place to the step.
  void begin(Step& step, StepKind kind, std::uint32_t at, const Vec3& anchor) {
    step.kind = kind;
    step.first = at;
    note((reach_ + glm::length(anchor)) * per_support_ * std::max(1.0, std::abs(strength_)));
  }

  void add(const PointSkeleton<double>& k, Step& step) {
    begin(step, StepKind::kPoint, index(out_.points), k.center - origin_);
    LocalPoint<T>& local = out_.points.emplace_back();
    assign(local.center, k.center - origin_);
    local.falloff = falloff(1);
  }
  void add(const SegmentSkeleton<double>& k, Step& step) {
    const double s = nearest(k.a, k.axis, k.begin, k.end);
    const Vec3 anchor = k.a + s * k.axis - origin_;
    begin(step, StepKind::kSegment, index(out_.segments), anchor);
    LocalSegment<T>& local = out_.segments.emplace_back();
    assign(local.a, anchor);
    assign(local.axis, k.axis);
    local.begin = static_cast<T>(k.begin - s);
    local.end = static_cast<T>(k.end - s);
    local.falloff = falloff(1);
  }
  void add(const ConeSkeleton<double>& k, Step& step) {
    const double s = nearest(k.base, k.axis, 0, k.height), side = std::hypot(k.height, k.disc_radius);
    const Vec3 anchor = k.base + s * k.axis - origin_;
    begin(step, StepKind::kCone, index(out_.cones), anchor);
    LocalCone<T>& local = out_.cones.emplace_back();
    const Vec3 u = glm::normalize(glm::cross(k.axis, std::abs(k.axis.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
    coordinate(local.u, u, anchor);
    coordinate(local.v, glm::cross(k.axis, u), anchor);
    coordinate(local.h, k.axis, anchor);
    const double along = s / k.height, unit = per_support_;
    local.core = static_cast<T>(k.disc_radius * (1 - along) * unit);
    local.tangent_rho = static_cast<T>(-k.disc_radius / side);
    local.tangent_h = static_cast<T>(k.height / side);
    local.side_begin = static_cast<T>(-along * side * unit);
    local.side_end = static_cast<T>((1 - along) * side * unit);
    local.base_h = static_cast<T>(-s * unit);
    local.disc_radius = static_cast<T>(k.disc_radius * unit);
    local.falloff = falloff(1 / per_support_);
  }
  void coordinate(T (&row)[4], const Vec3& direction, const Vec3& anchor) const {
    for (int i = 0; i < 3; ++i) row[i] = static_cast<T>(direction[i] * per_support_);
    row[3] = static_cast<T>(-glm::dot(direction, anchor) * per_support_);
  }
  void add(const DiscSkeleton<double>& k, Step& step) { add_ring(StepKind::kDisc, k.center, k.normal, k.disc_radius, step); }
  void add(const CircleSkeleton<double>& k, Step& step) {
    add_ring(StepKind::kCircle, k.center, k.normal, k.ring_radius, step);
  }
  void add_ring(StepKind kind, const Vec3& center, const Vec3& normal, double radius, Step& step) {
    begin(step, kind, index(out_.rings), center - origin_);
    LocalRing<T>& local = out_.rings.emplace_back();
    assign(local.center, center - origin_);
    assign(local.normal, normal);
    local.radius = static_cast<T>(radius);
    local.falloff = falloff(1);
  }
  void add(const BoxSkeleton<double>& k, Step& step) {
    begin(step, StepKind::kBox, index(out_.boxes), k.center - origin_);
    LocalBox<T>& local = out_.boxes.emplace_back();
    assign(local.center, k.center - origin_);
    assign(local.half_size, k.half_size);
    for (int i = 0; i < 3; ++i) assign(local.axes[i], k.world_from_box[i]);
    local.falloff = falloff(1);
  }

  BatchProgram<T>& out_;
  Vec3 origin_{0.0};
  double reach_ = 0, largest_ratio_ = 0;
  double per_support_ = 0, strength_ = 1;   // of the primitive that is being placed
};

template <class T>
void add_frame(const Warp& warp, std::uint32_t outside, BatchProgram<T>& out) {
  LocalFrame<T>& frame = out.frames.emplace_back();
  frame.outside = outside;
  frame.origin = unwarp(warp, out.frames[outside].origin);
  const RigidWarp* const rigid = std::get_if<RigidWarp>(&warp);
  frame.linear = rigid != nullptr;
  if (rigid)
    for (int i = 0; i < 3; ++i) assign(frame.matrix[i], rigid->axes[i] / rigid->scale);   // rows of the transposed
  else
    frame.warp = warp;
}

bool is_leaf(Op op) { return op == Op::kPrimitive || op == Op::kHalfSpace || is_swept(op); }

}  // namespace

template <class T>
void BatchProgram<T>::clear() {
  steps.clear();
  frames.clear();
  points.clear();
  segments.clear();
  cones.clear();
  rings.clear();
  boxes.clear();
  half_spaces.clear();
  swept.clear();
  flares.clear();
  flare_gaps.clear();
  laterals.clear();
  slot_count = 0;
}

void BatchCompiler::find_consumers(const TapeView& view) {
  consumers_.assign(view.tape.instructions().size(), {static_cast<std::uint32_t>(view.tape.instructions().size()), 0});   // the last value has none
  stack_.clear();
  for (std::uint32_t at = 0; at < view.tape.instructions().size(); ++at) {
    const Instruction& in = view.tape.instructions()[at];
    if (!is_leaf(in.op)) {
      const std::size_t begin = stack_.size() - in.count;
      for (std::uint32_t child = 0; child < in.count; ++child) consumers_[stack_[begin + child]] = {at, child};
      stack_.resize(begin);
    }
    stack_.push_back(at);
  }
}

template <class T>
bool BatchCompiler::compile(const TapeView& view, const Box& box, const Vec3& origin, BatchProgram<T>& out) {
  constexpr bool kFloat = std::is_same_v<T, float>;
  if (kFloat && !box.bounded()) return false;
  out.clear();
  const double half = box.bounded() ? 0.5 * glm::length(box.size()) : 0;   // only asked for floats
  out.frames.resize(1);
  out.frames[0].origin = origin;
  out.frames[0].linear = true;
  reaches_.assign(1, half);
  for (std::size_t k = 1; k < view.frame_count(); ++k) {
    const std::uint32_t outside = view.outside_of(k);
    add_frame(view.warp_of(k), outside, out);
    const UnwarpedBall reached = unwarp(view.warp_of(k), Ball{out.frames[outside].origin, reaches_[outside]});
    if (kFloat && !reached.certain) return false;
    reaches_.push_back(reached.ball.radius);
  }

  find_consumers(view);
  ShapePlacer<T> placer(out);
  placer.enter(origin, half);
  std::uint32_t frame = 0, top = 0;
  for (std::uint32_t at = 0; at < view.tape.instructions().size(); ++at) {
    const Instruction& in = view.tape.instructions()[at];
    const Op op = in.op;
    const CompiledNode& node = view.tree.nodes[in.node];
    if (in.frame != frame) placer.enter(out.frames[in.frame].origin, reaches_[in.frame]);
    frame = in.frame;
    const Consumer& consumer = consumers_[at];
    const bool adds = consumer.child > 0 && view.tape.instructions()[consumer.instruction].op == Op::kSum;
    Step step;
    step.frame = in.frame;
    step.count = in.count;
    step.with_zero = in.with_zero;
    if (is_leaf(op)) {
      step.adds = adds;
      step.slot = adds ? top - 1 : top++;
      out.slot_count = std::max(out.slot_count, top);
    } else if (op != Op::kSum) {   // the children of a sum have been added where its first one stands
      top -= in.count;
      step.slot = top++;
    }
    switch (op) {
      case Op::kPrimitive: placer.place(view.tree.primitive_of(node), step); break;
      case Op::kHalfSpace: placer.add(view.tree.half_spaces[node.payload], step); break;
      case Op::kChain:
      case Op::kFlare:
        step.kind = StepKind::kChain;
        step.width = view.tree.chain_strength_of(node);
        step.first = static_cast<std::uint32_t>(out.swept.size());
        for (std::uint32_t i = in.first; i < in.first + in.count; ++i)
          placer.add_segment(view.tree.segment_of(view.tape.slots()[i]), step.width);
        if (op == Op::kFlare) placer.add(view.tree.flare_of(node), step);
        break;
      case Op::kSum: break;
      case Op::kUnion: step.kind = StepKind::kUnion; break;
      case Op::kIntersection: step.kind = StepKind::kIntersection; break;
      case Op::kDifference:
        step.kind = StepKind::kDifference;
        step.has_first = view.tape.slots()[in.first] == 0;
        break;
      case Op::kRicci:
        step.kind = StepKind::kRicci;
        step.width = view.tree.numbers[node.payload];
        break;
      case Op::kContact:
      case Op::kFork:
        step.kind = op == Op::kFork ? StepKind::kFork : StepKind::kContact;
        step.width = view.tree.blends[node.payload].width;
        step.lip = view.tree.blends[node.payload].lip;
        if (op == Op::kContact) break;
        step.has_first = view.tape.slots()[in.first] == 0;
        step.first = static_cast<std::uint32_t>(out.laterals.size());
        for (std::uint32_t i = step.has_first; i < in.count; ++i)
          placer.add(view.tree.lateral_of(node, view.tape.slots()[in.first + i] - 1));
        break;
      case Op::kScale:
        step.kind = StepKind::kScale;
        step.width = view.tree.numbers[node.payload];
        break;
      case Op::kWarp: step.kind = StepKind::kWarp; break;
    }
    if (op != Op::kSum) out.steps.push_back(step);
    if (adds && !is_leaf(op)) {
      Step add;
      add.slot = --top - 1;
      out.steps.push_back(add);
    }
  }
  return !kFloat || placer.largest_ratio() <= kLargestRatio;
}

template struct BatchProgram<float>;
template struct BatchProgram<double>;
template bool BatchCompiler::compile(const TapeView&, const Box&, const Vec3&, BatchProgram<float>&);
template bool BatchCompiler::compile(const TapeView&, const Box&, const Vec3&, BatchProgram<double>&);

}  // namespace cambium
