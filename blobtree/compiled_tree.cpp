#include "blobtree/compiled_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cambium {
namespace {

template <class T>
std::size_t bytes_of(const std::vector<T>& v) {
  return v.capacity() * sizeof(T);
}

NativeAxis axis_of(const PointSkeleton<double>& k) { return {k.center, {0, 0, 1}}; }
NativeAxis axis_of(const SegmentSkeleton<double>& k) { return {k.a, k.axis}; }
NativeAxis axis_of(const ConeSkeleton<double>& k) { return {k.base, k.axis}; }
NativeAxis axis_of(const DiscSkeleton<double>& k) { return {k.center, k.normal}; }
NativeAxis axis_of(const CircleSkeleton<double>& k) { return {k.center, k.normal}; }
NativeAxis axis_of(const BoxSkeleton<double>& k) { return {k.center, k.world_from_box[2]}; }

/// Turns v as the shortest rotation from one unit vector to another would.
Vec3 transported(const Vec3& v, const Vec3& from, const Vec3& to) {
  const Vec3 cross = glm::cross(from, to);
  const double cosine = glm::dot(from, to);
  Vec3 turned = v;
  if (cosine > -1 + 1e-12) turned = v * cosine + glm::cross(cross, v) + cross * (glm::dot(cross, v) / (1 + cosine));
  const Vec3 across = turned - glm::dot(turned, to) * to;
  return glm::length(across) > 1e-12 ? glm::normalize(across) : any_normal(to);
}

}  // namespace

void PrimitiveStore::add(const CompiledPrimitive& primitive) {
  std::visit([&]<class Shape>(const Shape& shape) {
    auto& array = std::get<std::vector<Shape>>(shapes_);
    entries_.push_back({primitive.radius, primitive.strength, static_cast<std::uint32_t>(primitive.shape.index()),
                        static_cast<std::uint32_t>(array.size())});
    array.push_back(shape);
  }, primitive.shape);
}

CompiledPrimitive PrimitiveStore::operator[](std::size_t i) const {
  const Entry& entry = entries_[i];
  SkeletonShape<double> shape;
  [&]<std::size_t... kKind>(std::index_sequence<kKind...>) {
    ((entry.kind == kKind ? void(shape = std::get<kKind>(shapes_)[entry.place]) : void()), ...);
  }(std::make_index_sequence<std::variant_size_v<SkeletonShape<double>>>{});
  return {std::move(shape), entry.radius, entry.strength};
}

void PrimitiveStore::shrink_to_fit() {
  entries_.shrink_to_fit();
  std::apply([](auto&... array) { (array.shrink_to_fit(), ...); }, shapes_);
}

std::size_t PrimitiveStore::memory_bytes() const {
  return bytes_of(entries_) + std::apply([](const auto&... array) { return (bytes_of(array) + ...); }, shapes_);
}

CarriedCoordinates CarriedCoordinates::from(const AtomCoordinates& at, const Vec3& axis) {
  const Vec3 normal = any_normal(axis);
  return {at.v, std::cos(at.turn) * normal + std::sin(at.turn) * glm::cross(axis, normal), axis};
}

AtomCoordinates CarriedCoordinates::at_atom() const {
  const Vec3 normal = any_normal(axis);
  return {v, std::atan2(glm::dot(u, glm::cross(axis, normal)), glm::dot(u, normal))};
}

void CarriedCoordinates::advance(const SweptSegment<double>& passed, const SweptSegment<double>& next) {
  v += passed.end;
  if (!(next.end > 0)) return;
  u = transported(u, axis, next.axis);
  axis = next.axis;
}

CarriedCoordinates CompiledTree::coordinates_of(std::uint32_t atom) const {
  const std::uint32_t run = run_of(atom), first = run_first_atom[run];
  const CompiledNode& node = node_of(atom);
  if (node.op == Op::kHalfSpace) return CarriedCoordinates::from(run_begin[run], {0, 0, 1});
  if (node.op == Op::kPrimitive) return CarriedCoordinates::from(run_begin[run], native_axis(primitive_of(node)).axis);
  SweptSegment<double> segment = segment_of(first);
  CarriedCoordinates carried = CarriedCoordinates::from(run_begin[run], segment.axis);
  for (std::uint32_t a = first + 1; a <= atom; ++a) {
    const SweptSegment<double> next = segment_of(a);
    carried.advance(segment, next);
    segment = next;
  }
  return carried;
}

SweptSegment<double> CompiledTree::segment_of(std::uint32_t atom) const {
  const ChainNode* const ends = segment_ends(node_of(atom), atom);
  const ChainNode &from = ends[0], &to = ends[1];
  const Vec3 d = to.position - from.position;
  const double length = glm::length(d);
  if (!(length > 0)) return {from.position, {0, 0, 1}, 0, 0, std::max(from.radius, to.radius), 0};  // the thicker ball
  return {from.position, d / length, 0, length, from.radius, (to.radius - from.radius) / length};
}

Box CompiledTree::segment_support(const CompiledNode& node, std::uint32_t atom) const {
  const ChainNode* const ends = segment_ends(node, atom);
  const double per_radius = kSupportPerRadius * reach_of(node, atom);
  Box box;
  for (int k = 0; k < 2; ++k) {
    const double reach = per_radius * ends[k].radius;
    box.extend(Box{ends[k].position - reach, ends[k].position + reach});
  }
  const Vec3 slack = 1e-9 * (box.hi - box.lo) + 1e-12 * (glm::abs(box.lo) + glm::abs(box.hi));
  return {box.lo - slack, box.hi + slack};
}

Box CompiledTree::bounds_of(std::uint32_t atom) const {
  const CompiledNode& node = node_of(atom);
  const Box box = run_bounds[run_of(atom)].box();
  if (!is_swept(node.op) || node.warp != kNone) return box;
  const Box own = Box::intersection(box, segment_support(node, atom));
  return own.empty() ? Box{} : own;
}

double CompiledTree::radius_of(std::uint32_t atom) const {
  const CompiledNode& node = node_of(atom);
  if (node.op == Op::kHalfSpace) return kInfinity;
  if (node.op == Op::kPrimitive) return primitives.radius(node.payload);
  const ChainNode* const ends = segment_ends(node, atom);
  const auto [least, most] = std::minmax(ends[0].radius, ends[1].radius);
  return ends[0].position == ends[1].position ? most : least;
}

std::size_t CompiledTree::memory_bytes() const {
  const std::size_t of_nodes = bytes_of(nodes) + bytes_of(children) + bytes_of(blends) + bytes_of(laterals) + bytes_of(numbers) +
                               bytes_of(warps);
  std::size_t bytes_of_flares = bytes_of(flares);
  for (const CompiledFlare& flare : flares) bytes_of_flares += bytes_of(flare.gaps);
  const std::size_t of_shapes = primitives.memory_bytes() + bytes_of(half_spaces) + bytes_of(chains) + bytes_of(chain_nodes) +
                                bytes_of_flares;
  const std::size_t of_atoms = bytes_of(leaves) + bytes_of(node_of_atom) + bytes_of(run_bounds) + bytes_of(run_begin) +
                               bytes_of(run_first_atom);
  return sizeof(*this) + of_nodes + of_shapes + of_atoms + index.memory_bytes() + ancestors.memory_bytes();
}

Interval primitive_interval(const CompiledPrimitive& p, const Ball& ball) {
  const double d = std::visit([&](const auto& shape) { return distance(shape, ball.center).value; }, p.shape);
  return falloff_interval(std::max(0.0, d - ball.radius) * p.inverse_support, (d + ball.radius) * p.inverse_support, p.strength);
}

Interval half_space_interval(const CompiledHalfSpace& h, const Ball& ball) {
  const double s = glm::dot(ball.center - h.point, h.normal);
  const auto f = [&](double at) { return std::clamp(0.5 - at / (2 * h.width), 0.0, 1.0); };
  return {f(s + ball.radius), f(s - ball.radius)};
}

NativeAxis native_axis(const CompiledPrimitive& primitive) {
  return std::visit([](const auto& shape) { return axis_of(shape); }, primitive.shape);
}

Vec3 any_normal(const Vec3& axis) {
  return glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
}

}  // namespace cambium
