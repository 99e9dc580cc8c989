#include "polygonize/corner_normals.h"
#include "polygonize/mesh_formats.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string>
#include <string_view>

namespace cambium {
namespace {

// Lines of words and numbers. Floats have the fewest digits that tell them apart: twigs 30 m from the origin keep their shape.
class Lines {
 public:
  explicit Lines(std::ostream& out) : sink_(out) {}
  Lines& word(std::string_view s) {
    sink_.text(s);
    return *this;
  }
  template <class Number>
  Lines& number(Number value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    sink_.raw(digits.data(), static_cast<std::size_t>(end - digits.data()));
    return *this;
  }
  template <class Vector>
  void vector(std::string_view kind, const Vector& v) {
    word(kind);
    for (int a = 0; a < v.length(); ++a) word(" ").number(static_cast<float>(v[a]));
    word("\n");
  }

 private:
  ByteSink sink_;
};

/// How many of each kind of line stand before.
struct Before {
  std::size_t positions = 0, uvs = 0, normals = 0;
};

void write_leaves(const MeshLeaves& leaves, UpAxis up, Lines& lines, Before& before) {
  const Sheet& sheet = leaves.sheet;
  std::string material = leaves.material.name;
  std::replace(material.begin(), material.end(), ' ', '_');
  lines.word("usemtl ").word(material).word("\n");
  for (const glm::vec3& p : sheet.positions) lines.vector("v", turned(p, up));
  for (const glm::vec2& uv : sheet.uvs) lines.vector("vt", uv);
  for (const glm::vec3& n : sheet.normals) lines.vector("vn", turned(n, up));
  for (const auto& triangle : sheet.triangles) {
    lines.word("f");
    for (const std::uint32_t corner : triangle) {
      lines.word(" ").number(before.positions + corner + 1);
      lines.word("/").number(before.uvs + corner + 1);
      lines.word("/").number(before.normals + corner + 1);
    }
    lines.word("\n");
  }
  before.positions += sheet.positions.size();
  before.uvs += sheet.uvs.size();
  before.normals += sheet.normals.size();
}

}  // namespace

bool write_obj(const MeshLevel& level, std::span<const MeshLeaves> leaves, std::ostream& out, UpAxis up) {
  const Mesh& mesh = *level.mesh;
  const bool with_uv = level.attributes && !level.attributes->uvs.empty(), with_normals = !mesh.normals.empty();
  const CornerNormals corners = corner_normals(mesh);
  const std::vector<std::uint32_t> groups = smoothing_groups(mesh, corners);
  Lines lines(out);
  lines.word("# Cambium\n");
  if (!leaves.empty()) lines.word("o wood\n");
  for (const Vec3& p : mesh.positions) lines.vector("v", turned(p, up));
  if (with_uv)
    for (const glm::vec2& uv : level.attributes->uvs) lines.vector("vt", uv);
  for (const glm::vec3& n : corners.normals) lines.vector("vn", turned(n, up));
  std::uint32_t group = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (with_normals && groups[t] != group) lines.word("s ").number(group = groups[t]).word("\n");
    lines.word("f");
    for (int c = 0; c < 3; ++c) {
      lines.word(" ").number(mesh.triangles[t][c] + 1);
      if (with_uv || with_normals) lines.word("/");
      if (with_uv) lines.number(level.attributes->uv_triangles[t][c] + 1);
      if (with_normals) lines.word("/").number(corners.at(mesh, t, c) + 1);
    }
    lines.word("\n");
  }
  Before before{mesh.positions.size(), with_uv ? level.attributes->uvs.size() : 0, corners.normals.size()};
  if (!leaves.empty()) lines.word("o leaves\ns off\n");
  for (const MeshLeaves& part : leaves) write_leaves(part, up, lines, before);
  return true;
}

}  // namespace cambium
