#include "skeletons/foliage_json.h"

#include "skeletons/number_text.h"

#include <cmath>
#include <cstdio>
#include <limits>

namespace cambium {
namespace {

constexpr double kSquare = 1e-6;   // how far a frame's products may be off 0 and 1: written with seven digits it still passes

// ---- in --------------------------------------------------------------------------------------------------------
std::array<std::uint32_t, 3> read_triangle(const JsonValue& value, std::size_t vertices) {
  value.elements(3);
  std::array<std::uint32_t, 3> triangle{};
  for (std::size_t c = 0; c < 3; ++c)
    triangle[c] = static_cast<std::uint32_t>(value[c].integer(0, static_cast<std::int64_t>(vertices) - 1));
  return triangle;
}

OrganShape read_shape(const JsonValue& value) {
  value.expect_keys({"name", "vertices", "triangles"});
  OrganShape shape;
  shape.name = value.at("name").string();
  if (const auto vertices = value.find("vertices"))
    for (std::size_t i = 0; i < vertices->size(); ++i) shape.vertices.push_back((*vertices)[i].vec3());
  if (const auto triangles = value.find("triangles"))
    for (std::size_t i = 0; i < triangles->size(); ++i)
      shape.triangles.push_back(read_triangle((*triangles)[i], shape.vertices.size()));
  return shape;
}

void require_square(const JsonValue& value, const OrganPlacement& organ) {
  const Vec3 off = glm::cross(organ.left, organ.heading) - organ.up;
  const auto unit = [](const Vec3& v) { return std::abs(glm::dot(v, v) - 1) < kSquare; };
  if (unit(organ.left) && unit(organ.heading) && unit(organ.up) && glm::length(off) < kSquare) return;
  value.fail("left, heading and up that are not square to each other", "unit vectors with left x heading = up");
}

OrganPlacement read_organ(const JsonValue& value, std::size_t shapes, std::span<const std::int32_t> places) {
  value.expect_keys({"shape", "node", "position", "left", "heading", "up", "scale", "color"});
  OrganPlacement organ;
  if (shapes == 0) value.fail("an organ of no shape", "\"shapes\" that it can be one of");
  organ.shape = static_cast<std::uint32_t>(value.at("shape").integer(0, static_cast<std::int64_t>(shapes) - 1));
  const std::int64_t node = value.at("node").integer(-1, static_cast<std::int64_t>(places.size()) - 1);
  organ.node = node < 0 ? -1 : places[static_cast<std::size_t>(node)];
  organ.position = value.at("position").vec3();
  organ.left = value.at("left").vec3();
  organ.heading = value.at("heading").vec3();
  organ.up = value.at("up").vec3();
  require_square(value, organ);
  const JsonValue scale = value.at("scale");
  organ.scale = scale.number();
  if (!(organ.scale > 0)) scale.fail(scale.describe(), "a scale above 0");
  if (const auto color = value.find("color"))
    organ.color = static_cast<std::uint32_t>(color->integer(0, std::numeric_limits<std::uint32_t>::max()));
  return organ;
}

// ---- out -------------------------------------------------------------------------------------------------------
/// `append(item)` for each, between brackets.
template <class Items, class Append>
void append_list(std::string& out, const Items& items, const Append& append) {
  out += '[';
  bool first = true;
  for (const auto& item : items) {
    if (!first) out += ',';
    first = false;
    append(item);
  }
  out += ']';
}

void append_vector(std::string& out, const Vec3& v) {
  append_list(out, std::array{v.x, v.y, v.z}, [&](double number) { append_number(out, number); });
}

void append_string(std::string& out, const std::string& text) {
  out += '"';
  for (const char c : text) {
    char escaped[8];
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      std::snprintf(escaped, sizeof escaped, "\\u%04x", static_cast<unsigned>(c));
      out += escaped;
    } else {
      out += c;
    }
  }
  out += '"';
}

void append_shape(std::string& out, const OrganShape& shape) {
  out += "\n{\"name\":";
  append_string(out, shape.name);
  out += ",\"vertices\":";
  append_list(out, shape.vertices, [&](const Vec3& v) { append_vector(out, v); });
  out += ",\"triangles\":";
  append_list(out, shape.triangles, [&](const auto& triangle) {
    append_list(out, triangle, [&](std::uint32_t corner) { out += std::to_string(corner); });
  });
  out += '}';
}

void append_organ(std::string& out, const OrganPlacement& organ) {
  out += "\n{\"shape\":" + std::to_string(organ.shape) + ",\"node\":" + std::to_string(organ.node);
  const std::pair<const char*, const Vec3*> vectors[] = {
      {"position", &organ.position}, {"left", &organ.left}, {"heading", &organ.heading}, {"up", &organ.up}};
  for (const auto& [key, vector] : vectors) {
    out += std::string(",\"") + key + "\":";
    append_vector(out, *vector);
  }
  out += ",\"scale\":";
  append_number(out, organ.scale);
  if (organ.color != 0) out += ",\"color\":" + std::to_string(organ.color);
  out += '}';
}

}  // namespace

Foliage read_foliage(const JsonValue& root, std::span<const std::int32_t> places) {
  Foliage foliage;
  if (const auto shapes = root.find("shapes"))
    for (std::size_t i = 0; i < shapes->size(); ++i) foliage.shapes.push_back(read_shape((*shapes)[i]));
  if (const auto organs = root.find("organs"))
    for (std::size_t i = 0; i < organs->size(); ++i)
      foliage.organs.push_back(read_organ((*organs)[i], foliage.shapes.size(), places));
  return foliage;
}

void append_foliage(std::string& out, const Foliage& foliage) {
  if (foliage.shapes.empty()) return;
  out += ",\"shapes\":";
  append_list(out, foliage.shapes, [&](const OrganShape& shape) { append_shape(out, shape); });
  out += ",\"organs\":";
  append_list(out, foliage.organs, [&](const OrganPlacement& organ) { append_organ(out, organ); });
}

}  // namespace cambium
