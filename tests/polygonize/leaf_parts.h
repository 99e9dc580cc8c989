// Leaves for the writers' tests.
#pragma once

#include "polygonize/mesh_io.h"

#include <memory>
#include <string>
#include <vector>

namespace cambium::testing {

/// Two parts: two triangles with a picture, and one without.
inline std::vector<MeshLeaves> leaf_parts(const std::string& picture) {
  std::vector<MeshLeaves> parts(2);
  for (MeshLeaves& part : parts) {
    part.sheet.positions = {{0, 0, 1}, {1, 0, 1}, {0, 2, 1}, {0, 0, 4}};
    part.sheet.uvs = {{0, 0}, {1, 0}, {0, 1}, {0.5f, 0.25f}};
    part.sheet.triangles = {{0, 1, 2}, {0, 1, 3}};
    part.sheet.normals = mean_normals(part.sheet);
    part.branch = {5, 5, 5, 6};
    part.pivot.assign(4, {0, 0, 1});
    part.material.leaf = true;
    part.material.name = "leaf of birch";
  }
  parts[0].material.texture = std::make_shared<const std::string>(picture);
  parts[1].sheet.triangles.pop_back();
  return parts;
}

}  // namespace cambium::testing
