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

SweptSegment<double> CompiledTree::segment_of(std::uint32_t atom) const {
  const ChainNode &from = chain_nodes[atoms[atom].element], &to = chain_nodes[atoms[atom].element + 1];
  const Vec3 d = to.position - from.position;
  const double length = glm::length(d);
  if (!(length > 0)) return {from.position, {0, 0, 1}, 0, 0, std::max(from.radius, to.radius), 0};  // the thicker ball
  return {from.position, d / length, 0, length, from.radius, (to.radius - from.radius) / length};
}

double CompiledTree::radius_of(std::uint32_t atom) const {
  const CompiledNode& node = nodes[atoms[atom].node];
  if (node.op == Op::kHalfSpace) return kInfinity;
  if (node.op == Op::kPrimitive) return primitives.radius(node.payload);
  const ChainNode &from = chain_nodes[atoms[atom].element], &to = chain_nodes[atoms[atom].element + 1];
  return from.position == to.position ? std::max(from.radius, to.radius) : std::min(from.radius, to.radius);
}

std::size_t CompiledTree::memory_bytes() const {
  return sizeof(*this) + bytes_of(nodes) + bytes_of(children) + primitives.memory_bytes() + bytes_of(half_spaces) + bytes_of(chains) +
         bytes_of(chain_nodes) + bytes_of(blends) + bytes_of(laterals) + bytes_of(numbers) + bytes_of(warps) + bytes_of(atoms) +
         bytes_of(bounds_of_atoms) + bytes_of(coordinates) + bytes_of(owners) + index.memory_bytes() + ancestors.memory_bytes();
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
NativeAxis native_axis(const SweptSegment<double>& segment) { return {segment.a, segment.axis}; }

Vec3 any_normal(const Vec3& axis) {
  return glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
}

}  // namespace cambium
