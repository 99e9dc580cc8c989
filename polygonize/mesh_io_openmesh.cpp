#include "polygonize/mesh_formats.h"

#include <OpenMesh/Core/IO/IOManager.hh>
#include <OpenMesh/Core/IO/exporter/BaseExporter.hh>
#include <OpenMesh/Core/Mesh/BaseKernel.hh>
#include <OpenMesh/Core/System/omstream.hh>

// The writers register themselves when these are included.
#include <OpenMesh/Core/IO/writer/OFFWriter.hh>
#include <OpenMesh/Core/IO/writer/STLWriter.hh>

namespace cambium {
namespace {

using OpenMesh::EdgeHandle;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

// Serves a Mesh straight to OpenMesh's writers: no half-edge structure is built for data that only passes through.
class MeshExporter final : public OpenMesh::IO::BaseExporter {
 public:
  MeshExporter(const MeshLevel& level, UpAxis up) : mesh_(*level.mesh), colors_(colors_of(level)), up_(up) {}

  OpenMesh::Vec3f point(VertexHandle v) const override {
    const OpenMesh::Vec3d p = pointd(v);
    return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
  }
  OpenMesh::Vec3d pointd(VertexHandle v) const override {
    const Vec3 p = turned(mesh_.positions[v.idx()], up_);
    return {p.x, p.y, p.z};
  }
  bool is_point_double() const override { return false; }
  OpenMesh::Vec3f normal(VertexHandle v) const override {
    const glm::vec3 n = turned(mesh_.normals[v.idx()], up_);
    return {n.x, n.y, n.z};
  }
  OpenMesh::Vec3d normald(VertexHandle v) const override {
    const OpenMesh::Vec3f n = normal(v);
    return {n[0], n[1], n[2]};
  }
  bool is_normal_double() const override { return false; }
  OpenMesh::Vec3uc color(VertexHandle v) const override {
    const auto& c = colors_[v.idx()];
    return {c[0], c[1], c[2]};
  }
  OpenMesh::Vec4uc colorA(VertexHandle v) const override {
    const auto& c = colors_[v.idx()];
    return {c[0], c[1], c[2], c[3]};
  }
  OpenMesh::Vec3ui colori(VertexHandle v) const override {
    const auto& c = colors_[v.idx()];
    return {c[0], c[1], c[2]};
  }
  OpenMesh::Vec4ui colorAi(VertexHandle v) const override {
    const auto& c = colors_[v.idx()];
    return {c[0], c[1], c[2], c[3]};
  }
  OpenMesh::Vec3f colorf(VertexHandle v) const override {
    const auto& c = colors_[v.idx()];
    return {c[0] / 255.0f, c[1] / 255.0f, c[2] / 255.0f};
  }
  OpenMesh::Vec4f colorAf(VertexHandle v) const override {
    const auto& c = colors_[v.idx()];
    return {c[0] / 255.0f, c[1] / 255.0f, c[2] / 255.0f, c[3] / 255.0f};
  }
  unsigned int get_vhandles(FaceHandle f, std::vector<VertexHandle>& out) const override {
    out.clear();
    for (const std::uint32_t v : mesh_.triangles[f.idx()]) out.emplace_back(static_cast<int>(v));
    return 3;
  }
  OpenMesh::Vec3f normal(FaceHandle f) const override {
    const OpenMesh::Vec3d n = normald(f);
    return {static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])};
  }
  OpenMesh::Vec3d normald(FaceHandle f) const override {
    const auto& t = mesh_.triangles[f.idx()];
    const Vec3 a = turned(mesh_.positions[t[0]], up_), b = turned(mesh_.positions[t[1]], up_),
               c = turned(mesh_.positions[t[2]], up_);
    const Vec3 n = glm::cross(b - a, c - a);
    const double length = glm::length(n);
    return length > 0 ? OpenMesh::Vec3d(n.x / length, n.y / length, n.z / length) : OpenMesh::Vec3d(0, 0, 0);
  }
  const OpenMesh::BaseKernel* kernel() override { return &no_properties_; }
  size_t n_vertices() const override { return mesh_.positions.size(); }
  size_t n_faces() const override { return mesh_.triangles.size(); }
  size_t n_edges() const override { return mesh_.triangles.size() * 3 / 2; }
  bool is_triangle_mesh() const override { return true; }
  bool has_vertex_normals() const override { return !mesh_.normals.empty(); }
  bool has_vertex_colors() const override { return !colors_.empty(); }
  bool has_face_normals() const override { return true; }

  // What a triangle soup with vertex attributes does not have; the has_... above tell the writers not to ask.
  OpenMesh::Vec2f texcoord(VertexHandle) const override { return {0, 0}; }
  OpenMesh::Vec2f texcoord(HalfedgeHandle) const override { return {0, 0}; }
  OpenMesh::Attributes::StatusInfo status(VertexHandle) const override { return {}; }
  HalfedgeHandle getHeh(FaceHandle, VertexHandle) const override { return HalfedgeHandle(); }
  unsigned int get_face_texcoords(std::vector<OpenMesh::Vec2f>& out) const override { return out.clear(), 0; }
  OpenMesh::Vec3uc color(FaceHandle) const override { return {0, 0, 0}; }
  OpenMesh::Vec4uc colorA(FaceHandle) const override { return {0, 0, 0, 0}; }
  OpenMesh::Vec3ui colori(FaceHandle) const override { return {0, 0, 0}; }
  OpenMesh::Vec4ui colorAi(FaceHandle) const override { return {0, 0, 0, 0}; }
  OpenMesh::Vec3f colorf(FaceHandle) const override { return {0, 0, 0}; }
  OpenMesh::Vec4f colorAf(FaceHandle) const override { return {0, 0, 0, 0}; }
  OpenMesh::Attributes::StatusInfo status(FaceHandle) const override { return {}; }
  OpenMesh::Vec3uc color(EdgeHandle) const override { return {0, 0, 0}; }
  OpenMesh::Vec4uc colorA(EdgeHandle) const override { return {0, 0, 0, 0}; }
  OpenMesh::Vec3ui colori(EdgeHandle) const override { return {0, 0, 0}; }
  OpenMesh::Vec4ui colorAi(EdgeHandle) const override { return {0, 0, 0, 0}; }
  OpenMesh::Vec3f colorf(EdgeHandle) const override { return {0, 0, 0}; }
  OpenMesh::Vec4f colorAf(EdgeHandle) const override { return {0, 0, 0, 0}; }
  OpenMesh::Attributes::StatusInfo status(EdgeHandle) const override { return {}; }
  int get_halfedge_id(VertexHandle) override { return -1; }
  int get_halfedge_id(FaceHandle) override { return -1; }
  int get_next_halfedge_id(HalfedgeHandle) override { return -1; }
  int get_to_vertex_id(HalfedgeHandle) override { return -1; }
  int get_face_id(HalfedgeHandle) override { return -1; }
  OpenMesh::Attributes::StatusInfo status(HalfedgeHandle) const override { return {}; }

 private:
  const Mesh& mesh_;
  const std::vector<std::array<std::uint8_t, 4>>& colors_;
  UpAxis up_;
  OpenMesh::BaseKernel no_properties_;
};

// OpenMesh's writers talk to the terminal; libraries do not.
class Silence {
 public:
  Silence() {
    for (std::size_t i = 0; i < streams_.size(); ++i) {
      was_enabled_[i] = streams_[i]->is_enabled();
      streams_[i]->disable();
    }
  }
  ~Silence() {
    for (std::size_t i = 0; i < streams_.size(); ++i)
      if (was_enabled_[i]) streams_[i]->enable();
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  std::array<OpenMesh::mostream*, 3> streams_{&omlog(), &omout(), &omerr()};
  std::array<bool, 3> was_enabled_{};
};

}  // namespace

bool write_with_openmesh(const MeshLevel& level, std::ostream& out, const std::string& extension, UpAxis up) {
  using OpenMesh::IO::Options;
  Options options;
  if (extension == "stl") {
    options += Options::Binary;
  } else {
    if (!level.mesh->normals.empty()) options += Options::VertexNormal;
    if (!colors_of(level).empty()) options += Options::VertexColor;
  }
  MeshExporter exporter(level, up);
  const Silence silence;
  constexpr std::streamsize kDigits = 9;   // tells neighbouring floats apart: twigs 30 m from the origin keep their shape
  return OpenMesh::IO::IOManager().write(out, extension, exporter, options, kDigits);
}

}  // namespace cambium
