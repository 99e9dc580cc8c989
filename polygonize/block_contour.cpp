#include "polygonize/block_contour.h"

#include "polygonize/qef.h"

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

// Float batches agree with the double field to 1e-4 where values are about 1; nearer to the surface than ten times that a
// corner's sign is decided in double.
constexpr float kDoubtfulValue = 1e-3f;
// Vertices stay this far inside their cells (in voxels), so that no two can meet.
constexpr float kCellMargin = 0.02f;
constexpr float kReach = 0.5f - kCellMargin;
constexpr int kRootRounds = 6;
constexpr float kRootValue = 2e-5f;
constexpr int kSettleRounds = 4;
constexpr float kSmoothTolerance = 0.01f;   // voxels: a vertex this near to the surface is not moved
constexpr float kCreaseTolerance = 0.05f;   // on a crease a Newton step would pull it off the edge
constexpr float kRescueDistance = 0.25f;    // voxels
constexpr float kFlatSpread = 0.8f;         // cosine: beyond it the gradient at a vertex speaks for one side of a crease only

glm::vec3 clamp_to_cell(const glm::vec3& p) { return glm::clamp(p, glm::vec3(-kReach), glm::vec3(kReach)); }

bool finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

void BlockContourer::resize_batch(std::size_t n) {
  for (auto* v : {&x_, &y_, &z_, &f_, &gx_, &gy_, &gz_}) v->resize(n);
}

void BlockContourer::find_cells(Evaluator& evaluator, const PrunedField& field, const CellPlace& place, BlockContour& out) {
  place_ = place;
  const std::uint64_t x0 = std::uint64_t{place[0]} * kBlockCells, y0 = std::uint64_t{place[1]} * kBlockCells,
                      z0 = std::uint64_t{place[2]} * kBlockCells;
  corner_from_origin_ = lattice_.point(x0, y0, z0) - field.origin();
  resize_batch(values_.size());
  for (int z = 0; z < kCorners; ++z)
    for (int y = 0; y < kCorners; ++y)
      for (int x = 0; x < kCorners; ++x) {
        const int at = corner(x, y, z);
        x_[at] = static_cast<float>(corner_from_origin_.x + lattice_.voxel * x);
        y_[at] = static_cast<float>(corner_from_origin_.y + lattice_.voxel * y);
        z_[at] = static_cast<float>(corner_from_origin_.z + lattice_.voxel * z);
      }
  evaluator.values(field, x_, y_, z_, f_);
  float largest = 1;
  for (const float f : f_) largest = std::max(largest, std::abs(f));
  const float doubtful = kDoubtfulValue * largest;
  for (int z = 0; z < kCorners; ++z)
    for (int y = 0; y < kCorners; ++y)
      for (int x = 0; x < kCorners; ++x) {
        const int at = corner(x, y, z);
        values_[at] = f_[at] - static_cast<float>(kIso);
        if (!(std::abs(values_[at]) > doubtful)) {
          values_[at] = static_cast<float>(evaluator.value(field, lattice_.point(x0 + x, y0 + y, z0 + z)) - kIso);
        }
        inside_[at] = values_[at] >= 0;
      }

  out.cells.place = place;
  for (int z = 0; z < kBlockCells; ++z)
    for (int y = 0; y < kBlockCells; ++y)
      for (int x = 0; x < kBlockCells; ++x) {
        int mask = 0;
        for (int c = 0; c < 8; ++c) mask |= inside_[corner(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2))] << c;
        if (mask == 0 || mask == 255) continue;
        out.cells.append(x, y, z, static_cast<std::uint8_t>(mask));
        for (int axis = 0; axis < 3; ++axis) out.owned_crossings += edge_crossed(mask, 4 * axis);
      }
}

void BlockContourer::collect_crossings() {
  crossings_.clear();
  constexpr std::array<int, 3> kStep{corner(1, 0, 0), corner(0, 1, 0), corner(0, 0, 1)};
  for (int z = 0; z < kCorners; ++z)
    for (int y = 0; y < kCorners; ++y)
      for (int x = 0; x < kCorners; ++x) {
        const int at = corner(x, y, z);
        const std::array<int, 3> place{x, y, z};
        for (int axis = 0; axis < 3; ++axis) {
          if (place[axis] == kBlockCells || inside_[at] == inside_[at + kStep[axis]]) continue;
          crossing_at_[axis][at] = static_cast<std::uint16_t>(crossings_.size());
          Crossing crossing;
          crossing.axis = static_cast<std::uint8_t>(axis);
          crossing.low = {x, y, z};
          crossing.f_low = values_[at];
          crossing.f_high = values_[at + kStep[axis]];
          crossings_.push_back(crossing);
        }
      }
}

// Regula falsi with the Illinois rule, all edges of the block side by side; then the gradients.
void BlockContourer::locate_crossings(Evaluator& evaluator, const PrunedField& field) {
  const float voxel = static_cast<float>(lattice_.voxel);
  const glm::vec3 base(corner_from_origin_);
  const auto fill = [&](std::size_t i, const Crossing& crossing) {
    const glm::vec3 p = base + voxel * crossing.point();
    x_[i] = p.x, y_[i] = p.y, z_[i] = p.z;
  };
  active_.resize(crossings_.size());
  for (std::uint32_t i = 0; i < active_.size(); ++i) active_[i] = i;
  std::vector<std::int8_t> last_side(crossings_.size(), 0);
  for (int round = 0; round < kRootRounds && !active_.empty(); ++round) {
    resize_batch(active_.size());
    for (std::size_t i = 0; i < active_.size(); ++i) {
      Crossing& c = crossings_[active_[i]];
      const float slope = c.f_high - c.f_low;
      const float t = c.t_in - c.f_low * (c.t_out - c.t_in) / slope;
      c.t = t >= c.t_in && t <= c.t_out ? t : 0.5f * (c.t_in + c.t_out);
      fill(i, c);
    }
    evaluator.values(field, x_, y_, z_, f_);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < active_.size(); ++i) {
      const std::uint32_t id = active_[i];
      Crossing& c = crossings_[id];
      const float f = f_[i] - static_cast<float>(kIso);
      if (!(std::abs(f) > kRootValue)) continue;
      if ((f >= 0) == (c.f_low >= 0)) {
        c.t_in = c.t, c.f_low = f;
        if (last_side[id] < 0) c.f_high *= 0.5f;
        last_side[id] = -1;
      } else {
        c.t_out = c.t, c.f_high = f;
        if (last_side[id] > 0) c.f_low *= 0.5f;
        last_side[id] = 1;
      }
      if (c.t_out - c.t_in > 1e-4f) active_[kept++] = id;
    }
    active_.resize(kept);
  }
  resize_batch(crossings_.size());
  for (std::size_t i = 0; i < crossings_.size(); ++i) fill(i, crossings_[i]);
  evaluator.samples(field, x_, y_, z_, f_, gx_, gy_, gz_);
  for (std::size_t i = 0; i < crossings_.size(); ++i) {
    const glm::vec3 g(gx_[i], gy_[i], gz_[i]);
    const float length = glm::length(g);
    if (std::isfinite(length) && length > 0) crossings_[i].normal = g / -length;
  }
}

void BlockContourer::add_patches(const glm::ivec3& cell, int mask, int flipped_face) {
  const CellCycles& cycles = cell_cycles(mask, flipped_face);
  const std::size_t first = patches_.size();
  patches_.resize(first + cycles.count);
  for (int e = 0; e < 12; ++e) {
    if (cycles.cycle_of_edge[e] == kNoCycle) continue;
    Patch& patch = patches_[first + cycles.cycle_of_edge[e]];
    const int low = edge_low_corner(e);
    const int at = corner(cell.x + (low & 1), cell.y + (low >> 1 & 1), cell.z + (low >> 2));
    patch.crossings[patch.crossing_count++] = crossing_at_[e / 4][at];
  }
  const glm::vec3 center = glm::vec3(cell) + 0.5f;
  for (std::size_t i = first; i < patches_.size(); ++i) {
    Patch& patch = patches_[i];
    patch.cell = cell;
    Qef qef;
    glm::vec3 mass(0.0f), normals(0.0f);
    for (int k = 0; k < patch.crossing_count; ++k) {
      const Crossing& crossing = crossings_[patch.crossings[k]];
      const glm::vec3 p = crossing.point() - center;
      mass += p;
      normals += crossing.normal;
      if (crossing.normal != glm::vec3(0.0f)) qef.add(Vec3(p), Vec3(crossing.normal));
    }
    mass /= static_cast<float>(patch.crossing_count);
    const float length = glm::length(normals);
    if (length > 1e-3f) patch.mean_normal = normals / length;
    for (int k = 0; k < patch.crossing_count; ++k) {
      patch.spread = std::min(patch.spread, glm::dot(patch.mean_normal, crossings_[patch.crossings[k]].normal));
    }
    const Qef::Solution solution = qef.solve(Vec3(mass));
    patch.tolerance = solution.rank > 1 ? kCreaseTolerance : kSmoothTolerance;
    patch.at = clamp_to_cell(glm::vec3(solution.point));
    patch.best = patch.at;
    patch.best_distance = static_cast<float>(kInfinity);
  }
}

// Newton steps along the gradient until each vertex lies on the surface; the best place visited counts.
void BlockContourer::settle_patches(Evaluator& evaluator, const PrunedField& field) {
  const float voxel = static_cast<float>(lattice_.voxel);
  const glm::vec3 base(corner_from_origin_);
  active_.resize(patches_.size());
  for (std::uint32_t i = 0; i < active_.size(); ++i) active_[i] = i;
  for (int round = 0; round < kSettleRounds && !active_.empty(); ++round) {
    resize_batch(active_.size());
    for (std::size_t i = 0; i < active_.size(); ++i) {
      const Patch& patch = patches_[active_[i]];
      const glm::vec3 p = base + voxel * (glm::vec3(patch.cell) + 0.5f + patch.at);
      x_[i] = p.x, y_[i] = p.y, z_[i] = p.z;
    }
    evaluator.samples(field, x_, y_, z_, f_, gx_, gy_, gz_);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < active_.size(); ++i) {
      Patch& patch = patches_[active_[i]];
      const glm::vec3 g = glm::vec3(gx_[i], gy_[i], gz_[i]) * voxel;   // per voxel
      const float f = f_[i] - static_cast<float>(kIso), length = glm::length(g);
      if (!(length > 0) || !std::isfinite(length) || !std::isfinite(f)) continue;
      const float distance = std::abs(f) / length;
      if (distance < patch.best_distance) {
        patch.best = patch.at;
        patch.best_distance = distance;
        patch.best_normal = g / -length;
      }
      if (distance <= patch.tolerance) continue;
      const glm::vec3 step = g * (std::copysign(std::min(distance, 0.5f), -f) / length);
      const glm::vec3 next = clamp_to_cell(patch.at + step);
      if (!finite(next) || glm::length(next - patch.at) < 1e-4f) continue;
      patch.at = next;
      active_[kept++] = active_[i];
    }
    active_.resize(kept);
  }
}

Vec3 BlockContourer::world(const Patch& patch, const glm::vec3& at) const {
  const auto index = [&](int a) { return std::uint64_t{place_[a]} * kBlockCells + static_cast<std::uint64_t>(patch.cell[a]); };
  return lattice_.point(index(0), index(1), index(2)) + lattice_.voxel * (Vec3(at) + 0.5);
}

// A vertex that Newton could not bring near: go towards the nearest crossing, which is on the surface.
void BlockContourer::rescue_patch(Evaluator& evaluator, const PrunedField& field, Patch& patch) const {
  const glm::vec3 center = glm::vec3(patch.cell) + 0.5f, start = patch.best;
  glm::vec3 target(0.0f);
  float nearest = static_cast<float>(kInfinity);
  for (int k = 0; k < patch.crossing_count; ++k) {
    const glm::vec3 p = crossings_[patch.crossings[k]].point() - center;
    if (glm::length(p - start) < nearest) nearest = glm::length(p - start), target = p;
  }
  patch.best_distance = std::min(patch.best_distance, nearest);
  for (const float along : {0.5f, 0.75f, 1.0f}) {
    if (patch.best_distance <= kRescueDistance) return;
    const glm::vec3 at = clamp_to_cell(start + along * (target - start));
    const Sample sample = evaluator.sample(field, world(patch, at));
    const double length = glm::length(sample.gradient);
    float distance = glm::length(target - at);
    if (length > 0) {
      distance = std::min(distance, static_cast<float>(std::abs(sample.value - kIso) / (length * lattice_.voxel)));
    }
    if (distance < patch.best_distance) {
      patch.best = at;
      patch.best_distance = distance;
      patch.best_normal = length > 0 ? glm::vec3(sample.gradient / -length) : glm::vec3(0.0f);
    }
  }
}

PatchVertex BlockContourer::finish_patch(Evaluator& evaluator, const PrunedField& field, const PolygonizeOptions& options,
                                         const Patch& patch) const {
  PatchVertex vertex;
  vertex.position = world(patch, patch.best);
  vertex.distance = static_cast<float>(patch.best_distance * lattice_.voxel);
  const bool crease = patch.spread < kFlatSpread || patch.best_normal == glm::vec3(0.0f);
  vertex.normal = crease && patch.mean_normal != glm::vec3(0.0f) ? patch.mean_normal : patch.best_normal;
  if (vertex.normal == glm::vec3(0.0f)) vertex.normal = {0, 0, 1};
  if (options.color) vertex.color = options.color(evaluator, field, vertex.position, Vec3(vertex.normal));
  return vertex;
}

void BlockContourer::place_vertices(Evaluator& evaluator, const PrunedField& field, const PolygonizeOptions& options,
                                    BlockContour& out) {
  collect_crossings();
  if (crossings_.empty()) return;
  locate_crossings(evaluator, field);
  patches_.clear();
  out.cells.for_each([&](int index, int x, int y, int z) { add_patches({x, y, z}, out.cells.masks[index], kNoFace); });
  const std::size_t standard = patches_.size();
  out.cells.for_each([&](int index, int x, int y, int z) {
    const int mask = out.cells.masks[index], face = flippable_face(mask);
    if (face != kNoFace) add_patches({x, y, z}, mask, face);
  });
  settle_patches(evaluator, field);
  out.vertices.reserve(standard);
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    if (patches_[i].best_distance > kRescueDistance) rescue_patch(evaluator, field, patches_[i]);
    (i < standard ? out.vertices : out.flipped).push_back(finish_patch(evaluator, field, options, patches_[i]));
  }
}

}  // namespace cambium
