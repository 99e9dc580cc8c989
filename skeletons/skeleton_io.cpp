#include "skeletons/skeleton_io.h"

#include "blobtree/input_error.h"
#include "skeletons/foliage_json.h"
#include "skeletons/number_text.h"

#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace cambium {
namespace {

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool ends_with(const std::string& text, std::string_view end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::string read_text(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw InputError({path.string(), 0, 0}, "no such file", "a readable file");
  if (std::filesystem::is_directory(path, error)) throw InputError({path.string(), 0, 0}, "a folder", "a readable file");
  std::ifstream in(path, std::ios::binary);
  std::string text;
  char block[1 << 16];
  while (in && (in.read(block, sizeof block), in.gcount() > 0)) text.append(block, static_cast<std::size_t>(in.gcount()));
  if (!in.is_open() || in.bad()) throw InputError({path.string(), 0, 0}, "a file that cannot be read", "a readable file");
  return text;
}

void append_position(std::string& out, const Vec3& p, char separator) {
  append_number(out, p.x);
  out += separator;
  append_number(out, p.y);
  out += separator;
  append_number(out, p.z);
}

std::string skel_json_text(const Skeleton& skeleton, const Foliage& foliage) {
  std::string out = "{\"format\":\"cambium-skeleton\",\"version\":1,\"nodes\":[";
  for (std::size_t i = 0; i < skeleton.nodes.size(); ++i) {
    const SkeletonNode& node = skeleton.nodes[i];
    out += i == 0 ? "\n{\"position\":[" : ",\n{\"position\":[";
    append_position(out, node.position, ',');
    out += "],\"radius\":";
    append_number(out, node.radius);
    out += ",\"parent\":" + std::to_string(node.parent);
    if (node.base_radius) {
      out += ",\"base_radius\":";
      append_number(out, *node.base_radius);
    }
    if (node.lateral) out += *node.lateral ? ",\"lateral\":true" : ",\"lateral\":false";
    out += '}';
  }
  out += "\n]";
  append_foliage(out, foliage);
  return out + "}\n";
}

std::string swc_text(const Skeleton& skeleton) {
  std::string out = "# id type x y z radius parent\n";
  for (std::size_t i = 0; i < skeleton.nodes.size(); ++i) {
    const SkeletonNode& node = skeleton.nodes[i];
    out += std::to_string(i + 1) + " 0 ";
    append_position(out, node.position, ' ');
    out += ' ';
    append_number(out, node.radius);
    out += ' ' + std::to_string(node.parent < 0 ? -1 : node.parent + 1) + '\n';
  }
  return out;
}

}  // namespace

Plant read_plant(const std::filesystem::path& path) {
  const std::string name = lower_case(path.filename().string());
  if (ends_with(name, ".skel.json")) return parse_plant_json(read_text(path), path.string());
  Skeleton (*parse)(std::string_view, const std::string&) = nullptr;
  if (ends_with(name, ".swc")) parse = parse_swc;
  if (ends_with(name, ".csv")) parse = parse_qsm_csv;
  if (!parse) throw InputError({path.string(), 0, 0}, "an unknown extension", "a .skel.json, .swc or .csv file");
  return {parse(read_text(path), path.string()), {}};
}

Skeleton read_skeleton(const std::filesystem::path& path) { return read_plant(path).skeleton; }

std::string skeleton_text(const Skeleton& skeleton, const std::string& format, const Foliage& foliage) {
  const std::string kind = lower_case(!format.empty() && format[0] == '.' ? format.substr(1) : format);
  if (kind == "skel.json") return skel_json_text(skeleton, foliage);
  if (kind == "swc") return swc_text(skeleton);
  throw std::invalid_argument("skeleton format '" + format + "': expected skel.json or swc");
}

void write_skeleton(const Skeleton& skeleton, const std::filesystem::path& path, const std::string& format, const Foliage& foliage) {
  const std::string text = skeleton_text(skeleton, format, foliage);
  errno = 0;
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  if (out) out.write(text.data(), static_cast<std::streamsize>(text.size()));
  if (out) out.close();
  if (!out) {
    const std::string reason = errno != 0 ? std::string(": ") + std::strerror(errno) : std::string();
    throw std::runtime_error(path.string() + ": cannot be written" + reason);
  }
}

}  // namespace cambium
