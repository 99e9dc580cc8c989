// Contour files (.con): cross-sections of generalized cylinders.
#pragma once

#include <filesystem>
#include <string_view>

namespace cambium {

/// Wood is round here: of a contour all that is read is how thick it is, the radius of the circle of the same area where the
/// line's half width is 1. A contour is a uniform cubic B-spline of its points; an open one is closed by a chord. At least
/// 0.01. The four forms are read: `n dimensions closed|open`, and `cver 1 1` to `1 3`. Errors: InputError with line and
/// column.
double read_contour_radius(std::string_view text, const std::filesystem::path& file);

}  // namespace cambium
