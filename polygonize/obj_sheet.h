// Wavefront .obj read as a sheet: a leaf that somebody modelled.
#pragma once

#include "blobtree/sheet.h"

#include <string>
#include <string_view>

namespace cambium {

/// `v`, `vt`, `vn` and `f`, with polygons cut into fans from their first corner; everything else is read over, so it is one sheet
/// whatever its groups and materials. Where a corner has no normal all normals are means of the triangles'; one without texture
/// coordinates has (0, 0). `file` is only named in messages.
/// Errors: InputError naming line and column, also where there is no face. Cost: linear.
Sheet parse_obj_sheet(std::string_view text, const std::string& file);

}  // namespace cambium
