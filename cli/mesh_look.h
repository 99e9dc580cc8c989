// What a mesh looks like: materials for files that take textures along, and the colours of vertices.
#pragma once

#include <string>
#include <vector>

#include "cli/recipe.h"
#include "polygonize/mesh_attributes.h"
#include "polygonize/mesh_io.h"
#include "raytrace/bark.h"

namespace cambium {

struct MeshLook {
  std::vector<MeshMaterial> materials;   ///< by branch order
  Bark bark;                             ///< of the vertex colours
  double aspect = 1;                     ///< width over height of the textures; where they differ, of the first
  std::vector<std::string> warnings;     ///< images that the file cannot take
};

/// `takes_textures`: of the file. A PNG or JPEG that the recipe names goes along as it is, and multiplies the vertex colours, so
/// they are then only what cuts, ridges and scars do to it. Any other image, and the built-in bark, are vertex colours alone.
/// Errors: InputError where the recipe names an image that cannot be read.
MeshLook mesh_look(const Recipe& recipe, bool takes_textures);

/// sRGB of the bark, without what is finer than the mesh. The bark must outlive it.
SurfaceColor vertex_colors(const Bark& bark);

}  // namespace cambium
