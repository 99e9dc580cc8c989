#include "creased_meshes.h"
#include "small_tree.h"
#include "written_file.h"

#include <map>
#include <sstream>

namespace cambium {
namespace {

using namespace testing;

/// As much of PLY as is written, by its own header: property offsets in a vertex, and where elements begin.
struct PlyFile {
  std::string bytes;
  std::map<std::string, std::size_t> offset, count;
  std::size_t vertex_size = 0, vertices = 0, faces = 0, edges = 0;
  bool with_uv = false;

  explicit PlyFile(std::string file) : bytes(std::move(file)) {
    const std::map<std::string, std::size_t> sizes{{"float", 4}, {"int", 4}, {"uchar", 1}};
    std::istringstream in(bytes);
    std::string element;
    for (std::string line; std::getline(in, line) && line != "end_header";) {
      std::istringstream words(line);
      std::string kind, type, name;
      words >> kind >> type >> name;
      if (kind == "element") count[element = type] = std::stoul(name);
      if (kind != "property") continue;
      if (element == "vertex") {
        offset[name] = vertex_size;
        vertex_size += sizes.at(type);
      }
      with_uv = with_uv || line == "property list uchar float texcoord";
    }
    vertices = static_cast<std::size_t>(in.tellg());
    faces = vertices + count["vertex"] * vertex_size;
    edges = faces + count["face"] * face_size();
  }
  std::size_t face_size() const { return 13 + (with_uv ? 25 : 0); }
  template <class T>
  T vertex(std::size_t i, const std::string& name) const {
    EXPECT_TRUE(offset.contains(name)) << name;
    return read_at<T>(bytes, vertices + i * vertex_size + offset.at(name));
  }
};

TEST(MeshIoPly, EveryAttributeIsAProperty) {
  const Field field = small_tree();
  Mesh mesh = small_tree_mesh(field);
  mesh.creases.clear();   // every vertex has one normal
  MeshAttributes a = small_tree_attributes(field, mesh);
  a.occlusion.assign(mesh.positions.size(), 0.25f);
  a.colors.assign(mesh.positions.size(), {1, 2, 3, 4});
  const PlyFile ply(written(MeshFile{{{&mesh, &a, 0}}, {}}, ".ply"));
  ASSERT_EQ(ply.count.at("vertex"), mesh.positions.size());
  ASSERT_EQ(ply.edges, ply.bytes.size());
  for (std::size_t i = 0; i < mesh.positions.size(); i += 7) {
    const BranchInfo& branch = a.branch_info(a.branch[i]);
    ASSERT_EQ(ply.vertex<float>(i, "y"), static_cast<float>(mesh.positions[i].y));
    EXPECT_EQ(ply.vertex<float>(i, "nz"), mesh.normals[i].z);
    EXPECT_EQ(ply.vertex<std::uint8_t>(i, "blue"), 3);
    EXPECT_EQ(ply.vertex<std::int32_t>(i, "branch"), static_cast<std::int32_t>(a.branch[i]));
    EXPECT_EQ(ply.vertex<std::int32_t>(i, "parent"), branch.parent);
    EXPECT_EQ(ply.vertex<std::int32_t>(i, "order"), static_cast<std::int32_t>(a.order[i]));
    EXPECT_EQ(ply.vertex<float>(i, "radius"), a.radius[i]);
    EXPECT_EQ(ply.vertex<float>(i, "arc_length"), a.arc_length[i]);
    EXPECT_EQ(ply.vertex<float>(i, "pivot_z"), static_cast<float>(branch.pivot.z));
    EXPECT_EQ(ply.vertex<float>(i, "axis_x"), static_cast<float>(branch.axis.x));
    EXPECT_EQ(ply.vertex<float>(i, "ridge"), a.ridge[i]);
    EXPECT_EQ(ply.vertex<float>(i, "occlusion"), 0.25f);
  }
}

TEST(MeshIoPly, FacesHaveTextureCoordinatesByCorner) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  const MeshAttributes a = small_tree_attributes(field, mesh);
  const PlyFile ply(written(MeshFile{{{&mesh, &a, 0}}, {}}, ".ply"));
  ASSERT_TRUE(ply.with_uv);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::size_t at = ply.faces + t * ply.face_size();
    ASSERT_EQ(read_at<std::uint8_t>(ply.bytes, at), 3);
    ASSERT_EQ(read_at<std::uint8_t>(ply.bytes, at + 13), 6);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(read_at<std::uint32_t>(ply.bytes, at + 1 + 4 * c), mesh.triangles[t][c]);
      EXPECT_EQ(read_at<float>(ply.bytes, at + 14 + 8 * c), a.uvs[a.uv_triangles[t][c]].x);
    }
  }
}

TEST(MeshIoPly, CreasesAreEdges) {
  const Mesh cube = creased_cube();
  const PlyFile ply(written(cube, ".ply"));
  ASSERT_EQ(ply.count.at("edge"), 12u);
  ASSERT_EQ(ply.bytes.size(), ply.edges + 12 * 9);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(read_at<std::uint32_t>(ply.bytes, ply.edges + 9 * i), cube.creases[i][0]);
    EXPECT_EQ(read_at<std::uint32_t>(ply.bytes, ply.edges + 9 * i + 4), cube.creases[i][1]);
    EXPECT_EQ(read_at<std::uint8_t>(ply.bytes, ply.edges + 9 * i + 8), 1);
  }
  Mesh smooth = cube;
  smooth.creases.clear();
  EXPECT_FALSE(PlyFile(written(smooth, ".ply")).count.contains("edge"));
}

}  // namespace
}  // namespace cambium
