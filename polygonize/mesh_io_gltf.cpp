#include "polygonize/mesh_formats.h"

#include <tiny_gltf.h>

#include <cmath>
#include <functional>
#include <cstring>
#include <stdexcept>

namespace cambium {
namespace {

// glTF takes vertex colours as linear light; ours are sRGB (IEC 61966-2-1).
std::array<std::uint8_t, 256> linear_from_srgb() {
  std::array<std::uint8_t, 256> table{};
  for (int i = 0; i < 256; ++i) {
    const double s = i / 255.0;
    const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    table[i] = static_cast<std::uint8_t>(std::lround(255 * linear));
  }
  return table;
}

// Appends one array to the only buffer and returns its accessor. Bytes must be a multiple of four.
class BufferPacker {
 public:
  explicit BufferPacker(tinygltf::Model& model) : model_(model) { model_.buffers.emplace_back(); }

  unsigned char* add(std::size_t count, std::size_t bytes_each, int component, int type, int target, bool normalized) {
    auto& data = model_.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = count * bytes_each;
    view.target = target;
    data.resize(data.size() + view.byteLength);
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model_.bufferViews.size());
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = count;
    accessor.normalized = normalized;
    model_.bufferViews.push_back(view);
    model_.accessors.push_back(accessor);
    return data.data() + view.byteOffset;
  }
  tinygltf::Accessor& last() { return model_.accessors.back(); }
  int last_index() const { return static_cast<int>(model_.accessors.size()) - 1; }

 private:
  tinygltf::Model& model_;
};

int add_vectors(BufferPacker& packer, std::size_t count, const std::function<glm::vec3(std::size_t)>& vector, bool bounds) {
  unsigned char* out = packer.add(count, sizeof(float) * 3, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3,
                                  TINYGLTF_TARGET_ARRAY_BUFFER, false);
  glm::vec3 low(0.0f), high(0.0f);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 v = vector(i);
    const float xyz[3] = {v.x, v.y, v.z};
    std::memcpy(out + i * sizeof(xyz), xyz, sizeof(xyz));
    low = i ? glm::min(low, v) : v;
    high = i ? glm::max(high, v) : v;
  }
  if (bounds) {
    packer.last().minValues = {low.x, low.y, low.z};
    packer.last().maxValues = {high.x, high.y, high.z};
  }
  return packer.last_index();
}

void add_mesh(const Mesh& mesh, tinygltf::Model& model) {
  BufferPacker packer(model);
  const std::size_t vertices = mesh.positions.size();
  model.buffers[0].data.reserve(vertices * 28 + mesh.triangles.size() * 12);
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.attributes["POSITION"] =
      add_vectors(packer, vertices, [&](std::size_t i) { return glm::vec3(turned(mesh.positions[i], UpAxis::kY)); }, true);
  if (!mesh.normals.empty()) {
    primitive.attributes["NORMAL"] =
        add_vectors(packer, vertices, [&](std::size_t i) { return turned(mesh.normals[i], UpAxis::kY); }, false);
  }
  if (!mesh.colors.empty()) {
    const auto linear = linear_from_srgb();
    unsigned char* out = packer.add(vertices, 4, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_TYPE_VEC4,
                                    TINYGLTF_TARGET_ARRAY_BUFFER, true);
    for (const auto& c : mesh.colors) {
      *out++ = linear[c[0]];
      *out++ = linear[c[1]];
      *out++ = linear[c[2]];
      *out++ = c[3];
    }
    primitive.attributes["COLOR_0"] = packer.last_index();
  }
  unsigned char* out = packer.add(mesh.triangles.size() * 3, sizeof(std::uint32_t), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                  TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER, false);
  std::memcpy(out, mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
  primitive.indices = packer.last_index();

  tinygltf::Material material;
  material.name = "bark";
  material.pbrMetallicRoughness.metallicFactor = 0;
  material.pbrMetallicRoughness.roughnessFactor = 0.9;
  model.materials.push_back(material);
  primitive.material = 0;

  tinygltf::Mesh shape;
  shape.name = "tree";
  shape.primitives.push_back(primitive);
  model.meshes.push_back(shape);
  tinygltf::Node node;
  node.name = "tree";
  node.mesh = 0;
  model.nodes.push_back(node);
}

}  // namespace

bool write_glb(const Mesh& mesh, std::ostream& out) {
  const std::uint64_t bytes = std::uint64_t{28} * mesh.positions.size() + std::uint64_t{12} * mesh.triangles.size();
  if (bytes > 0xfff00000ull) throw std::runtime_error("a .glb file holds at most 4 GiB; use .ply or coarser cells");
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "Cambium";
  tinygltf::Scene scene;
  if (!mesh.triangles.empty()) {   // glTF has no empty buffers: an empty mesh is an empty scene
    add_mesh(mesh, model);
    scene.nodes.push_back(0);
  }
  model.scenes.push_back(scene);
  model.defaultScene = 0;
  return tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, out, false, true);
}

}  // namespace cambium
