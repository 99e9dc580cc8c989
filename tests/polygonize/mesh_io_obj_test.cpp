#include "creased_meshes.h"
#include "leaf_parts.h"
#include "small_tree.h"
#include "written_file.h"

#include <sstream>

namespace cambium {
namespace {

using namespace testing;

struct Corner {
  std::size_t position = 0, uv = 0, normal = 0;
};

/// As much of OBJ as is written.
struct ObjFile {
  std::vector<Vec3> positions, normals;
  std::vector<glm::dvec2> uvs;
  std::vector<std::array<Corner, 3>> faces;
  std::vector<std::string> groups;   // of each face

  explicit ObjFile(const std::string& text) {
    std::istringstream in(text);
    std::string group;
    for (std::string line; std::getline(in, line);) {
      std::istringstream words(line);
      std::string kind;
      words >> kind;
      Vec3 v(0);
      if (kind == "v") words >> v.x >> v.y >> v.z, positions.push_back(v);
      if (kind == "vn") words >> v.x >> v.y >> v.z, normals.push_back(v);
      if (kind == "vt") words >> v.x >> v.y, uvs.push_back(glm::dvec2(v));
      if (kind == "s") words >> group;
      if (kind != "f") continue;
      std::array<Corner, 3> face;
      for (Corner& corner : face) {
        std::string word;
        words >> word;
        const std::size_t slash = word.find('/'), second = word.find('/', slash + 1);
        corner.position = std::stoul(word);
        if (second > slash + 1) corner.uv = std::stoul(word.substr(slash + 1));
        corner.normal = std::stoul(word.substr(second + 1));
      }
      faces.push_back(face);
      groups.push_back(group);
    }
  }
};

TEST(MeshIoObj, CornersHaveTheirTextureCoordinates) {
  const Field field = small_tree();
  Mesh mesh = small_tree_mesh(field);
  mesh.creases.clear();   // every vertex has one normal
  const MeshAttributes a = small_tree_attributes(field, mesh);
  const ObjFile obj(written(MeshFile{{{&mesh, &a, 0}}, {}}, ".obj"));
  ASSERT_EQ(obj.positions.size(), mesh.positions.size());
  ASSERT_EQ(obj.uvs.size(), a.uvs.size());
  ASSERT_EQ(obj.faces.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int c = 0; c < 3; ++c) {
      const Corner& corner = obj.faces[t][c];
      EXPECT_EQ(corner.position, mesh.triangles[t][c] + 1);
      EXPECT_EQ(corner.normal, mesh.triangles[t][c] + 1);
      ASSERT_EQ(corner.uv, a.uv_triangles[t][c] + 1);
      EXPECT_NEAR(obj.uvs[corner.uv - 1].x, a.uvs[a.uv_triangles[t][c]].x, 1e-5);
      EXPECT_NEAR(obj.uvs[corner.uv - 1].y, a.uvs[a.uv_triangles[t][c]].y, 1e-5);
    }
  for (const std::string& group : obj.groups) EXPECT_EQ(group, "1");
}

TEST(MeshIoObj, CreasesSplitNormalsAndSmoothingGroups) {
  const Mesh cube = creased_cube();
  const ObjFile obj(written(cube, ".obj"));
  EXPECT_EQ(obj.normals.size(), 24u);
  for (std::size_t t = 0; t < obj.faces.size(); ++t) {
    EXPECT_EQ(obj.groups[t], std::to_string(t / 2 + 1));
    const auto& face = obj.faces[t];
    const Vec3 o = obj.positions[face[0].position - 1];
    const Vec3 n = glm::normalize(glm::cross(obj.positions[face[1].position - 1] - o, obj.positions[face[2].position - 1] - o));
    for (const Corner& corner : face) EXPECT_LT(glm::distance(obj.normals[corner.normal - 1], n), 1e-6);
  }
}

TEST(MeshIoObj, LeavesAreAnObjectBehindTheWood) {
  const Mesh cube = creased_cube();
  const std::vector<MeshLeaves> leaves = leaf_parts("");
  const std::string text = written(MeshFile{{{&cube, nullptr, 0}}, {}, std::span(leaves).subspan(1)}, ".obj");
  const ObjFile obj(text);
  ASSERT_EQ(obj.faces.size(), 12u + 1);
  EXPECT_EQ(obj.positions.size(), cube.positions.size() + 4);
  const auto& leaf = obj.faces.back();
  EXPECT_EQ(obj.positions[leaf[2].position - 1], Vec3(0, 2, 1));
  EXPECT_EQ(obj.uvs[leaf[2].uv - 1], glm::dvec2(0, 1));
  EXPECT_LT(glm::distance(obj.normals[leaf[2].normal - 1], Vec3(0, 0, 1)), 1e-6);
  EXPECT_EQ(obj.groups.back(), "off");
  const std::size_t wood = text.find("o wood\n"), object = text.find("o leaves\n"), material = text.find("usemtl leaf_of_birch\n");
  EXPECT_LT(wood, object);
  EXPECT_LT(object, material);
  EXPECT_NE(material, std::string::npos);
  EXPECT_EQ(written(cube, ".obj").find("o wood"), std::string::npos);
}

TEST(MeshIoObj, YUpTurnsPositionsAndNormals) {
  const Mesh cube = creased_cube();
  const ObjFile obj(written(cube, ".obj", UpAxis::kY));
  EXPECT_EQ(obj.positions[4], Vec3(-0.5, 0.5, 0.5));    // (-0.5, -0.5, 0.5)
  EXPECT_LT(glm::distance(obj.normals[obj.faces[2][0].normal - 1], Vec3(0, 1, 0)), 1e-6);
}

}  // namespace
}  // namespace cambium
