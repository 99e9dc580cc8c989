#include "blobtree/blobtree_json.h"
#include "blobtree/degrees.h"
#include "blobtree/flare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <memory>
#include <stdexcept>

namespace cambium {
namespace {

// A JSON string. Bytes that are not UTF-8 become U+FFFD.
std::string json_string(std::string_view text) {
  std::string out = "\"";
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte == '"' || byte == '\\') {
      out += '\\';
      out += text[i++];
    } else if (byte < 0x20) {
      out += fmt::format("\\u{:04x}", byte);
      ++i;
    } else if (byte < 0x80) {
      out += text[i++];
    } else {
      const std::size_t length = byte < 0xC2 || byte > 0xF4 ? 1 : byte < 0xE0 ? 2 : byte < 0xF0 ? 3 : 4;
      bool legal = length > 1 && i + length <= text.size();
      for (std::size_t k = 1; legal && k < length; ++k) legal = (static_cast<unsigned char>(text[i + k]) & 0xC0) == 0x80;
      if (legal) {  // overlong forms, surrogates, beyond U+10FFFF
        const auto second = static_cast<unsigned char>(text[i + 1]);
        legal = !(byte == 0xE0 && second < 0xA0) && !(byte == 0xED && second >= 0xA0) && !(byte == 0xF0 && second < 0x90) &&
                !(byte == 0xF4 && second >= 0x90);
      }
      out += legal ? text.substr(i, length) : std::string_view("\xEF\xBF\xBD");
      i += legal ? length : 1;
    }
  }
  return out + '"';
}

class Writer {
 public:
  explicit Writer(const BlobTree& tree) : tree_(tree) {}

  std::string write() {
    out_ = "{\"format\": \"cambium-blobtree\", \"version\": 1, \"root\":";
    tasks_.push_back({"", tree_.root(), 0});
    while (!tasks_.empty()) {  // instead of recursion: trees nest without limit
      const Task task = std::move(tasks_.back());
      tasks_.pop_back();
      out_ += task.text;
      if (task.node == kNoNode) continue;
      depth_ = task.depth;
      constexpr std::uint32_t kDeepestIndent = 30;  // or deep nests would be mostly blanks
      out_ += '\n';
      out_.append(1 + std::min(depth_, kDeepestIndent), ' ');
      node(task.node);
    }
    out_ += "}\n";
    return std::move(out_);
  }

 private:
  static constexpr NodeId kNoNode = ~NodeId{0};
  struct Task {  // text, then a node
    std::string text;
    NodeId node;
    std::uint32_t depth;
  };

  void node(NodeId id) {
    later_.clear();
    std::visit([&](const auto& n) { write(n, id); }, tree_.node(id));
    std::move(later_.rbegin(), later_.rend(), std::back_inserter(tasks_));
  }

  // ---- pieces --------------------------------------------------------------------------------------------------
  void begin(const char* op, NodeId id) {
    fmt::format_to(std::back_inserter(out_), "{{\"op\": \"{}\"", op);
    if (!tree_.name(id).empty()) fmt::format_to(std::back_inserter(out_), ", \"name\": {}", json_string(tree_.name(id)));
  }
  void end(double strength) {
    if (strength != 1) put("strength", strength);
    out_ += '}';
  }
  void put(const char* key, double v) { fmt::format_to(std::back_inserter(out_), ", \"{}\": {}", key, v); }
  void put(const char* key, const Vec3& v) { out_ += vec3_member(key, v); }
  void put(const char* key, double a, double b) {
    fmt::format_to(std::back_inserter(out_), ", \"{}\": [{}, {}]", key, a, b);
  }
  static std::string vec3_member(const char* key, const Vec3& v) {
    return fmt::format(", \"{}\": [{}, {}, {}]", key, v.x, v.y, v.z);
  }
  void put_angle(const char* key, double radians) {
    fmt::format_to(std::back_inserter(out_), ", \"{}\": {}", key, degrees_text(radians));
  }
  static std::string degrees_text(double radians) {
    // Shortest as a double if its text, read with all its digits, comes back to the same radians; else as a long double.
    const long double degrees = degrees_from_radians(radians);
    std::string text = fmt::format("{}", static_cast<double>(degrees));
    long double read = 0;
    std::from_chars(text.data(), text.data() + text.size(), read);
    if (radians_from_degrees(read) != radians) {
      text.resize(64);
      text.resize(static_cast<std::size_t>(std::to_chars(text.data(), text.data() + text.size(), degrees).ptr - text.data()));
    }
    return text;
  }
  void put_nodes(const std::vector<ChainNode>& nodes) {
    out_ += ", \"nodes\": [";
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const auto& [p, radius] = nodes[i];
      fmt::format_to(std::back_inserter(out_), "{}[{}, {}, {}, {}]", i == 0 ? "" : ", ", p.x, p.y, p.z, radius);
    }
    out_ += ']';
  }
  void put_contact(double width, double lip) {
    if (width != kIso) put("width", width);
    if (lip != 0) put("lip", lip);
  }
  void child(std::string text, NodeId id) { later_.push_back({std::move(text), id, depth_ + 1}); }
  void close(std::string text) { later_.push_back({std::move(text), kNoNode, depth_}); }
  void only_child(NodeId id) {
    child(", \"child\":", id);
    close("}");
  }
  void put_children(const std::vector<NodeId>& children) {
    for (std::size_t i = 0; i < children.size(); ++i) child(i == 0 ? ", \"children\": [" : ",", children[i]);
    close("]}");
  }

  // ---- one per node: a new one does not compile until it is here -------------------------------------------------
  template <class T>
  void write_cone(const char* op, const T& n, NodeId id) {
    begin(op, id);
    put("base", n.base);
    put("tip", n.tip);
    put("radius_base", n.radius_base);
    put("radius_tip", n.radius_tip);
    end(n.strength);
  }
  void write(const Cone& n, NodeId id) { write_cone("cone", n, id); }
  void write(const RoundCone& n, NodeId id) { write_cone("round_cone", n, id); }
  void write(const Chain& n, NodeId id) {
    begin("chain", id);
    put_nodes(n.nodes);
    end(n.strength);
  }
  void write(const Flare& n, NodeId id) {
    begin("flare", id);
    put_nodes(n.nodes);
    put("base", n.base);
    put("axis", n.axis);
    put("height", n.height);
    put("spread", n.spread);
    put("sharpness", n.sharpness);
    out_ += ", \"prongs\": [";
    for (std::size_t i = 0; i < n.prongs.size(); ++i)
      fmt::format_to(std::back_inserter(out_), "{}{{\"angle_degrees\": {}, \"length\": {}}}", i == 0 ? "" : ", ",
                     degrees_text(n.prongs[i].angle), n.prongs[i].length);
    out_ += ']';
    if (n.section != FlareSection::kEnvelope) fmt::format_to(std::back_inserter(out_), ", \"section\": \"{}\"", name_of(n.section));
    end(n.strength);
  }
  void write(const Sphere& n, NodeId id) {
    begin("sphere", id);
    put("center", n.center);
    put("radius", n.radius);
    end(n.strength);
  }
  void write(const Capsule& n, NodeId id) {
    begin("capsule", id);
    put("a", n.a);
    put("b", n.b);
    put("radius", n.radius);
    end(n.strength);
  }
  void write(const Disc& n, NodeId id) {
    begin("disc", id);
    put("center", n.center);
    put("normal", n.normal);
    put("disc_radius", n.disc_radius);
    put("radius", n.radius);
    end(n.strength);
  }
  void write(const Torus& n, NodeId id) {
    begin("torus", id);
    put("center", n.center);
    put("normal", n.normal);
    put("ring_radius", n.ring_radius);
    put("radius", n.radius);
    end(n.strength);
  }
  void write(const RotatedBox& n, NodeId id) {
    begin("box", id);
    put("center", n.center);
    put("half_size", n.half_size);
    const auto& q = n.rotation;
    if (q != glm::dvec4{1, 0, 0, 0})
      fmt::format_to(std::back_inserter(out_), ", \"rotation\": [{}, {}, {}, {}]", q[0], q[1], q[2], q[3]);
    put("radius", n.radius);
    end(n.strength);
  }
  void write(const HalfSpace& n, NodeId id) {
    begin("half_space", id);
    put("point", n.point);
    put("normal", n.normal);
    put("width", n.width);
    end(1);
  }
  void write(const Sum& n, NodeId id) { begin("sum", id), put_children(n.children); }
  void write(const Union& n, NodeId id) { begin("union", id), put_children(n.children); }
  void write(const Intersection& n, NodeId id) { begin("intersection", id), put_children(n.children); }
  void write(const Difference& n, NodeId id) { begin("difference", id), put_children(n.children); }
  void write(const Ricci& n, NodeId id) {
    begin("ricci", id);
    put("exponent", n.exponent);
    put_children(n.children);
  }
  void write(const Contact& n, NodeId id) {
    begin("contact", id);
    put_contact(n.width, n.lip);
    put_children(n.children);
  }
  void write(const Fork& n, NodeId id) {
    begin("fork", id);
    put_contact(n.width, n.lip);
    child(", \"axis\":", n.axis);
    std::string text = ", \"laterals\": [";
    for (const Lateral& lateral : n.laterals) {
      child(text + "{\"child\":", lateral.child);
      text = vec3_member("point", lateral.point) + vec3_member("direction", lateral.direction) +
             fmt::format(", \"softness\": {}, \"reach\": {}}}, ", lateral.softness, lateral.reach);
    }
    text.resize(text.size() - 2);
    close(text + "]}");
  }
  void write(const ScaleField& n, NodeId id) {
    begin("scale_field", id);
    put("factor", n.factor);
    only_child(n.child);
  }
  void write(const Transform& n, NodeId id) {
    begin("transform", id);
    for (int i = 0; i < 16; ++i)
      fmt::format_to(std::back_inserter(out_), "{}{}", i == 0 ? ", \"matrix\": [" : ", ", n.matrix[i % 4][i / 4]);
    out_ += ']';
    only_child(n.child);
  }
  void write(const Bend& n, NodeId id) {
    begin("bend", id);
    put("from", n.from);
    put("to", n.to);
    put("direction", n.direction);
    put_angle("angle_degrees", n.angle);
    only_child(n.child);
  }
  void write(const Twist& n, NodeId id) {
    begin("twist", id);
    put("point", n.point);
    put("axis", n.axis);
    put_angle("rate_degrees_per_metre", n.rate);
    only_child(n.child);
  }
  void write(const Taper& n, NodeId id) {
    begin("taper", id);
    put("point", n.point);
    put("axis", n.axis);
    put("from", n.from_height, n.from_scale);
    put("to", n.to_height, n.to_scale);
    only_child(n.child);
  }

  const BlobTree& tree_;
  std::string out_;
  std::vector<Task> tasks_;
  std::vector<Task> later_;  // what follows the head of the current node, in order
  std::uint32_t depth_ = 0;
};

void write_text(const std::string& text, const std::filesystem::path& path, const std::filesystem::path& named) {
  const auto fail = [&] { throw std::runtime_error(named.string() + ": cannot be written: " + std::strerror(errno)); };
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"), std::fclose);
  if (!file) fail();
  if (std::fwrite(text.data(), 1, text.size(), file.get()) != text.size()) fail();
  if (std::fclose(file.release()) != 0) fail();
}

}  // namespace

std::string to_json(const BlobTree& tree) { return Writer(tree).write(); }

void write_blobtree(const BlobTree& tree, const std::filesystem::path& path) {
  const std::string text = to_json(tree);
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    return write_text(text, path, path);  // a pipe or a device cannot be renamed onto
  auto beside = path;
  beside += ".part";
  try {
    write_text(text, beside, path);
    std::filesystem::rename(beside, path, error);
    if (error) throw std::runtime_error(path.string() + ": cannot be written: " + error.message());
  } catch (...) {
    std::filesystem::remove(beside, error);
    throw;
  }
}

}  // namespace cambium
