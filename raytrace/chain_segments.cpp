#include "raytrace/chain_segments.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

constexpr std::uint32_t kUnseen = 0xffffffffu;
constexpr double kLongestPiece = 6;   // in largest radii: what reaches far across a box makes the box large

}  // namespace

std::uint32_t ChainSegments::add(const ActiveChain& chain) {
  if (chain.primitive() >= first_.size()) first_.resize(chain.primitive() + 1, kUnseen);
  std::uint32_t& first = first_[chain.primitive()];
  if (first == kUnseen) {
    first = static_cast<std::uint32_t>(segments_.size());
    const auto nodes = chain.nodes();
    for (std::size_t i = 1; i < nodes.size(); ++i)
      segments_.emplace_back(swept_segment(nodes[i - 1].position, nodes[i - 1].radius, nodes[i].position, nodes[i].radius));
  }
  return first;
}

void ChainSegments::find_wood(const SurfaceCover& cover) {
  if (cover.empty()) return;
  const PrunedField part = cover.field(0);
  const bool all = ActiveChain::all_blend(part, {Vec3(-kInfinity), Vec3(kInfinity)});
  tbb::parallel_for(std::size_t{0}, segments_.size(), [&](std::size_t k) {
    ChainSegment& segment = segments_[k];
    if (segment.cell == ChainSegment::kNoCell) return;
    segment.is_wood = all || ActiveChain::all_blend(part, solid_bounds(segment.swept, {Vec3(-kInfinity), Vec3(kInfinity)}));
  });
}

std::optional<double> ChainSegments::meet(std::uint32_t k, const Ray& ray, const RaySegment& part) const {
  const ChainSegment& segment = segments_[k];
  const Vec3 to_middle = segment.middle - ray.origin;
  const double nearest = glm::dot(to_middle, ray.direction), ball = segment.half_length + segment.thickest;
  const Vec3 across = to_middle - nearest * ray.direction;
  if (glm::dot(across, across) > ball * ball * (1 + 1e-9)) return std::nullopt;
  const RaySegment near{std::max(part.begin, nearest - 1.001 * ball), std::min(part.end, nearest + 1.001 * ball)};
  if (!(near.begin <= near.end)) return std::nullopt;
  const AxisView view(segment.swept, ray, 0.5 * (near.begin + near.end));
  if (!view.comes_within(segment.thickest)) return std::nullopt;
  return first_inside(segment.swept, ray, near, view);
}

double ChainSegments::radius(std::uint32_t k, const Vec3& p) const {
  const SweptSegment<double>& swept = segments_[k].swept;
  return swept.radius_at(closest_parameter(swept, p - swept.a));
}

std::vector<ChainSegments::Piece> ChainSegments::wood_pieces() const {
  std::vector<Piece> pieces;
  for (std::uint32_t k = 0; k < segments_.size(); ++k) {
    const ChainSegment& segment = segments_[k];
    if (!segment.is_wood) continue;
    const double length = 2 * segment.half_length / (kLongestPiece * segment.thickest);
    const int count = static_cast<int>(std::clamp(std::ceil(length), 1.0, 1000.0));
    for (int i = 0; i < count; ++i) pieces.push_back({k, static_cast<float>(i) / count, static_cast<float>(i + 1) / count});
  }
  return pieces;
}

Box ChainSegments::box(const Piece& piece) const {
  const SweptSegment<double>& k = segments_[piece.segment].swept;
  Box box;
  for (const double share : {piece.begin, piece.end}) {
    const double s = share * k.end, reach = k.radius_at(s) * (1 + 1e-9);
    const Vec3 center = k.a + s * k.axis;
    box.extend(Box{center - reach, center + reach});
  }
  return box;
}

std::size_t ChainSegments::memory_bytes() const {
  return first_.capacity() * sizeof(first_[0]) + segments_.capacity() * sizeof(segments_[0]);
}

}  // namespace cambium
