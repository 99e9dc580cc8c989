#include "polygonize/obj_sheet.h"

#include "blobtree/input_error.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <map>

namespace cambium {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

/// One line's words, with the columns that they begin at.
class Words {
 public:
  Words(std::string_view line, const std::string& file, int number) : line_(line), file_(file), number_(number) {}

  /// "" at the end of the line.
  std::string_view next() {
    const std::size_t begin = std::min(line_.find_first_not_of(" \t\r", at_), line_.size());
    at_ = std::min(line_.find_first_of(" \t\r", begin), line_.size());
    begin_ = begin;
    return line_.substr(begin, at_ - begin);
  }

  float number() {
    const std::string_view word = next();
    float value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value)) refuse(word, "a number");
    return value;
  }

  [[noreturn]] void refuse(std::string_view found, const std::string& expected) const {
    throw InputError({file_, number_, static_cast<int>(begin_) + 1},
                     found.empty() ? "the line's end" : "'" + std::string(found.substr(0, 40)) + "'", expected);
  }

 private:
  std::string_view line_;
  const std::string& file_;
  int number_;
  std::size_t begin_ = 0, at_ = 0;
};

/// Indices of a corner's position, texture coordinates and normal; kNone: it has none.
using Corner = std::array<std::uint32_t, 3>;

class ObjReader {
 public:
  explicit ObjReader(const std::string& file) : file_(file) {}

  void read_line(std::string_view line, int number) {
    Words words(line, file_, number);
    const std::string_view kind = words.next();
    if (kind == "v") positions_.push_back(vector(words));
    if (kind == "vn") normals_.push_back(vector(words));
    if (kind == "vt") {
      const float u = words.number(), v = words.number();
      uvs_.emplace_back(u, v);
    }
    if (kind == "f") read_face(words);
  }

  Sheet finished() && {
    if (sheet_.triangles.empty()) throw InputError({file_}, "no faces", "at least one line that begins with f");
    if (bare_) sheet_.normals = mean_normals(sheet_);
    return std::move(sheet_);
  }

 private:
  static glm::vec3 vector(Words& words) {
    const float x = words.number(), y = words.number(), z = words.number();
    return {x, y, z};
  }

  void read_face(Words& words) {
    std::vector<std::uint32_t> corners;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) corners.push_back(vertex_of(read_corner(word, words)));
    if (corners.size() < 3) words.refuse("", "three corners or more");
    for (std::size_t i = 2; i < corners.size(); ++i) sheet_.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  }

  /// `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1, or from the last one backwards.
  Corner read_corner(std::string_view word, const Words& words) const {
    const std::size_t counts[] = {positions_.size(), uvs_.size(), normals_.size()};
    Corner corner{kNone, kNone, kNone};
    std::size_t begin = 0;
    for (std::size_t part = 0; part < 3 && begin <= word.size(); ++part) {
      const std::size_t end = std::min(word.find('/', begin), word.size());
      if (end > begin) corner[part] = read_index(word.substr(begin, end - begin), counts[part], word, words);
      begin = end + 1;
    }
    if (corner[0] == kNone || begin <= word.size()) words.refuse(word, "a corner such as 1, 1/2 or 1/2/3");
    return corner;
  }

  static std::uint32_t read_index(std::string_view digits, std::size_t count, std::string_view word, const Words& words) {
    std::int64_t index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    if (error != std::errc{} || end != digits.data() + digits.size()) words.refuse(word, "a corner such as 1, 1/2 or 1/2/3");
    const auto last = static_cast<std::int64_t>(count);
    const std::int64_t from_zero = index < 0 ? last + index : index - 1;
    if (index == 0 || from_zero < 0 || from_zero >= last)
      words.refuse(word, "numbers of lines before it, of which there are " + std::to_string(count));
    return static_cast<std::uint32_t>(from_zero);
  }

  std::uint32_t vertex_of(const Corner& corner) {
    const auto [known, added] = vertices_.emplace(corner, static_cast<std::uint32_t>(sheet_.positions.size()));
    if (!added) return known->second;
    sheet_.positions.push_back(positions_[corner[0]]);
    sheet_.uvs.push_back(corner[1] == kNone ? glm::vec2(0.0f) : uvs_[corner[1]]);
    const glm::vec3 normal = corner[2] == kNone ? glm::vec3(0.0f) : normals_[corner[2]];
    const float length = glm::length(normal);
    bare_ = bare_ || !(length > 0 && length < std::numeric_limits<float>::infinity());
    sheet_.normals.push_back(bare_ ? glm::vec3(0, 0, 1) : normal / length);
    return known->second;
  }

  const std::string& file_;
  std::vector<glm::vec3> positions_, normals_;
  std::vector<glm::vec2> uvs_;
  std::map<Corner, std::uint32_t> vertices_;
  Sheet sheet_;
  bool bare_ = false;   // a corner is without a normal that can be used
};

}  // namespace

Sheet parse_obj_sheet(std::string_view text, const std::string& file) {
  ObjReader reader(file);
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    reader.read_line(text.substr(begin, end - begin), ++number);
    begin = end + 1;
  }
  return std::move(reader).finished();
}

}  // namespace cambium
