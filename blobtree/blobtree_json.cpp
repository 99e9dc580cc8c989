#include "blobtree/blobtree_json.h"

#include "blobtree/degrees.h"
#include "blobtree/flare.h"
#include "blobtree/located_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <span>

namespace cambium {
namespace {

using Json = JsonValue;
using Ids = std::span<const NodeId>;

double strength(const Json& json) { return json.number_or("strength", 1); }
double angle(const Json& json, std::string_view key) { return radians_from_degrees(json.at(key).extended_number()); }
Vec3 vec3(const Json& json, std::string_view key) { return json.at(key).vec3(); }
double number(const Json& json, std::string_view key) { return json.at(key).number(); }

// ---- one reader per op; ids are those of the children, in the order of child_values() ---------------------------
template <class T>
Node read_cone(const Json& json, Ids) {
  json.expect_keys({"op", "name", "base", "tip", "radius_base", "radius_tip", "strength"});
  return T{vec3(json, "base"), vec3(json, "tip"), number(json, "radius_base"), number(json, "radius_tip"), strength(json)};
}

void refuse_bark(const Json& json) {
  for (std::size_t i = 0; i < json.member_count(); ++i)
    if (json.member_key(i).string() == "bark")
      json.member_key(i).fail("`bark`, which this version does not support", fmt::format("a {} without it", json.at("op").string()));
}

std::vector<ChainNode> read_chain_nodes(const Json& json) {
  const Json list = json.at("nodes");
  std::vector<ChainNode> nodes;
  nodes.reserve(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Json node = list[i];
    if (node.kind() != Json::Kind::Array || node.size() != 4) node.fail(node.describe(), "[x, y, z, radius]");
    nodes.push_back({{node[0].number(), node[1].number(), node[2].number()}, node[3].number()});
  }
  return nodes;
}

Node read_chain(const Json& json, Ids) {
  refuse_bark(json);
  json.expect_keys({"op", "name", "nodes", "strength"});
  return Chain{read_chain_nodes(json), strength(json)};
}

FlareSection read_section(const Json& json) {
  for (const FlareSection section : {FlareSection::kEnvelope, FlareSection::kQuadrifolium, FlareSection::kCircle})
    if (json.string() == name_of(section)) return section;
  json.fail(json.describe(), "`envelope`, `quadrifolium` or `circle`");
}

Node read_flare(const Json& json, Ids) {
  refuse_bark(json);
  json.expect_keys({"op", "name", "nodes", "base", "axis", "height", "spread", "sharpness", "prongs", "section", "strength"});
  Flare flare{read_chain_nodes(json),    vec3(json, "base"),        vec3(json, "axis"), number(json, "height"),
              number(json, "spread"), number(json, "sharpness"), {}};
  const Json prongs = json.at("prongs");
  for (std::size_t i = 0; i < prongs.size(); ++i) {
    const Json prong = prongs[i];
    prong.expect_keys({"angle_degrees", "length"});
    flare.prongs.push_back({angle(prong, "angle_degrees"), prong.number_or("length", 1)});
  }
  if (const auto section = json.find("section")) flare.section = read_section(*section);
  flare.strength = strength(json);
  return flare;
}

Node read_sphere(const Json& json, Ids) {
  json.expect_keys({"op", "name", "center", "radius", "strength"});
  return Sphere{vec3(json, "center"), number(json, "radius"), strength(json)};
}

Node read_capsule(const Json& json, Ids) {
  json.expect_keys({"op", "name", "a", "b", "radius", "strength"});
  return Capsule{vec3(json, "a"), vec3(json, "b"), number(json, "radius"), strength(json)};
}

Node read_disc(const Json& json, Ids) {
  json.expect_keys({"op", "name", "center", "normal", "disc_radius", "radius", "strength"});
  return Disc{vec3(json, "center"), vec3(json, "normal"), number(json, "disc_radius"), number(json, "radius"), strength(json)};
}

Node read_torus(const Json& json, Ids) {
  json.expect_keys({"op", "name", "center", "normal", "ring_radius", "radius", "strength"});
  return Torus{vec3(json, "center"), vec3(json, "normal"), number(json, "ring_radius"), number(json, "radius"), strength(json)};
}

Node read_box(const Json& json, Ids) {
  json.expect_keys({"op", "name", "center", "half_size", "rotation", "radius", "strength"});
  RotatedBox box{vec3(json, "center"), vec3(json, "half_size"), {1, 0, 0, 0}, number(json, "radius"), strength(json)};
  if (const auto rotation = json.find("rotation")) {
    const Json q = rotation->elements(4);
    box.rotation = {q[0].number(), q[1].number(), q[2].number(), q[3].number()};
  }
  return box;
}

Node read_half_space(const Json& json, Ids) {
  json.expect_keys({"op", "name", "point", "normal", "width"});
  return HalfSpace{vec3(json, "point"), vec3(json, "normal"), number(json, "width")};
}

template <class T>
Node read_plain(const Json& json, Ids ids) {
  json.expect_keys({"op", "name", "children"});
  return T{{ids.begin(), ids.end()}};
}

Node read_ricci(const Json& json, Ids ids) {
  json.expect_keys({"op", "name", "children", "exponent"});
  return Ricci{{ids.begin(), ids.end()}, number(json, "exponent")};
}

Node read_contact(const Json& json, Ids ids) {
  json.expect_keys({"op", "name", "children", "width", "lip"});
  return Contact{{ids.begin(), ids.end()}, json.number_or("width", kIso), json.number_or("lip", 0)};
}

Node read_fork(const Json& json, Ids ids) {
  json.expect_keys({"op", "name", "axis", "laterals", "width", "lip"});
  Fork fork;
  fork.axis = ids[0];
  const Json laterals = json.at("laterals");
  for (std::size_t i = 0; i < laterals.size(); ++i) {
    const Json lateral = laterals[i];
    lateral.expect_keys({"child", "point", "direction", "softness", "reach"});
    fork.laterals.push_back({ids[i + 1], vec3(lateral, "point"), vec3(lateral, "direction"), number(lateral, "softness"),
                             number(lateral, "reach")});
  }
  fork.width = json.number_or("width", kIso);
  fork.lip = json.number_or("lip", 0);
  return fork;
}

Node read_scale_field(const Json& json, Ids ids) {
  json.expect_keys({"op", "name", "factor", "child"});
  return ScaleField{number(json, "factor"), ids[0]};
}

Node read_transform(const Json& json, Ids ids) {
  json.expect_keys({"op", "name", "matrix", "child"});
  const Json rows = json.at("matrix").elements(16);
  Transform transform;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) transform.matrix[c][r] = rows[static_cast<std::size_t>(4 * r + c)].number();
  transform.child = ids[0];
  return transform;
}

Node read_bend(const Json& json, Ids ids) {
  json.expect_keys({"op", "name", "from", "to", "direction", "angle_degrees", "child"});
  return Bend{vec3(json, "from"), vec3(json, "to"), vec3(json, "direction"), angle(json, "angle_degrees"), ids[0]};
}

Node read_twist(const Json& json, Ids ids) {
  json.expect_keys({"op", "name", "point", "axis", "rate_degrees_per_metre", "child"});
  return Twist{vec3(json, "point"), vec3(json, "axis"), angle(json, "rate_degrees_per_metre"), ids[0]};
}

Node read_taper(const Json& json, Ids ids) {
  json.expect_keys({"op", "name", "point", "axis", "from", "to", "child"});
  const Json from = json.at("from").elements(2), to = json.at("to").elements(2);
  return Taper{vec3(json, "point"), vec3(json, "axis"), from[0].number(), from[1].number(), to[0].number(), to[1].number(),
               ids[0]};
}

enum class Children { None, One, List, Fork };

struct Op {
  std::string_view name;
  Children children;
  Node (*read)(const Json&, Ids);
};

constexpr Op kOps[] = {
    {"cone", Children::None, read_cone<Cone>},
    {"round_cone", Children::None, read_cone<RoundCone>},
    {"chain", Children::None, read_chain},
    {"flare", Children::None, read_flare},
    {"sphere", Children::None, read_sphere},
    {"capsule", Children::None, read_capsule},
    {"disc", Children::None, read_disc},
    {"torus", Children::None, read_torus},
    {"box", Children::None, read_box},
    {"half_space", Children::None, read_half_space},
    {"sum", Children::List, read_plain<Sum>},
    {"union", Children::List, read_plain<Union>},
    {"intersection", Children::List, read_plain<Intersection>},
    {"difference", Children::List, read_plain<Difference>},
    {"ricci", Children::List, read_ricci},
    {"contact", Children::List, read_contact},
    {"fork", Children::Fork, read_fork},
    {"scale_field", Children::One, read_scale_field},
    {"transform", Children::One, read_transform},
    {"bend", Children::One, read_bend},
    {"twist", Children::One, read_twist},
    {"taper", Children::One, read_taper},
};
static_assert(std::size(kOps) == std::variant_size_v<Node>);

const Op& op_of(const Json& json) {
  const Json name = json.at("op");
  for (const Op& op : kOps)
    if (op.name == name.string()) return op;
  std::string list;
  for (const Op& op : kOps) list += fmt::format("{}`{}`", list.empty() ? "" : ", ", op.name);
  name.fail(fmt::format("the unknown op `{}`", name.string()), "one of " + list);
}

std::vector<Json> child_values(const Json& json, Children children) {
  std::vector<Json> values;
  switch (children) {
    case Children::None: break;
    case Children::One: values.push_back(json.at("child")); break;
    case Children::List: {
      const Json list = json.at("children");
      for (std::size_t i = 0; i < list.size(); ++i) values.push_back(list[i]);
      break;
    }
    case Children::Fork: {
      values.push_back(json.at("axis"));
      const Json laterals = json.at("laterals");
      for (std::size_t i = 0; i < laterals.size(); ++i) values.push_back(laterals[i].at("child"));
      break;
    }
  }
  return values;
}

// The value that an InvalidNode's key, such as `laterals[2].softness`, names in a node's object; as deep as it exists.
Json value_at(const Json& node, std::string_view path) {
  Json value = node;
  while (!path.empty()) {
    if (path.front() == '.') path.remove_prefix(1);
    if (path.front() == '[') {
      std::size_t i = 0;
      const auto end = std::from_chars(path.data() + 1, path.data() + path.size(), i).ptr;
      path.remove_prefix(static_cast<std::size_t>(end - path.data()) + 1);
      if (value.kind() != Json::Kind::Array || i >= value.size()) return value;
      value = value[i];
      continue;
    }
    const auto key = path.substr(0, path.find_first_of(".["));
    path.remove_prefix(key.size());
    if (value.kind() != Json::Kind::Object) return value;
    const auto member = value.find(key);
    if (!member) return value;
    value = *member;
  }
  return value;
}

BlobTree build(const LocatedJson& document) {
  const Json top = document.root();
  top.expect_keys({"format", "version", "root"});
  if (const Json format = top.at("format"); format.string() != "cambium-blobtree")
    format.fail(format.describe(), "the string `cambium-blobtree`");
  top.at("version").integer(1, 1);

  struct Frame {
    Json json;
    const Op* op;
    std::vector<Json> children;
    std::vector<NodeId> ids;
  };
  const auto open = [](const Json& json) {
    const Op& op = op_of(json);
    return Frame{json, &op, child_values(json, op.children), {}};
  };
  BlobTreeBuilder builder;
  NodeId last = 0;
  std::vector<Frame> stack;  // instead of recursion: files may nest without limit
  stack.push_back(open(top.at("root")));
  while (!stack.empty()) {
    Frame& frame = stack.back();
    if (frame.ids.size() < frame.children.size()) {
      stack.push_back(open(frame.children[frame.ids.size()]));
      continue;
    }
    try {
      last = builder.add(frame.op->read(frame.json, frame.ids));
    } catch (const InvalidNode& error) {
      value_at(frame.json, error.key()).fail(fmt::format("`{}` {}", error.key(), error.found()), error.expected());
    }
    if (const auto name = frame.json.find("name")) builder.set_name(last, std::string(name->string()));
    stack.pop_back();
    if (!stack.empty()) stack.back().ids.push_back(last);
  }
  return builder.build(last);
}

}  // namespace

BlobTree read_blobtree(const std::filesystem::path& path) { return build(load_json(path)); }

BlobTree parse_blobtree(std::string_view text, const std::string& file) { return build(parse_json(text, file)); }

}  // namespace cambium
