#include "blobtree/input_error.h"
#include "creased_meshes.h"
#include "leaf_parts.h"
#include "polygonize/vertex_split.h"
#include "small_tree.h"
#include "written_file.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>

namespace cambium {
namespace {

using namespace testing;

/// Read by a library that had no part in the writing.
struct GlbFile {
  tinygltf::Model model;
  explicit GlbFile(const std::string& bytes) {
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) { return true; },
                          nullptr);
    std::string errors, warnings;
    EXPECT_TRUE(loader.LoadBinaryFromMemory(&model, &errors, &warnings, reinterpret_cast<const unsigned char*>(bytes.data()),
                                            static_cast<unsigned>(bytes.size()))) << errors;
    EXPECT_EQ(errors + warnings, "");
  }
  const tinygltf::Primitive& primitive(std::size_t mesh = 0, std::size_t i = 0) const { return model.meshes.at(mesh).primitives.at(i); }
  template <class T>
  std::vector<T> read(int accessor) const {
    const auto& a = model.accessors.at(static_cast<std::size_t>(accessor));
    const auto& view = model.bufferViews.at(static_cast<std::size_t>(a.bufferView));
    EXPECT_EQ(view.byteOffset % 4, 0u);
    EXPECT_EQ(view.byteLength, a.count * sizeof(T));
    std::vector<T> values(a.count);
    std::memcpy(values.data(), model.buffers[0].data.data() + view.byteOffset + a.byteOffset, view.byteLength);
    return values;
  }
  template <class T>
  std::vector<T> attribute(const std::string& name, std::size_t mesh = 0, std::size_t i = 0) const {
    EXPECT_TRUE(primitive(mesh, i).attributes.contains(name)) << name;
    return read<T>(primitive(mesh, i).attributes.at(name));
  }
};

const std::string kPng = std::string("\x89PNG\r\n\x1a\n", 8) + "rest of a picture";

TEST(MeshIoGltf, VerticesCarryWhatTheMeshKnows) {
  const Field field = small_tree();
  Mesh mesh = small_tree_mesh(field);
  mesh.creases.clear();   // every vertex has one normal
  MeshAttributes a = small_tree_attributes(field, mesh);
  a.occlusion.assign(mesh.positions.size(), 0.75f);
  a.colors.assign(mesh.positions.size(), {255, 128, 0, 255});
  const GlbFile glb(written(MeshFile{{{&mesh, &a, 0}}, {}}, ".glb"));
  const auto position = glb.attribute<glm::vec3>("POSITION"), normal = glb.attribute<glm::vec3>("NORMAL"),
             pivot = glb.attribute<glm::vec3>("_PIVOT"), axis = glb.attribute<glm::vec3>("_AXIS");
  const auto tangent = glb.attribute<glm::vec4>("TANGENT");
  const auto uv = glb.attribute<glm::vec2>("TEXCOORD_0"), unrolled = glb.attribute<glm::vec2>("TEXCOORD_1");
  const auto branch = glb.attribute<float>("_BRANCH"), parent = glb.attribute<float>("_PARENT"), order = glb.attribute<float>("_ORDER"),
             radius = glb.attribute<float>("_RADIUS"), arc = glb.attribute<float>("_ARC_LENGTH"), ridge = glb.attribute<float>("_RIDGE"),
             occlusion = glb.attribute<float>("_AO");
  const auto color = glb.attribute<std::array<std::uint8_t, 4>>("COLOR_0");
  const auto indices = glb.read<std::uint32_t>(glb.primitive().indices);
  ASSERT_EQ(indices.size(), 3 * mesh.triangles.size());
  ASSERT_EQ(position.size(), a.uvs.size());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const std::uint32_t at = indices[i], v = mesh.triangles[i / 3][i % 3], t = a.uv_triangles[i / 3][i % 3];
    const Vec3& p = mesh.positions[v];
    ASSERT_EQ(position[at], glm::vec3(Vec3(p.x, p.z, -p.y)));
    ASSERT_EQ(normal[at], glm::vec3(mesh.normals[v].x, mesh.normals[v].z, -mesh.normals[v].y));
    ASSERT_NEAR(glm::dot(normal[at], glm::vec3(tangent[at])), 0, 1e-5);
    ASSERT_EQ(uv[at], glm::vec2(a.uvs[t].x, 1 - a.uvs[t].y));
    ASSERT_EQ(unrolled[at], a.unrolled[t]);
    const BranchInfo& info = a.branch_info(a.branch[v]);
    ASSERT_EQ(branch[at], static_cast<float>(a.branch[v]));
    ASSERT_EQ(parent[at], static_cast<float>(info.parent));
    ASSERT_EQ(order[at], static_cast<float>(a.order[v]));
    ASSERT_EQ(pivot[at], glm::vec3(Vec3(info.pivot.x, info.pivot.z, -info.pivot.y)));
    ASSERT_EQ(axis[at], glm::vec3(Vec3(info.axis.x, info.axis.z, -info.axis.y)));
    ASSERT_EQ(radius[at], a.radius[v]);
    ASSERT_EQ(arc[at], a.arc_length[v]);
    ASSERT_EQ(ridge[at], a.ridge[v]);
    ASSERT_EQ(occlusion[at], 0.75f);
    ASSERT_EQ(color[at], (std::array<std::uint8_t, 4>{255, 55, 0, 255}));
  }
  const auto& bounds = glb.model.accessors.at(static_cast<std::size_t>(glb.primitive().attributes.at("POSITION")));
  glm::vec3 low = position[0], high = position[0];
  for (const glm::vec3& p : position) low = glm::min(low, p), high = glm::max(high, p);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(static_cast<float>(bounds.minValues.at(static_cast<std::size_t>(k))), low[k]);
    EXPECT_EQ(static_cast<float>(bounds.maxValues.at(static_cast<std::size_t>(k))), high[k]);
  }
}

// On the triangles themselves: tangent and bitangent run where u and the image's upward direction run.
TEST(MeshIoGltf, TangentsAgreeWithTheTextureCoordinates) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  const MeshAttributes a = small_tree_attributes(field, mesh);
  const GlbFile glb(written(MeshFile{{{&mesh, &a, 0}}, {}}, ".glb"));
  const auto position = glb.attribute<glm::vec3>("POSITION"), normal = glb.attribute<glm::vec3>("NORMAL");
  const auto tangent = glb.attribute<glm::vec4>("TANGENT");
  const auto uv = glb.attribute<glm::vec2>("TEXCOORD_0");
  const auto indices = glb.read<std::uint32_t>(glb.primitive().indices);
  std::size_t agree = 0, count = 0;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const std::uint32_t o = indices[i], p = indices[i + 1], q = indices[i + 2];
    const glm::vec3 e = position[p] - position[o], f = position[q] - position[o];
    const glm::vec2 b = uv[p] - uv[o], c = uv[q] - uv[o];
    const float area = b.x * c.y - b.y * c.x;
    const glm::vec3 along_u = glm::normalize((c.y * e - b.y * f) / area), up = -glm::normalize((b.x * f - c.x * e) / area);
    const glm::vec3 t(tangent[o]), bitangent = glm::cross(normal[o], t) * tangent[o].w;
    ++count;
    agree += glm::dot(t, along_u) > 0.8f && glm::dot(bitangent, up) > 0.8f;
  }
  EXPECT_GT(static_cast<double>(agree), 0.97 * static_cast<double>(count));
}

TEST(MeshIoGltf, MapsOfNormalsAndRoughnessGoAlong) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  const MeshAttributes a = small_tree_attributes(field, mesh);
  const auto color = std::make_shared<const std::string>(kPng), normals = std::make_shared<const std::string>(kPng);
  MeshFile file{{{&mesh, &a, 0}}, {}};
  file.materials = {{"trunk", {1, 1, 1}, 1, color, normals, normals}, {"limbs", {1, 1, 1}, 1, color}};
  const GlbFile glb(written(file, ".glb"));
  ASSERT_EQ(glb.model.images.size(), 2u);
  const auto& trunk = glb.model.materials.at(0);
  EXPECT_EQ(trunk.pbrMetallicRoughness.baseColorTexture.index, 0);
  EXPECT_EQ(trunk.pbrMetallicRoughness.metallicRoughnessTexture.index, 1);
  EXPECT_EQ(trunk.normalTexture.index, 1);
  EXPECT_EQ(glb.model.materials.at(1).normalTexture.index, -1);
}

TEST(MeshIoGltf, EveryBarkIsAPrimitiveAndSharedTexturesAreStoredOnce) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  const MeshAttributes a = small_tree_attributes(field, mesh);
  const auto texture = std::make_shared<const std::string>(kPng);
  MeshFile file{{{&mesh, &a, 0}}, {}};
  file.materials = {{"trunk", {1, 1, 1}, 0.8f, texture}, {"limbs", {1, 1, 1}, 0.9f, texture}, {"twigs", {0.5f, 0.25f, 1}, 0.9f, nullptr}};
  const GlbFile glb(written(file, ".glb"));
  ASSERT_EQ(glb.model.meshes.at(0).primitives.size(), 2u);   // there are no twigs
  std::size_t triangles = 0;
  for (std::size_t m = 0; m < 2; ++m) {
    EXPECT_EQ(glb.primitive(0, m).material, static_cast<int>(m));
    const auto indices = glb.read<std::uint32_t>(glb.primitive(0, m).indices);
    const auto order = glb.attribute<float>("_ORDER", 0, m);
    triangles += indices.size() / 3;
    const auto alike = std::count_if(indices.begin(), indices.end(), [&](std::uint32_t i) { return order[i] == static_cast<float>(m); });
    EXPECT_GT(static_cast<double>(alike), 0.9 * static_cast<double>(indices.size()));
  }
  EXPECT_EQ(triangles, mesh.triangles.size());
  EXPECT_EQ(glb.primitive(0, 0).attributes, glb.primitive(0, 1).attributes);
  ASSERT_EQ(glb.model.images.size(), 1u);
  EXPECT_EQ(glb.model.images[0].mimeType, "image/png");
  const auto& view = glb.model.bufferViews.at(static_cast<std::size_t>(glb.model.images[0].bufferView));
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(glb.model.buffers[0].data.data()) + view.byteOffset, view.byteLength), kPng);
  ASSERT_EQ(glb.model.materials.size(), 3u);
  EXPECT_EQ(glb.model.materials[1].pbrMetallicRoughness.baseColorTexture.index, 0);
  EXPECT_EQ(glb.model.materials[2].pbrMetallicRoughness.baseColorFactor, (std::vector<double>{0.5, 0.25, 1, 1}));
}

TEST(MeshIoGltf, LevelsAreNodesOfMsftLod) {
  const Field field = small_tree();
  const Mesh fine = small_tree_mesh(field, 0.015), coarse = small_tree_mesh(field, 0.03);
  const MeshAttributes a = small_tree_attributes(field, fine), b = small_tree_attributes(field, coarse);
  const GlbFile glb(written(MeshFile{{{&fine, &a, 0.5}, {&coarse, &b, 0.1}}, {}}, ".glb"));
  ASSERT_EQ(glb.model.nodes.size(), 2u);
  ASSERT_EQ(glb.model.scenes.at(0).nodes, std::vector<int>{0});
  EXPECT_EQ(glb.model.extensionsUsed, std::vector<std::string>{"MSFT_lod"});
  EXPECT_EQ(glb.model.nodes[0].extensions.at("MSFT_lod").Get("ids").Get(0).GetNumberAsInt(), 1);
  EXPECT_EQ(glb.model.nodes[0].extras.Get("MSFT_screencoverage").ArrayLen(), 2u);
  EXPECT_EQ(glb.model.nodes[0].extras.Get("MSFT_screencoverage").Get(1).GetNumberAsDouble(), 0.1);
  EXPECT_EQ(glb.read<std::uint32_t>(glb.primitive(0).indices).size(), 3 * fine.triangles.size());
  EXPECT_EQ(glb.read<std::uint32_t>(glb.primitive(1).indices).size(), 3 * coarse.triangles.size());
  EXPECT_EQ(glb.attribute<glm::vec3>("POSITION", 1).size(), split_vertices(coarse, &b).vertex.size());
}

TEST(MeshIoGltf, CreasesSplitNormals) {
  const Mesh cube = creased_cube();
  const GlbFile glb(written(cube, ".glb"));
  const auto position = glb.attribute<glm::vec3>("POSITION"), normal = glb.attribute<glm::vec3>("NORMAL");
  EXPECT_EQ(position.size(), 24u);
  const auto indices = glb.read<std::uint32_t>(glb.primitive().indices);
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const glm::vec3 n = glm::normalize(glm::cross(position[indices[i + 1]] - position[indices[i]], position[indices[i + 2]] - position[indices[i]]));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_LT(glm::distance(normal[indices[i + c]], n), 1e-5f);
  }
}

TEST(MeshIoGltf, LeavesAreAMeshOfTheirOwnSeenFromBothSidesAndCutOut) {
  const Mesh cube = creased_cube();
  const std::vector<MeshLeaves> leaves = leaf_parts(kPng);
  const GlbFile glb(written(MeshFile{{{&cube, nullptr, 0}}, {}, leaves}, ".glb"));
  ASSERT_EQ(glb.model.meshes.size(), 2u);
  EXPECT_EQ(glb.model.meshes[1].name, "leaves");
  EXPECT_EQ(glb.model.scenes[0].nodes, (std::vector<int>{0, 1}));
  EXPECT_EQ(glb.model.nodes[1].mesh, 1);
  ASSERT_EQ(glb.model.meshes[1].primitives.size(), 2u);
  ASSERT_EQ(glb.model.materials.size(), 3u);
  const auto &bark = glb.model.materials[0], &cut = glb.model.materials[1], &plain = glb.model.materials[2];
  EXPECT_FALSE(bark.doubleSided);
  EXPECT_TRUE(cut.doubleSided);
  EXPECT_TRUE(plain.doubleSided);
  EXPECT_EQ(cut.alphaMode, "MASK");
  EXPECT_EQ(plain.alphaMode, "OPAQUE");
  EXPECT_EQ(glb.primitive(1, 0).material, 1);
  EXPECT_EQ(glb.primitive(1, 1).material, 2);
  const auto position = glb.attribute<glm::vec3>("POSITION", 1), pivot = glb.attribute<glm::vec3>("_PIVOT", 1);
  EXPECT_EQ(position[3], glm::vec3(0, 4, 0));
  EXPECT_EQ(position[2], glm::vec3(0, 1, -2));
  EXPECT_EQ(pivot[0], glm::vec3(0, 1, 0));
  EXPECT_EQ(glb.attribute<glm::vec2>("TEXCOORD_0", 1)[2], glm::vec2(0, 0)) << "the image's top is the leaf's tip";
  EXPECT_EQ(glb.attribute<float>("_BRANCH", 1), (std::vector<float>{5, 5, 5, 6}));
  EXPECT_EQ(glb.read<std::uint32_t>(glb.primitive(1, 0).indices), (std::vector<std::uint32_t>{0, 1, 2, 0, 1, 3}));
  EXPECT_EQ(glb.read<std::uint32_t>(glb.primitive(1, 1).indices).size(), 3u);
}

TEST(MeshIoGltf, AFileWithoutLeavesIsAsItWas) {
  const Mesh cube = creased_cube();
  EXPECT_EQ(written(MeshFile{{{&cube, nullptr, 0}}, {}, {}}, ".glb"), written(cube, ".glb"));
}

TEST(MeshIoGltf, PicturesOfOtherKindsAndSeveralLevelsInOtherFormatsAreInputErrors) {
  const Mesh cube = creased_cube();
  MeshFile file{{{&cube, nullptr, 0}}, {{"bark", {1, 1, 1}, 0.9f, std::make_shared<const std::string>("II*\0 a tiff")}}};
  EXPECT_THROW(write_mesh(file, "x.glb", ".glb", UpAxis::kZ), InputError);
  file.materials.clear();
  file.levels.push_back(file.levels[0]);
  EXPECT_THROW(write_mesh(file, "x.obj", ".obj", UpAxis::kZ), InputError);
  file.levels.clear();
  EXPECT_THROW(write_mesh(file, "x.glb", ".glb", UpAxis::kZ), InputError);
  EXPECT_FALSE(std::filesystem::exists("x.glb"));
  EXPECT_FALSE(std::filesystem::exists("x.obj"));
}

}  // namespace
}  // namespace cambium
