// What a tree's organs look like by its recipe, for rays and for mesh files.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "cli/job.h"
#include "polygonize/mesh_io.h"
#include "raytrace/foliage_scene.h"

namespace cambium {

struct Leaves {
  FoliageScene scene;                            ///< a material for each [[leaf]], then one for organs that none of them matches
  std::map<std::string, std::size_t> shapeless;  ///< organs of which only a name is known: they are drawn as plain leaves
  std::size_t triangles() const;
};

/// The organs as the recipe's [[leaf]] tables have them; what none matches is as it was drawn, or a plain leaf one unit long, green.
/// Organs without size are left out. Errors: InputError for an image or a mesh that cannot be read, and for a leaf that is farther
/// away than floats tell places apart.
Leaves dress_leaves(const Recipe& recipe, const Foliage& foliage, std::span<const std::uint32_t> organ_branches);

/// The same in job.figures, timed; nothing where the tree bears none.
Leaves dress_leaves(Job& job, const BuiltTree& built);

/// Every leaf where it is, one part for each material that has any. `warnings` gets a line for an image that a file cannot take along.
std::vector<MeshLeaves> merged_leaves(const Recipe& recipe, const Leaves& leaves, std::vector<std::string>& warnings);

}  // namespace cambium
