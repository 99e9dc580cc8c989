#include "polygonize/mesh_formats.h"
#include "polygonize/vertex_split.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>

namespace cambium {
namespace {

using Json = nlohmann::ordered_json;
static_assert(std::endian::native == std::endian::little, "as glTF's buffers are");

constexpr int kFloat = 5126, kByte = 5121, kUnsignedInt = 5125, kVertices = 34962, kIndices = 34963;

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

glm::vec3 y_up(const glm::vec3& v) { return turned(v, UpAxis::kY); }

// The header, and beside it what will fill the binary chunk when its turn comes: the file is never in memory as a whole.
class Document {
 public:
  Document() {
    json_["asset"] = {{"version", "2.0"}, {"generator", "Cambium"}};
    json_["scene"] = 0;
    json_["scenes"] = Json::array({Json::object()});
  }
  Json& json() { return json_; }

  /// Appends to one of the document's lists and returns the index there.
  std::size_t add(const char* list, Json value) {
    json_[list].push_back(std::move(value));
    return json_[list].size() - 1;
  }

  std::size_t add_view(std::size_t bytes, std::optional<int> target, std::function<void(ByteSink&)> fill) {
    Json view = {{"buffer", 0}, {"byteOffset", size_}, {"byteLength", bytes}};
    if (target) view["target"] = *target;
    size_ += (bytes + 3) / 4 * 4;
    fills_.push_back([fill = std::move(fill), bytes](ByteSink& sink) {
      fill(sink);
      for (std::size_t i = bytes; i % 4 != 0; ++i) sink.put('\0');
    });
    return add("bufferViews", std::move(view));
  }

  /// `value(i)` gives what is stored of the i-th of `count`: a float, a glm vector of floats, four bytes, or an index.
  template <class Value>
  std::size_t add_accessor(std::size_t count, const char* type, int component, int target, Value value) {
    using Stored = decltype(value(std::size_t{0}));
    const std::size_t view = add_view(count * sizeof(Stored), target, [count, value](ByteSink& sink) {
      for (std::size_t i = 0; i < count; ++i) sink.put(value(i));
    });
    return add("accessors", {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
  }

  bool write(std::ostream& out) {
    if (size_ > 0) json_["buffers"] = Json::array({{{"byteLength", size_}}});
    std::string header = json_.dump();
    header.append((4 - header.size() % 4) % 4, ' ');
    const std::uint64_t total = 12 + 8 + header.size() + (size_ > 0 ? 8 + size_ : 0);
    if (total > std::numeric_limits<std::uint32_t>::max())
      throw std::runtime_error("a .glb file holds at most 4 GiB; use .ply or coarser cells");
    ByteSink sink(out);
    const auto word = [&](std::uint64_t value) { sink.put(static_cast<std::uint32_t>(value)); };
    sink.text("glTF");
    word(2);
    word(total);
    word(header.size());
    sink.text("JSON");
    sink.text(header);
    if (size_ > 0) {
      word(size_);
      sink.text(std::string_view("BIN\0", 4));
      for (const auto& fill : fills_) fill(sink);
    }
    return true;
  }

 private:
  Json json_;
  std::uint64_t size_ = 0;
  std::vector<std::function<void(ByteSink&)>> fills_;
};

/// The file's textures; an image that several materials share is stored once.
class TextureTable {
 public:
  explicit TextureTable(Document& document) : document_(document) {}

  Json reference(const std::shared_ptr<const std::string>& bytes) {
    auto at = std::find(known_.begin(), known_.end(), bytes.get());
    if (at == known_.end()) {
      const std::size_t view =
          document_.add_view(bytes->size(), std::nullopt, [bytes](ByteSink& sink) { sink.raw(bytes->data(), bytes->size()); });
      const std::size_t image = document_.add("images", {{"bufferView", view}, {"mimeType", image_type(*bytes)}});
      document_.add("textures", {{"source", image}});
      at = known_.insert(known_.end(), bytes.get());
    }
    return {{"index", at - known_.begin()}};
  }

 private:
  Document& document_;
  std::vector<const std::string*> known_;
};

void add_materials(const std::vector<MeshMaterial>& materials, Document& document) {
  TextureTable textures(document);
  for (const MeshMaterial& material : materials) {
    Json look = {{"metallicFactor", 0}, {"roughnessFactor", material.roughness}};
    if (material.color != std::array<float, 3>{1, 1, 1})
      look["baseColorFactor"] = {material.color[0], material.color[1], material.color[2], 1};
    if (material.texture) look["baseColorTexture"] = textures.reference(material.texture);
    if (material.roughness_map) look["metallicRoughnessTexture"] = textures.reference(material.roughness_map);
    Json entry = {{"name", material.name}, {"pbrMetallicRoughness", std::move(look)}};
    if (material.normal_map) entry["normalTexture"] = textures.reference(material.normal_map);
    if (material.leaf) entry["doubleSided"] = true;
    if (material.leaf && material.texture) entry["alphaMode"] = "MASK";
    document.add("materials", std::move(entry));
  }
}

/// What every vertex of a level carries; its primitives share it. What is handed to the document outlives the writer.
class LevelWriter {
 public:
  LevelWriter(const MeshLevel& level, const SplitMesh& split, Document& document)
      : level_(level), split_(split), document_(document) {}

  Json attributes() {
    const Mesh& mesh = *level_.mesh;
    const SplitMesh& split = split_;
    add("POSITION", "VEC3", [&](std::size_t i) { return y_up(glm::vec3(mesh.positions[split.vertex[i]])); });
    add_bounds();
    if (!split.normals.empty()) add("NORMAL", "VEC3", [&](std::size_t i) { return y_up(split.normals[i]); });
    if (!split.tangents.empty())
      add("TANGENT", "VEC4", [&](std::size_t i) { return glm::vec4(y_up(glm::vec3(split.tangents[i])), split.tangents[i].w); });
    if (!split.uv.empty()) {
      const MeshAttributes& a = *level_.attributes;
      // Its v runs down the image.
      add("TEXCOORD_0", "VEC2", [&](std::size_t i) { return glm::vec2(a.uvs[split.uv[i]].x, 1 - a.uvs[split.uv[i]].y); });
      add("TEXCOORD_1", "VEC2", [&](std::size_t i) { return a.unrolled[split.uv[i]]; });
    }
    add_colors();
    if (level_.attributes) add_branches(*level_.attributes);
    return std::move(attributes_);
  }

 private:
  /// `value` is called when the file is written; of the writer it may have nothing but references to what that refers to.
  template <class Value>
  void add(const char* name, const char* type, const Value& value) {
    attributes_[name] = document_.add_accessor(split_.vertex.size(), type, kFloat, kVertices, value);
  }

  void add_bounds() {
    glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
    for (const std::uint32_t v : split_.vertex) {
      const glm::vec3 p = y_up(glm::vec3(level_.mesh->positions[v]));
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    Json& accessor = document_.json()["accessors"].back();
    accessor["min"] = {low.x, low.y, low.z};
    accessor["max"] = {high.x, high.y, high.z};
  }

  void add_colors() {
    const auto& colors = colors_of(level_);
    if (colors.empty()) return;
    const SplitMesh& split = split_;
    const auto color = [&split, &colors, linear = linear_from_srgb()](std::size_t i) {
      const auto& c = colors[split.vertex[i]];
      return std::array<std::uint8_t, 4>{linear[c[0]], linear[c[1]], linear[c[2]], c[3]};
    };
    attributes_["COLOR_0"] = document_.add_accessor(split.vertex.size(), "VEC4", kByte, kVertices, color);
    document_.json()["accessors"].back()["normalized"] = true;
  }

  void add_branches(const MeshAttributes& a) {
    const SplitMesh& split = split_;
    const auto add_floats = [&](const char* name, const std::vector<float>& values) {
      if (!values.empty()) add(name, "SCALAR", [&split, &values](std::size_t i) { return values[split.vertex[i]]; });
    };
    if (!a.branch.empty()) {
      const auto branch = [&split, &a](std::size_t i) { return a.branch[split.vertex[i]]; };
      add("_BRANCH", "SCALAR", [branch](std::size_t i) { return static_cast<float>(branch(i)); });
      add("_PARENT", "SCALAR", [branch, &a](std::size_t i) { return static_cast<float>(a.branch_info(branch(i)).parent); });
      add("_ORDER", "SCALAR", [&split, &a](std::size_t i) { return static_cast<float>(a.order[split.vertex[i]]); });
      add("_PIVOT", "VEC3", [branch, &a](std::size_t i) { return y_up(glm::vec3(a.branch_info(branch(i)).pivot)); });
      add("_AXIS", "VEC3", [branch, &a](std::size_t i) { return y_up(glm::vec3(a.branch_info(branch(i)).axis)); });
    }
    add_floats("_RADIUS", a.radius);
    add_floats("_ARC_LENGTH", a.arc_length);
    add_floats("_RIDGE", a.ridge);
    add_floats("_AO", a.occlusion);
  }

  const MeshLevel& level_;
  const SplitMesh& split_;
  Document& document_;
  Json attributes_;
};

/// The triangles of each material, in the mesh's order.
std::vector<std::vector<std::uint32_t>> by_material(const MeshLevel& level, std::size_t materials) {
  std::vector<std::vector<std::uint32_t>> triangles(materials);
  const bool known = level.attributes && !level.attributes->triangle_order.empty();
  for (std::uint32_t t = 0; t < level.mesh->triangles.size(); ++t)
    triangles[known ? std::min<std::size_t>(level.attributes->triangle_order[t], materials - 1) : 0].push_back(t);
  return triangles;
}

Json add_mesh(const MeshLevel& level, const SplitMesh& split, std::size_t materials, std::string name, Document& document) {
  const Json attributes = LevelWriter(level, split, document).attributes();
  Json primitives = Json::array();
  const auto triangles = by_material(level, materials);
  for (std::size_t m = 0; m < materials; ++m) {
    if (triangles[m].empty()) continue;
    const std::size_t view = document.add_view(12 * triangles[m].size(), kIndices, [list = triangles[m], &split](ByteSink& sink) {
      for (const std::uint32_t t : list) sink.put(split.triangles[t]);
    });
    const std::size_t indices = document.add(
        "accessors", {{"bufferView", view}, {"componentType", kUnsignedInt}, {"count", 3 * triangles[m].size()}, {"type", "SCALAR"}});
    primitives.push_back({{"attributes", attributes}, {"indices", indices}, {"material", m}});
  }
  return {{"name", std::move(name)}, {"primitives", std::move(primitives)}};
}

/// One part of the leaves: its vertices are in place, and outlive the writer.
Json leaf_primitive(const MeshLeaves& leaves, std::size_t material, Document& document) {
  const Sheet& sheet = leaves.sheet;
  const std::size_t count = sheet.positions.size();
  Json attributes;
  glm::vec3 low(std::numeric_limits<float>::max()), high(-low);
  for (const glm::vec3& p : sheet.positions) low = glm::min(low, y_up(p)), high = glm::max(high, y_up(p));
  attributes["POSITION"] =
      document.add_accessor(count, "VEC3", kFloat, kVertices, [&sheet](std::size_t i) { return y_up(sheet.positions[i]); });
  Json& positions = document.json()["accessors"].back();
  positions["min"] = {low.x, low.y, low.z};
  positions["max"] = {high.x, high.y, high.z};
  attributes["NORMAL"] =
      document.add_accessor(count, "VEC3", kFloat, kVertices, [&sheet](std::size_t i) { return y_up(sheet.normals[i]); });
  attributes["TEXCOORD_0"] = document.add_accessor(
      count, "VEC2", kFloat, kVertices, [&sheet](std::size_t i) { return glm::vec2(sheet.uvs[i].x, 1 - sheet.uvs[i].y); });
  attributes["_BRANCH"] = document.add_accessor(count, "SCALAR", kFloat, kVertices,
                                                [&leaves](std::size_t i) { return static_cast<float>(leaves.branch[i]); });
  attributes["_PIVOT"] =
      document.add_accessor(count, "VEC3", kFloat, kVertices, [&leaves](std::size_t i) { return y_up(leaves.pivot[i]); });
  const std::size_t view = document.add_view(12 * sheet.triangles.size(), kIndices, [&sheet](ByteSink& sink) {
    sink.raw(sheet.triangles.data(), 12 * sheet.triangles.size());
  });
  const std::size_t indices = document.add(
      "accessors", {{"bufferView", view}, {"componentType", kUnsignedInt}, {"count", 3 * sheet.triangles.size()}, {"type", "SCALAR"}});
  return {{"attributes", attributes}, {"indices", indices}, {"material", material}};
}

/// The mesh and its node; the index of that. Their materials are the file's last ones.
std::size_t add_leaves(std::span<const MeshLeaves> leaves, std::size_t first_material, Document& document) {
  Json primitives = Json::array();
  for (std::size_t i = 0; i < leaves.size(); ++i) primitives.push_back(leaf_primitive(leaves[i], first_material + i, document));
  const std::size_t mesh = document.add("meshes", {{"name", "leaves"}, {"primitives", std::move(primitives)}});
  return document.add("nodes", {{"name", "leaves"}, {"mesh", mesh}});
}

}  // namespace

bool write_glb(const MeshFile& file, std::ostream& out) {
  Document document;
  std::vector<const MeshLevel*> levels;   // glTF has no empty buffers: an empty mesh is left out, and a file of such an empty scene
  for (const MeshLevel& level : file.levels)
    if (!level.mesh->triangles.empty()) levels.push_back(&level);
  if (levels.empty()) return document.write(out);

  std::vector<MeshMaterial> materials = file.materials.empty() ? std::vector<MeshMaterial>(1) : file.materials;
  const std::size_t barks = materials.size();
  for (const MeshLeaves& leaves : file.leaves) materials.push_back(leaves.material);
  add_materials(materials, document);
  std::vector<SplitMesh> splits;
  splits.reserve(levels.size());
  Json others = Json::array(), coverage = Json::array();
  for (std::size_t i = 0; i < levels.size(); ++i) {
    splits.push_back(split_vertices(*levels[i]->mesh, levels[i]->attributes));
    const std::string name = levels.size() == 1 ? "tree" : "tree LOD" + std::to_string(i);
    const std::size_t mesh = document.add("meshes", add_mesh(*levels[i], splits[i], barks, name, document));
    const std::size_t node = document.add("nodes", {{"name", name}, {"mesh", mesh}});
    if (i > 0) others.push_back(node);
    coverage.push_back(levels[i]->screen_coverage);
  }
  document.json()["scenes"][0]["nodes"] = {0};
  if (!file.leaves.empty()) document.json()["scenes"][0]["nodes"].push_back(add_leaves(file.leaves, barks, document));
  if (levels.size() > 1) {
    document.json()["extensionsUsed"] = {"MSFT_lod"};
    document.json()["nodes"][0]["extensions"]["MSFT_lod"]["ids"] = others;
    document.json()["nodes"][0]["extras"]["MSFT_screencoverage"] = coverage;
  }
  return document.write(out);
}

}  // namespace cambium
