#include "polygonize/mesh_read.h"

#include "blobtree/input_error.h"
#include "tests/polygonize/simple_meshes.h"
#include "tests/polygonize/written_file.h"

#include <gtest/gtest.h>

#include <random>

namespace cambium {
namespace {

const std::string kHeader =
    "ply\nformat ascii 1.0\ncomment a corner of a box\nelement vertex 4\nproperty float x\nproperty float y\nproperty double z\n"
    "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
const std::string kVertices = "0 0 0\n1 0 0\n1 1 0.5\n0 1 0\n";

template <class T>
void append(std::string& bytes, T value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); }

/// The same mesh as kHeader's, in binary, with properties that are read over.
std::string binary_ply() {
  std::string bytes =
      "ply\r\nformat binary_little_endian 1.0\r\nobj_info x\r\nelement vertex 4\r\nproperty uchar red\r\nproperty float64 x\r\n"
      "property float32 y\r\nproperty int16 z\r\nproperty list uchar float weights\r\nelement edge 1\r\nproperty int v\r\n"
      "element face 1\r\nproperty uint mark\r\n"
      "property list uint8 uint32 vertex_index\r\nend_header\r\n";
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 2), Vec3(0, 1, 0)}) {
    append<std::uint8_t>(bytes, 255), append<double>(bytes, p.x), append<float>(bytes, static_cast<float>(p.y));
    append<std::int16_t>(bytes, static_cast<std::int16_t>(p.z));
    append<std::uint8_t>(bytes, 1), append<float>(bytes, 0.5f);
  }
  append<std::int32_t>(bytes, -1);
  append<std::uint32_t>(bytes, 7), append<std::uint8_t>(bytes, 4);
  for (std::uint32_t v = 0; v < 4; ++v) append(bytes, v);
  return bytes;
}

void expect_refused(const std::string& bytes, int line, int column, const std::string& in_message) {
  SCOPED_TRACE(bytes);
  try {
    parse_mesh(bytes, "m.ply");
    FAIL() << "was read";
  } catch (const InputError& error) {
    EXPECT_EQ(error.location().file, "m.ply");
    EXPECT_EQ(error.location().line, line) << error.what();
    EXPECT_EQ(error.location().column, column) << error.what();
    EXPECT_NE(std::string(error.what()).find(in_message), std::string::npos) << error.what();
  }
}

TEST(MeshRead, ReadsPlyAsTextAndAsBinaryWithPolygonsAsFans) {
  const Mesh text = parse_mesh(kHeader + kVertices + "3 0 1 2\n4 0 1 2 3\n", "m.ply");
  EXPECT_EQ(text.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}}));
  EXPECT_EQ(text.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}}));
  const Mesh binary = parse_mesh(binary_ply(), "m.ply");
  EXPECT_EQ(binary.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 2}, {0, 1, 0}}));
  EXPECT_EQ(binary.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(MeshRead, ReadsWhatWeWrite) {
  const Mesh ball = testing::ball_mesh(2, 1.5, {1, 2, 3});
  for (const char* format : {".ply", ".obj"}) {
    const Mesh read = parse_mesh(testing::written(ball, format), "m");
    ASSERT_EQ(read.triangles.size(), ball.triangles.size()) << format;
    for (std::size_t t = 0; t < ball.triangles.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_LT(glm::length(read.positions[read.triangles[t][i]] - ball.positions[ball.triangles[t][i]]), 1e-5) << format;
  }
}

TEST(MeshRead, ReadsObjWithPolygonsAndIndicesOfEveryKind) {
  const Mesh mesh = parse_mesh("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1 -1/1\n", "m.obj");
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_THROW(parse_mesh("v 0 0 0\nf 1 2 3\n", "m.obj"), InputError);
  EXPECT_THROW(parse_mesh("", "m.obj"), InputError);
}

TEST(MeshRead, RefusesMalformedTextNamingLineAndColumn) {
  const std::string vertex = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string format = "ply\nformat ascii 1.0\n";
  expect_refused("ply", 1, 4, "format, comment");
  expect_refused("ply\r\n\n", 2, 1, "format, comment");
  expect_refused("ply\nformat binary_big_endian 1.0\n", 2, 8, "'binary_big_endian'");
  expect_refused("ply\nformat ascii 2.0\n", 2, 14, "version 1.0");
  expect_refused("ply\nformat ascii 1.0 more\n", 2, 18, "the line's end");
  expect_refused(format + "elements\n", 3, 1, "'elements'");
  expect_refused(format + "property float x\n", 3, 1, "'property'");
  expect_refused(format + "element vertex -1\n", 3, 16, "a count");
  expect_refused(format + "element vertex 9999999999999999999999\n", 3, 16, "a count");
  expect_refused(format + "element vertex 4294967296\n", 3, 16, "a count");
  expect_refused(format + "element vertex\n", 3, 15, "a count");
  expect_refused(format + "element\n", 3, 8, "an element's name");
  expect_refused(format + "element vertex 1\nproperty number x\n", 4, 10, "'number'");
  expect_refused(format + "element vertex 1\nproperty float\n", 4, 15, "a property's name");
  expect_refused(format + "element vertex 1\nproperty list uchar\n", 4, 20, "a type");
  expect_refused("ply\n" + vertex + face + "end_header\n0 0 0\n3 0 0 0\n", 8, 1, "without a format");
  expect_refused(format + "end_header\n", 0, 0, "no element vertex");
  expect_refused(format + vertex + "end_header\n", 0, 0, "no element face");
  expect_refused(format + face + "end_header\n", 0, 0, "no element vertex");
  expect_refused(format + vertex + vertex + face + "end_header\n", 0, 0, "more than one");
  expect_refused(format + "element vertex 1\nproperty float x\nproperty float y\n" + face + "end_header\n", 0, 0, "property z");
  expect_refused(format + vertex + "element face 1\nproperty int vertex_indices\nend_header\n", 0, 0, "vertex_indices");
  expect_refused(format + "element nothing 4000000000\n" + vertex + face + "end_header\n", 0, 0, "without properties");
  expect_refused(kHeader, 11, 1, "the end");
  expect_refused(kHeader + "0 0 0\n1 x", 12, 3, "'x'");
  expect_refused(kHeader + "0 0 0\n1 1e400 2", 12, 3, "'1e400'");
  expect_refused(kHeader + "0 0 0\n1 nan 2", 12, 3, "not finite");
  expect_refused(kHeader + "0 0 0\n1 0 inf", 12, 5, "not finite");
  expect_refused(kHeader + kVertices + "2 0 1\n", 15, 1, "three corners");
  expect_refused(kHeader + kVertices + "-3 0 1 2\n", 15, 1, "three corners");
  expect_refused(kHeader + kVertices + "3.5 0 1 2\n", 15, 1, "three corners");
  expect_refused(kHeader + kVertices + "3 0 1 4\n", 15, 7, "the 4 vertices");
  expect_refused(kHeader + kVertices + "3 0 1 -1\n", 15, 7, "the 4 vertices");
  expect_refused(kHeader + kVertices + "3 0 1 0.5\n", 15, 7, "the 4 vertices");
  expect_refused(kHeader + kVertices + "3 0 1 nan\n", 15, 7, "the 4 vertices");
  expect_refused(kHeader + kVertices + "4000000000 0 1 2\n", 16, 1, "the end");
  expect_refused(format + vertex + "element face 0\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n", 0, 0, "no faces");
}

TEST(MeshRead, RefusesTruncatedBinaryNamingTheByte) {
  const std::string good = binary_ply();
  const std::size_t data = good.find("end_header\r\n") + 12;
  for (std::size_t size = data; size < good.size(); ++size) expect_refused(good.substr(0, size), 0, 0, "byte ");
  expect_refused(good.substr(0, data), 0, 0, "byte " + std::to_string(data) + ": the end");
  std::string bad = good;
  bad[bad.size() - 1] = 1;
  expect_refused(bad, 0, 0, "byte " + std::to_string(good.size() - 4) + ": corner");
}

TEST(MeshRead, NoiseIsReadOrRefusedButDoesNoHarm) {
  const std::string sources[] = {kHeader + kVertices + "3 0 1 2\n4 0 1 2 3\n", binary_ply()};
  std::mt19937 random(5);
  int refused = 0, valid = 0;
  for (int i = 0; i < 6000; ++i) {
    std::string bytes = sources[i % 2];
    for (int k = 0; k <= i % 5 % 2; ++k) {
      char& changed = bytes[random() % bytes.size()];
      changed = static_cast<char>(i % 3 ? "0123456789 \n.-ailxyz"[random() % 20] : random() % 256);
    }
    try {
      const Mesh mesh = parse_mesh(bytes, "m.ply");
      for (const auto& triangle : mesh.triangles)
        for (const std::uint32_t corner : triangle) ASSERT_LT(corner, mesh.positions.size());
      ++valid;
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(valid, 300);
}

}  // namespace
}  // namespace cambium
