// The writers behind write_mesh, each keeping its library's headers to itself. False if the writer failed.
#pragma once

#include "polygonize/mesh_io.h"

#include <array>
#include <cstddef>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace cambium {

/// z-up to y-up, a quarter turn about x that keeps right-handedness: (x, y, z) becomes (x, z, -y).
template <class Vector>
Vector turned(const Vector& v, UpAxis up) {
  return up == UpAxis::kZ ? v : Vector(v.x, v.z, -v.y);
}

/// One colour for each vertex; empty if it has none.
inline const std::vector<std::array<std::uint8_t, 4>>& colors_of(const MeshLevel& level) {
  return level.attributes && !level.attributes->colors.empty() ? level.attributes->colors : level.mesh->colors;
}

/// Bytes on their way to a stream, a megabyte at a time.
class ByteSink {
 public:
  explicit ByteSink(std::ostream& out) : out_(out) { bytes_.reserve(kFull + 4096); }
  ~ByteSink() { flush(); }
  ByteSink(const ByteSink&) = delete;
  ByteSink& operator=(const ByteSink&) = delete;

  void text(std::string_view s) { raw(s.data(), s.size()); }
  template <class T>
  void put(const T& value) {
    raw(&value, sizeof(T));
  }
  void raw(const void* data, std::size_t size) {
    const char* const begin = static_cast<const char*>(data);
    bytes_.insert(bytes_.end(), begin, begin + size);
    if (bytes_.size() >= kFull) flush();
  }
  void flush() {
    out_.write(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
    bytes_.clear();
  }

 private:
  static constexpr std::size_t kFull = std::size_t{1} << 20;
  std::ostream& out_;
  std::vector<char> bytes_;
};

/// extension: "stl" (binary) or "off".
bool write_with_openmesh(const MeshLevel& level, std::ostream& out, const std::string& extension, UpAxis up);

bool write_obj(const MeshLevel& level, std::span<const MeshLeaves> leaves, std::ostream& out, UpAxis up);

/// Binary, little-endian.
bool write_ply(const MeshLevel& level, std::ostream& out, UpAxis up);

/// Binary glTF 2.0, y-up. Errors: std::runtime_error if it exceeds the format's 4 GiB.
bool write_glb(const MeshFile& file, std::ostream& out);

}  // namespace cambium
