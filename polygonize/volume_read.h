// Numbers by place out of OpenVDB files.
#pragma once

#include "blobtree/geometry.h"

#include <filesystem>
#include <functional>
#include <string>

namespace cambium {

/// The float grid of that name, or the first of the file if `grid` is empty, as a function of places in world metres: between voxels linear
/// in each axis, outside the grid its background; a background of 0, which most tools write, counts as 1, and so do inactive voxels that
/// hold it. Every other value, the background too, is finite and above 0: it is what weights are multiplied by. Used by threads at once; holds the grid as long as it lives. Cost: a tenth of a microsecond a call.
/// Errors: InputError naming the file where there is no such grid, or a value is none of those; std::runtime_error naming it where
/// it cannot be read.
std::function<double(const Vec3&)> read_factor_volume(const std::filesystem::path& path, const std::string& grid = {});

}  // namespace cambium
