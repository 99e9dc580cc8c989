// Surface files (.s) of the Virtual Laboratory: bicubic Bezier patches, with the place that they are held at.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "skeletons/foliage.h"

namespace cambium {

struct PatchSurface {
  OrganShape shape;
  Vec3 end_point{0.0};  ///< in the shape's coordinates: where the turtle goes on
};

/// The contact point comes to the origin, the file's heading along y, its up along z, and its SIZE becomes `size`. Each
/// patch is cut into 8 x 8 quadrangles. Errors: InputError with line and column.
PatchSurface read_patch_surface(std::string_view text, const std::filesystem::path& file, std::string name, double size);

}  // namespace cambium
