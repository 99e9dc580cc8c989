#include "blobtree/located_json.h"
#include "skeletons/foliage_json.h"
#include "skeletons/skeleton_io.h"
#include "skeletons/skeleton_rows.h"

#include <limits>

namespace cambium {
namespace {

double positive(const JsonValue& value) {
  const double number = value.number();
  if (!(number > 0)) value.fail(value.describe(), "a number above 0 for a radius");
  return number;
}

SkeletonRow read_node(const JsonValue& value, std::size_t index) {
  value.expect_keys({"position", "radius", "parent", "base_radius", "lateral"});
  const JsonValue parent = value.at("parent");
  SkeletonRow row;
  row.id = static_cast<std::int64_t>(index);
  row.line = parent.location().line;
  row.id_column = row.parent_column = parent.location().column;
  row.parent = parent.integer(-1, std::numeric_limits<std::int32_t>::max());
  row.node.position = value.at("position").vec3();
  row.node.radius = positive(value.at("radius"));
  if (const auto base = value.find("base_radius")) row.node.base_radius = positive(*base);
  if (const auto lateral = value.find("lateral")) row.node.lateral = lateral->boolean();
  return row;
}

}  // namespace

Plant parse_plant_json(std::string_view text, const std::string& file) {
  const LocatedJson document = LocatedJson::parse(std::string(text), file);
  const JsonValue root = document.root();
  root.expect_keys({"format", "version", "nodes", "shapes", "organs"});
  const JsonValue format = root.at("format");
  if (format.string() != "cambium-skeleton") format.fail(format.describe(), "\"cambium-skeleton\"");
  const JsonValue version = root.at("version");
  if (version.number() != 1) version.fail(version.describe(), "version 1");
  const JsonValue nodes = root.at("nodes");
  if (nodes.size() == 0) nodes.fail("no nodes", "at least one");
  std::vector<SkeletonRow> rows;
  rows.reserve(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) rows.push_back(read_node(nodes[i], i));
  Plant plant;
  std::vector<std::int32_t> places;
  plant.skeleton = skeleton_from_rows(rows, file, &places);
  plant.foliage = read_foliage(root, places);
  return plant;
}

Skeleton parse_skel_json(std::string_view text, const std::string& file) { return parse_plant_json(text, file).skeleton; }

}  // namespace cambium
