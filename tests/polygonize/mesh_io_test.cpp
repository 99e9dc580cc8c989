#include "polygonize/mesh_io.h"

#include "blobtree/input_error.h"
#include "written_file.h"

#include <nlohmann/json.hpp>

#include <sstream>

namespace cambium {
namespace {

using namespace testing;

// A tetrahedron far from the origin whose corners a 6-digit writer would merge.
Mesh tetrahedron() {
  Mesh mesh;
  const Vec3 far(30.0001, -20, 10);
  mesh.positions = {far, far + Vec3(0.001, 0, 0), far + Vec3(0, 0.001, 0), far + Vec3(0, 0, 0.001)};
  mesh.normals = {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.colors = {{{255, 0, 0, 255}}, {{0, 128, 0, 255}}, {{0, 0, 64, 255}}, {{9, 9, 9, 255}}};
  mesh.triangles = {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{0, 3, 2}}};
  return mesh;
}

TEST(MeshIo, ObjHasEveryVertexNormalAndFaceWithEnoughDigits) {
  std::istringstream in(written(tetrahedron(), ".obj"));
  std::vector<Vec3> positions;
  std::size_t normals = 0, faces = 0;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Vec3 p(0);
      words >> p.x >> p.y >> p.z;
      positions.push_back(p);
    }
    normals += kind == "vn";
    faces += kind == "f";
  }
  ASSERT_EQ(positions.size(), 4u);
  EXPECT_EQ(normals, 4u);
  EXPECT_EQ(faces, 4u);
  EXPECT_NEAR(positions[1].x - positions[0].x, 0.001, 1e-5);
  EXPECT_NEAR(positions[3].z - positions[0].z, 0.001, 1e-5);
}

TEST(MeshIo, PlyIsBinaryWithNormalsAndColours) {
  const std::string bytes = written(tetrahedron(), ".ply");
  const std::size_t end = bytes.find("end_header\n");
  ASSERT_NE(end, std::string::npos);
  const std::string header = bytes.substr(0, end);
  EXPECT_NE(header.find("binary_little_endian"), std::string::npos);
  EXPECT_NE(header.find("element vertex 4"), std::string::npos);
  EXPECT_NE(header.find("element face 4"), std::string::npos);
  EXPECT_NE(header.find("nx"), std::string::npos);
  EXPECT_NE(header.find("red"), std::string::npos) << header;
  EXPECT_NEAR(read_at<float>(bytes, end + 11), 30.0001, 1e-5);
}

TEST(MeshIo, StlIsBinaryWithFacetNormals) {
  const std::string bytes = written(tetrahedron(), ".stl");
  ASSERT_EQ(bytes.size(), 84u + 4 * 50);
  EXPECT_EQ(read_at<std::uint32_t>(bytes, 80), 4u);
  EXPECT_NEAR(read_at<float>(bytes, 84 + 8), -1, 1e-5);   // the first facet looks down
}

TEST(MeshIo, OffCountsItsElements) {
  std::istringstream in(written(tetrahedron(), ".off"));
  std::string magic;
  std::size_t vertices = 0, faces = 0;
  in >> magic >> vertices >> faces;
  EXPECT_NE(magic.find("OFF"), std::string::npos);
  EXPECT_EQ(vertices, 4u);
  EXPECT_EQ(faces, 4u);
}

TEST(MeshIo, UpYTurnsTheMeshAQuarterAboutX) {
  std::istringstream in(written(tetrahedron(), ".obj", UpAxis::kY));
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("v ", 0) != 0) continue;
    Vec3 p(0);
    std::istringstream(line.substr(2)) >> p.x >> p.y >> p.z;
    EXPECT_NEAR(p.x, 30.0001, 1e-5);
    EXPECT_NEAR(p.y, 10, 1e-5);
    EXPECT_NEAR(p.z, 20, 1e-5);
    return;
  }
  FAIL() << "no vertex";
}

TEST(MeshIo, GlbHoldsYUpFloatsLinearColoursAndIndices) {
  const std::string bytes = written(tetrahedron(), ".glb");
  ASSERT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(read_at<std::uint32_t>(bytes, 4), 2u);
  EXPECT_EQ(read_at<std::uint32_t>(bytes, 8), bytes.size());
  const auto json_size = read_at<std::uint32_t>(bytes, 12);
  const auto json = nlohmann::json::parse(bytes.substr(20, json_size));
  EXPECT_EQ(json["asset"]["generator"], "Cambium");
  const std::size_t binary = 20 + json_size + 8;
  const auto& primitive = json["meshes"][0]["primitives"][0];
  const auto offset = [&](int accessor) {
    const auto& view = json["bufferViews"][json["accessors"][accessor]["bufferView"].get<int>()];
    return binary + (view.contains("byteOffset") ? view["byteOffset"].get<std::size_t>() : 0);
  };
  const int position = primitive["attributes"]["POSITION"], normal = primitive["attributes"]["NORMAL"],
            color = primitive["attributes"]["COLOR_0"], indices = primitive["indices"];
  EXPECT_NEAR(read_at<float>(bytes, offset(position)), 30.0001, 1e-5);
  EXPECT_NEAR(read_at<float>(bytes, offset(position) + 4), 10, 1e-5);
  EXPECT_NEAR(read_at<float>(bytes, offset(position) + 8), 20, 1e-5);
  EXPECT_NEAR(json["accessors"][position]["max"][1].get<double>(), 10.001, 1e-5);
  EXPECT_NEAR(json["accessors"][position]["min"][2].get<double>(), 19.999, 1e-5);
  // Vertices stand in the order of their first use: 0, 2, 1, 3.
  EXPECT_EQ(read_at<float>(bytes, offset(normal) + 3 * 12 + 4), 1);   // z became y
  EXPECT_EQ(read_at<std::uint8_t>(bytes, offset(color)), 255);
  EXPECT_EQ(read_at<std::uint8_t>(bytes, offset(color) + 9), 55);     // sRGB 128 in linear light
  EXPECT_TRUE(json["accessors"][color]["normalized"].get<bool>());
  EXPECT_EQ(read_at<std::uint32_t>(bytes, offset(indices) + 4), 1u);
  EXPECT_EQ(json["accessors"][indices]["count"], 12);
  EXPECT_EQ(json["bufferViews"][json["accessors"][indices]["bufferView"].get<int>()]["target"], 34963);
  EXPECT_EQ(json["bufferViews"][json["accessors"][position]["bufferView"].get<int>()]["target"], 34962);
}

TEST(MeshIo, AnEmptyMeshIsStillAFileOfEveryFormat) {
  for (const char* format : {".obj", ".ply", ".stl", ".off", ".glb"}) EXPECT_GT(written(Mesh{}, format).size(), 0u) << format;
}

TEST(MeshIo, UnknownExtensionsAndUnwritablePathsAreErrors) {
  EXPECT_THROW(write_mesh(tetrahedron(), "x.fbx", ".fbx", UpAxis::kZ), InputError);
  EXPECT_THROW(write_mesh(tetrahedron(), "x", "", UpAxis::kZ), InputError);
  EXPECT_FALSE(std::filesystem::exists("x.fbx"));
  for (const char* format : {".obj", ".ply", ".stl", ".off", ".glb"}) {
    try {
      write_mesh(tetrahedron(), "/nonexistent/dir/tree", format, UpAxis::kZ);
      FAIL() << format;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("/nonexistent/dir/tree"), std::string::npos) << error.what();
    }
    if (std::filesystem::exists("/dev/full")) {
      EXPECT_THROW(write_mesh(tetrahedron(), "/dev/full", format, UpAxis::kZ), std::runtime_error) << format;
    }
  }
}

}  // namespace
}  // namespace cambium
