// Points to evaluate at, and the field there, as CSV.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "blobtree/field.h"

namespace cambium {

/// Rows of x,y,z in metres; one header row `x,y,z` may stand first; empty lines are skipped.
/// Errors: InputError with line and column for anything that is not three finite numbers, or if no file can be read.
std::vector<Vec3> read_points(const std::filesystem::path& path);

/// Header x,y,z,f,gx,gy,gz and one row per point, numbers as %.9g. points and samples are of equal length.
std::string samples_as_csv(const std::vector<Vec3>& points, const std::vector<Sample>& samples);

}  // namespace cambium
