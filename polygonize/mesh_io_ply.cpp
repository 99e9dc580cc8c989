#include "polygonize/mesh_formats.h"

#include <fmt/format.h>

#include <bit>
#include <functional>
#include <string_view>

namespace cambium {
namespace {

static_assert(std::endian::native == std::endian::little, "the header says so");

struct Property {
  std::string_view declaration;
  std::function<void(ByteSink&, std::size_t)> put;
};

void put_vector(ByteSink& sink, const glm::vec3& v) { sink.raw(&v, 3 * sizeof(float)); }

std::vector<Property> vertex_properties(const MeshLevel& level, UpAxis up) {
  const Mesh& mesh = *level.mesh;
  std::vector<Property> properties;
  properties.push_back({"property float x\nproperty float y\nproperty float z\n",
                        [&mesh, up](ByteSink& s, std::size_t i) { put_vector(s, glm::vec3(turned(mesh.positions[i], up))); }});
  if (!mesh.normals.empty())
    properties.push_back({"property float nx\nproperty float ny\nproperty float nz\n",
                          [&mesh, up](ByteSink& s, std::size_t i) { put_vector(s, turned(mesh.normals[i], up)); }});
  if (const auto& colors = colors_of(level); !colors.empty())
    properties.push_back({"property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n",
                          [&colors](ByteSink& s, std::size_t i) { s.put(colors[i]); }});
  if (!level.attributes) return properties;
  const MeshAttributes& a = *level.attributes;
  if (!a.branch.empty()) {
    properties.push_back({"property int branch\nproperty int parent\nproperty int order\n", [&a](ByteSink& s, std::size_t i) {
                            s.put(static_cast<std::int32_t>(a.branch[i]));
                            s.put(a.branch_info(a.branch[i]).parent);
                            s.put(static_cast<std::int32_t>(a.order[i]));
                          }});
    properties.push_back({"property float pivot_x\nproperty float pivot_y\nproperty float pivot_z\n"
                          "property float axis_x\nproperty float axis_y\nproperty float axis_z\n",
                          [&a, up](ByteSink& s, std::size_t i) {
                            const BranchInfo& branch = a.branch_info(a.branch[i]);
                            put_vector(s, glm::vec3(turned(branch.pivot, up)));
                            put_vector(s, glm::vec3(turned(branch.axis, up)));
                          }});
  }
  const auto add_floats = [&](std::string_view declaration, const std::vector<float>& values) {
    if (!values.empty()) properties.push_back({declaration, [&values](ByteSink& s, std::size_t i) { s.put(values[i]); }});
  };
  add_floats("property float radius\n", a.radius);
  add_floats("property float arc_length\n", a.arc_length);
  add_floats("property float ridge\n", a.ridge);
  add_floats("property float occlusion\n", a.occlusion);
  return properties;
}

}  // namespace

bool write_ply(const MeshLevel& level, std::ostream& out, UpAxis up) {
  const Mesh& mesh = *level.mesh;
  const bool with_uv = level.attributes && !level.attributes->uvs.empty();
  const std::vector<Property> properties = vertex_properties(level, up);
  ByteSink sink(out);
  sink.text(fmt::format("ply\nformat binary_little_endian 1.0\ncomment Cambium\nelement vertex {}\n", mesh.positions.size()));
  for (const Property& property : properties) sink.text(property.declaration);
  sink.text(fmt::format("element face {}\nproperty list uchar int vertex_indices\n", mesh.triangles.size()));
  if (with_uv) sink.text("property list uchar float texcoord\n");
  if (!mesh.creases.empty())
    sink.text(fmt::format("element edge {}\nproperty int vertex1\nproperty int vertex2\nproperty uchar crease\n", mesh.creases.size()));
  sink.text("end_header\n");
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    for (const Property& property : properties) property.put(sink, i);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    sink.put(std::uint8_t{3});
    sink.put(mesh.triangles[t]);
    if (!with_uv) continue;
    sink.put(std::uint8_t{6});
    for (const std::uint32_t uv : level.attributes->uv_triangles[t]) sink.put(level.attributes->uvs[uv]);
  }
  for (const auto& edge : mesh.creases) {
    sink.put(edge);
    sink.put(std::uint8_t{1});
  }
  return true;
}

}  // namespace cambium
