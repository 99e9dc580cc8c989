// The writers behind write_mesh, each keeping its library's headers to itself.
#pragma once

#include "polygonize/mesh_io.h"

#include <array>
#include <ostream>
#include <string>

namespace cambium {

/// z-up to y-up, a quarter turn about x that keeps right-handedness: (x, y, z) becomes (x, z, -y).
template <class Vector>
Vector turned(const Vector& v, UpAxis up) {
  return up == UpAxis::kZ ? v : Vector(v.x, v.z, -v.y);
}

/// extension: "obj", "ply" (binary), "stl" (binary) or "off". False if the library could not write.
bool write_with_openmesh(const Mesh& mesh, std::ostream& out, const std::string& extension, UpAxis up);

/// Binary glTF 2.0, y-up. False if the writer failed. Errors: std::runtime_error if the mesh exceeds the format's 4 GiB.
bool write_glb(const Mesh& mesh, std::ostream& out);

}  // namespace cambium
