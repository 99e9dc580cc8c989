#include "polygonize/mesh_read.h"

#include "blobtree/input_error.h"
#include "polygonize/obj_sheet.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

namespace cambium {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is copied as it is");

std::string quoted(std::string_view text) { return text.empty() ? "the end" : "'" + std::string(text.substr(0, 40)) + "'"; }

enum class Number { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

std::optional<Number> number_type(std::string_view name) {
  constexpr struct {
    std::string_view name, other;
    Number type;
  } kTypes[] = {{"char", "int8", Number::kInt8},       {"uchar", "uint8", Number::kUint8},  {"short", "int16", Number::kInt16},
                {"ushort", "uint16", Number::kUint16}, {"int", "int32", Number::kInt32},    {"uint", "uint32", Number::kUint32},
                {"float", "float32", Number::kFloat32}, {"double", "float64", Number::kFloat64}};
  for (const auto& known : kTypes)
    if (name == known.name || name == known.other) return known.type;
  return std::nullopt;
}

struct Property {
  std::string_view name;
  Number type = Number::kFloat32;
  std::optional<Number> count;       // of a list: what its length is stored as
};

struct Element {
  std::string_view name;
  std::uint64_t rows = 0;
  std::vector<Property> properties;

  const Property* find(std::string_view property) const {
    const auto at = std::find_if(properties.begin(), properties.end(), [&](const Property& p) { return p.name == property; });
    return at == properties.end() ? nullptr : &*at;
  }
};

/// The bytes, front to back: words while they are text, numbers as they are stored in binary.
class PlyBytes {
 public:
  PlyBytes(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  /// "" at the end, and at the end of the line if words are wanted of one line only.
  std::string_view word(bool of_this_line = false) {
    const std::string_view blanks = of_this_line ? " \t\r" : " \t\r\n";
    const std::size_t begin = std::min(bytes_.find_first_not_of(blanks, at_), bytes_.size());
    at_ = std::min(bytes_.find_first_of(" \t\r\n", begin), bytes_.size());
    word_ = begin;
    return bytes_.substr(begin, at_ - begin);
  }

  void end_line() {
    const std::string_view more = word(true);
    if (!more.empty()) refuse(quoted(more), "the line's end");
    skip_line();
  }
  void skip_line() { at_ = std::min(bytes_.find('\n', at_), bytes_.size() - 1) + 1; }

  void begin_data(bool binary) { binary_ = binary; }

  double number(Number type) { return binary_ ? stored(type) : written(); }

  /// Of the word or number that was read last.
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    if (binary_) throw InputError({file_}, "byte " + std::to_string(word_) + ": " + found, expected);
    const std::string_view before = bytes_.substr(0, word_);
    const std::size_t line_begin = before.rfind('\n') + 1;   // 0 where there is none
    const auto lines = std::count(before.begin(), before.end(), '\n');
    throw InputError({file_, static_cast<int>(lines) + 1, static_cast<int>(word_ - line_begin) + 1}, found, expected);
  }

 private:
  double written() {
    const std::string_view text = word();
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || end != text.data() + text.size() || error != std::errc{}) refuse(quoted(text), "a number");
    return value;
  }

  double stored(Number type) {
    switch (type) {
      case Number::kInt8: return copied<std::int8_t>();
      case Number::kUint8: return copied<std::uint8_t>();
      case Number::kInt16: return copied<std::int16_t>();
      case Number::kUint16: return copied<std::uint16_t>();
      case Number::kInt32: return copied<std::int32_t>();
      case Number::kUint32: return copied<std::uint32_t>();
      case Number::kFloat32: return static_cast<double>(copied<float>());
      case Number::kFloat64: return copied<double>();
    }
    return 0;
  }

  template <class T>
  T copied() {
    word_ = at_;
    if (bytes_.size() - at_ < sizeof(T)) refuse("the end", "more data");
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }

  std::string_view bytes_;
  const std::string& file_;
  std::size_t at_ = 0, word_ = 0;
  bool binary_ = false;
};

class PlyReader {
 public:
  PlyReader(std::string_view bytes, const std::string& file) : bytes_(bytes, file), file_(file) {}

  Mesh read() && {
    read_header();
    for (const Element& element : elements_)
      for (std::uint64_t row = 0; row < element.rows; ++row) read_row(element);
    if (mesh_.triangles.empty()) throw InputError({file_}, "no faces", "a mesh with at least one");
    return std::move(mesh_);
  }

 private:
  void read_header() {
    bytes_.word();
    bytes_.end_line();
    bool binary = false, formatted = false;
    while (true) {
      const std::string_view kind = bytes_.word(true);
      if (kind == "comment" || kind == "obj_info") {
        bytes_.skip_line();
        continue;
      }
      if (kind == "format") {
        binary = read_format();
        formatted = true;
      } else if (kind == "element") {
        read_element();
      } else if (kind == "property" && !elements_.empty()) {
        read_property(elements_.back());
      } else if (kind != "end_header") {
        bytes_.refuse(quoted(kind), "format, comment, element, property or end_header");
      } else if (!formatted) {
        bytes_.refuse("a header without a format", "a line such as format ascii 1.0");
      }
      bytes_.end_line();
      if (kind == "end_header") break;
    }
    require_mesh();
    bytes_.begin_data(binary);
  }

  bool read_format() {
    const std::string_view format = bytes_.word(true);
    if (format != "ascii" && format != "binary_little_endian") bytes_.refuse(quoted(format), "ascii or binary_little_endian");
    if (const std::string_view version = bytes_.word(true); version != "1.0") bytes_.refuse(quoted(version), "version 1.0");
    return format != "ascii";
  }

  void read_element() {
    Element element{bytes_.word(true), 0, {}};
    if (element.name.empty()) bytes_.refuse("the line's end", "an element's name");
    const std::string_view rows = bytes_.word(true);
    const auto [end, error] = std::from_chars(rows.data(), rows.data() + rows.size(), element.rows);
    if (rows.empty() || error != std::errc{} || end != rows.data() + rows.size() || element.rows > 0xffffffffu)
      bytes_.refuse(quoted(rows), "a count of at most 4294967295");
    elements_.push_back(element);
  }

  void read_property(Element& element) {
    const auto type = [&](std::string_view name) {
      const auto known = number_type(name);
      if (!known) bytes_.refuse(quoted(name), "a type such as float or uchar");
      return *known;
    };
    Property property;
    const std::string_view first = bytes_.word(true);
    if (first == "list") {
      property.count = type(bytes_.word(true));
      property.type = type(bytes_.word(true));
    } else {
      property.type = type(first);
    }
    property.name = bytes_.word(true);
    if (property.name.empty()) bytes_.refuse("the line's end", "a property's name");
    element.properties.push_back(property);
  }

  static bool is_corners(const Property& property) {
    return property.count && (property.name == "vertex_indices" || property.name == "vertex_index");
  }

  /// That vertices have places and faces corners, and that all rows take bytes.
  void require_mesh() {
    for (const Element& element : elements_)
      if (element.properties.empty() && element.rows > 0)
        throw InputError({file_}, "element " + quoted(element.name) + " without properties", "at least one");
    const Element &vertices = only_element("vertex"), &faces = only_element("face");
    vertex_count_ = vertices.rows;
    for (const char* axis : {"x", "y", "z"}) {
      const Property* property = vertices.find(axis);
      if (!property || property->count) throw InputError({file_}, "vertices without a property " + std::string(axis), "x, y and z");
    }
    if (std::none_of(faces.properties.begin(), faces.properties.end(), is_corners))
      throw InputError({file_}, "faces without a list vertex_indices", "their corners");
  }

  const Element& only_element(const std::string& name) const {
    const auto named = [&](const Element& element) { return element.name == name; };
    if (std::count_if(elements_.begin(), elements_.end(), named) != 1)
      throw InputError({file_}, "no element " + name + ", or more than one", "one");
    return *std::find_if(elements_.begin(), elements_.end(), named);
  }

  void read_row(const Element& element) {
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    if (is_vertex) mesh_.positions.emplace_back(0.0);
    for (const Property& property : element.properties) {
      if (property.count) {
        read_list(property, is_face && is_corners(property));
        continue;
      }
      const double value = bytes_.number(property.type);
      if (!is_vertex || property.name.size() != 1 || property.name[0] < 'x' || property.name[0] > 'z') continue;
      if (!std::isfinite(value)) bytes_.refuse("a coordinate that is not finite", "a finite number");
      mesh_.positions.back()[property.name[0] - 'x'] = value;
    }
  }

  void read_list(const Property& property, bool corners) {
    const double length = bytes_.number(*property.count);
    if (!(length >= (corners ? 3 : 0) && length <= 0xffffffffu && length == std::floor(length)))
      bytes_.refuse("a list of " + std::to_string(length), corners ? "three corners or more" : "a length");
    std::uint32_t first = 0, last = 0;
    for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(length); ++i) {
      const double value = bytes_.number(property.type);
      if (!corners) continue;
      if (!(value >= 0 && value < static_cast<double>(vertex_count_) && value == std::floor(value)))
        bytes_.refuse("corner " + std::to_string(value),
                      "one of the " + std::to_string(vertex_count_) + " vertices, counted from 0");
      const auto corner = static_cast<std::uint32_t>(value);
      if (i == 0) first = corner;
      if (i >= 2) mesh_.triangles.push_back({first, last, corner});
      last = corner;
    }
  }

  PlyBytes bytes_;
  const std::string& file_;
  std::vector<Element> elements_;
  std::uint64_t vertex_count_ = 0;
  Mesh mesh_;
};

Mesh parse_obj(std::string_view text, const std::string& file) {
  const Sheet sheet = parse_obj_sheet(text, file);
  Mesh mesh;
  mesh.positions.assign(sheet.positions.begin(), sheet.positions.end());
  mesh.triangles = sheet.triangles;
  return mesh;
}

bool is_ply(std::string_view bytes) { return bytes.starts_with("ply") && (bytes.size() == 3 || bytes[3] == '\n' || bytes[3] == '\r'); }

}  // namespace

Mesh parse_mesh(std::string_view bytes, const std::string& file) {
  return is_ply(bytes) ? PlyReader(bytes, file).read() : parse_obj(bytes, file);
}

}  // namespace cambium
