#include "polygonize/crowded_leaves.h"

#include <algorithm>

namespace cambium {
namespace {

struct Sheet {
  Vec3 middle{0.0}, normal{0.0};
  std::vector<Vec3> points;
};

Sheet sheet_of(const SurfaceOctree& tree, const Contour& contour, std::uint32_t patch) {
  Sheet sheet;
  for (const std::uint32_t e : contour.ring(patch)) {
    sheet.points.push_back(crossing_point(tree, contour, e));
    sheet.middle += sheet.points.back();
    sheet.normal += Vec3(contour.crossings[e].normal);
  }
  sheet.middle /= static_cast<double>(sheet.points.size());
  return sheet;
}

bool apart_along(const Vec3& direction, const Sheet& a, const Sheet& b) {
  double highest = -kInfinity, lowest = kInfinity;
  for (const Vec3& p : a.points) highest = std::max(highest, glm::dot(direction, p - a.middle));
  for (const Vec3& p : b.points) lowest = std::min(lowest, glm::dot(direction, p - a.middle));
  return highest < lowest;
}

bool apart(const Sheet& a, const Sheet& b) {
  for (const Vec3& direction :
       {b.middle - a.middle, a.normal, -b.normal, a.normal - b.normal, Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    if (apart_along(direction, a, b) || apart_along(-direction, a, b)) return true;
  }
  return false;
}

}  // namespace

bool is_crowded(const Contour& contour, std::uint32_t patch) {
  const std::vector<Patch>& patches = contour.patches;   // those of a leaf stand together
  const auto same = [&](std::size_t other) { return patches[other].leaf == patches[patch].leaf; };
  return (patch > 0 && same(patch - 1)) || (patch + 1 < patches.size() && same(patch + 1));
}

std::vector<bool> crowded_patches(const Contour& contour) {
  std::vector<bool> crowded(contour.patches.size());
  for (std::uint32_t p = 0; p < crowded.size(); ++p) crowded[p] = is_crowded(contour, p);
  return crowded;
}

Vec3 crowded_position(const SurfaceOctree& tree, const Contour& contour, std::uint32_t patch) {
  constexpr double kMargin = 0.002;   // in edges
  const OctreeLeaf& leaf = tree.leaves()[contour.patches[patch].leaf];
  const Box box = tree.box(leaf);
  const double margin = kMargin * tree.edge(leaf);
  Vec3 sum(0.0);
  for (const std::uint32_t e : contour.ring(patch)) sum += crossing_point(tree, contour, e) - box.lo;
  return glm::clamp(box.lo + sum / static_cast<double>(contour.patches[patch].edge_count), box.lo + margin, box.hi - margin);
}

std::vector<Vec3> entangled_leaves(const SurfaceOctree& tree, const Contour& contour) {
  std::vector<Vec3> found;
  for (std::uint32_t begin = 0; begin < contour.patches.size();) {
    const std::uint32_t leaf = contour.patches[begin].leaf;
    std::vector<Sheet> sheets;
    std::uint32_t end = begin + 1;
    while (end < contour.patches.size() && contour.patches[end].leaf == leaf) ++end;
    if (end > begin + 1) {
      for (std::uint32_t p = begin; p < end; ++p) sheets.push_back(sheet_of(tree, contour, p));
      bool entangled = false;
      for (std::size_t i = 0; i < sheets.size(); ++i)
        for (std::size_t j = i + 1; j < sheets.size(); ++j) entangled = entangled || !apart(sheets[i], sheets[j]);
      if (entangled) found.push_back(tree.box(tree.leaves()[leaf]).center());
    }
    begin = end;
  }
  return found;
}

}  // namespace cambium
