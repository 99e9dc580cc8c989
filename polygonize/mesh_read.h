// Meshes that others made, from the bytes of their files.
#pragma once

#include "polygonize/mesh.h"

#include <string>
#include <string_view>

namespace cambium {

/// Positions and triangles, nothing else; polygons are cut into fans from their first corner. A file that begins with `ply` is Stanford's
/// PLY, as text or as little-endian binary, any other is Wavefront's OBJ (coordinates then have the digits of a float, and a vertex
/// is there again for each normal and texture coordinate that it is used with). `file` is only named in messages.
/// Errors: InputError for what is malformed, truncated, not finite, out of range or no mesh, naming line and column, or in binary data the
/// byte, counted from 0. Cost: linear in the bytes that are there, whatever counts they claim.
Mesh parse_mesh(std::string_view bytes, const std::string& file);

}  // namespace cambium
