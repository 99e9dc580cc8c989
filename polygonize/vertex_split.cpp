#include "polygonize/vertex_split.h"

#include "polygonize/corner_normals.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

/// Corners by (uv, normal), either of which may be the vertex's own. Each uv and each normal belongs to one vertex, so a short list
/// for each uv holds what is known of it.
void number_corners(const Mesh& mesh, const MeshAttributes* attributes, const CornerNormals& normals, SplitMesh& out) {
  const bool with_uv = attributes && !attributes->uvs.empty(), with_normals = !normals.normals.empty();
  const std::size_t keys = with_uv ? attributes->uvs.size() : mesh.positions.size();
  std::vector<std::uint32_t> known(keys, kNone), other, normal_of;   // `other`: the next split vertex of the same uv
  out.triangles.resize(mesh.triangles.size());
  out.vertex.reserve(keys);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t vertex = mesh.triangles[t][c], key = with_uv ? attributes->uv_triangles[t][c] : vertex;
      const std::uint32_t normal = with_normals ? normals.at(mesh, t, c) : vertex;
      std::uint32_t split = known[key];
      while (split != kNone && normal_of[split] != normal) split = other[split];
      if (split == kNone) {
        split = static_cast<std::uint32_t>(out.vertex.size());
        out.vertex.push_back(vertex);
        if (with_uv) out.uv.push_back(key);
        if (with_normals) out.normals.push_back(normals.normals[normal]);
        normal_of.push_back(normal);
        other.push_back(known[key]);
        known[key] = split;
      }
      out.triangles[t][c] = split;
    }
}

/// From `across` = |a x b| and `along` = a . b the angle between a and b, [0, pi], to 1e-5: as a weight, that is plenty, and ten times
/// as fast as atan2. (Minimax polynomial of the arc tangent on [0, 1], Abramowitz and Stegun 4.4.49.)
float angle_between(float across, float along) {
  const float x = std::abs(along), low = std::min(across, x), high = std::max(across, x);
  if (!(high > 0)) return 0;
  const float t = low / high, s = t * t;
  const float first = t * (0.9998660f + s * (-0.3302995f + s * (0.1801410f + s * (-0.0851330f + s * 0.0208351f))));
  const float acute = across > x ? 0.5f * std::numbers::pi_v<float> - first : first;
  return along < 0 ? std::numbers::pi_v<float> - acute : acute;
}

/// Sums of the gradients' directions, weighted by the angle at the corner, as MikkTSpace has them.
void find_tangents(const Mesh& mesh, const MeshAttributes& attributes, SplitMesh& out) {
  std::vector<glm::vec3> sums(out.vertex.size(), glm::vec3(0.0f));
  std::vector<float> sides(out.vertex.size(), 0.0f);
  for (const auto& t : out.triangles) {
    const Vec3& origin = mesh.positions[out.vertex[t[0]]];
    const glm::vec3 p(mesh.positions[out.vertex[t[1]]] - origin), q(mesh.positions[out.vertex[t[2]]] - origin);
    const glm::vec2 a = attributes.uvs[out.uv[t[0]]], b = attributes.uvs[out.uv[t[1]]] - a, c = attributes.uvs[out.uv[t[2]]] - a;
    const float area = b.x * c.y - b.y * c.x;
    glm::vec3 along = c.y * p - b.y * q;            // the derivative by u, times the area
    if (area < 0) along = -along;
    const float length = glm::length(along);
    if (!(length > 0) || area == 0) continue;
    along /= length;
    const glm::vec3 edges[3] = {p, q - p, -q};
    for (int k = 0; k < 3; ++k) {
      const glm::vec3 &from = edges[k], to = -edges[(k + 2) % 3];
      const float angle = angle_between(glm::length(glm::cross(from, to)), glm::dot(from, to));
      sums[t[k]] += angle * along;
      sides[t[k]] += area > 0 ? angle : -angle;
    }
  }
  out.tangents.resize(out.vertex.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const glm::vec3& n = out.normals[i];
    glm::vec3 t = sums[i] - glm::dot(sums[i], n) * n;
    float length = glm::length(t);
    if (!(length > 1e-6f)) {                        // no texture runs here: any direction across the normal
      t = glm::cross(n, std::abs(n.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0));
      length = glm::length(t);
    }
    out.tangents[i] = glm::vec4(t / length, sides[i] < 0 ? -1.0f : 1.0f);
  }
}

}  // namespace

SplitMesh split_vertices(const Mesh& mesh, const MeshAttributes* attributes) {
  SplitMesh out;
  number_corners(mesh, attributes, corner_normals(mesh), out);
  if (!out.uv.empty() && !out.normals.empty()) find_tangents(mesh, *attributes, out);
  return out;
}

}  // namespace cambium
