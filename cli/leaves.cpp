#include "cli/leaves.h"

#include <algorithm>
#include <cmath>

#include "cli/image_files.h"
#include "cli/leaf_shapes.h"
#include "cli/read_text.h"
#include "polygonize/obj_sheet.h"

namespace cambium {
namespace {

const Vec3 kLeafGreen(0.17, 0.30, 0.065);   // both sides together; a third of it shines through
constexpr double kPlainWidth = 0.5;          // of a plain leaf one unit long
constexpr double kFarthest = 1e9;            // metres: what is beyond has no place in files and hierarchies of floats

/// The recipe's, and behind them what holds where none matches.
std::vector<LeafRecipe> rules_of(const Recipe& recipe) {
  std::vector<LeafRecipe> rules = recipe.leaf;
  rules.emplace_back();
  return rules;
}

FoliageMaterial material_of(const LeafRecipe& rule) {
  FoliageMaterial material;
  if (rule.texture) {
    require_readable(rule.texture->file, &rule.texture->named_at);
    material.texture = load_foliage_texture(rule.texture->file);
  }
  material.color = rule.color.value_or(rule.texture ? Vec3(1.0) : kLeafGreen);
  material.translucency = rule.translucency;
  material.roughness = rule.roughness;
  return material;
}

Sheet read_mesh(const NamedFile& named) {
  require_readable(named.file, &named.named_at);
  return parse_obj_sheet(read_text(named.file), named.file.string());
}

Sheet sheet_of(const LeafRecipe& rule, const FoliageMaterial& material, const OrganShape& organ) {
  if (rule.mesh) return read_mesh(*rule.mesh);
  const auto card = [&](double width, double length) {
    return material.texture ? leaf_card(width, length) : plain_leaf(width, length);
  };
  if (rule.card) return card((*rule.card)[0], (*rule.card)[1]);
  if (!organ.triangles.empty()) return drawn_leaf(organ);
  return card(material.texture ? material.texture->aspect() : kPlainWidth, 1);
}

double reach(const Sheet& sheet) {
  float farthest = 0;
  for (const glm::vec3& p : sheet.positions) farthest = std::max(farthest, glm::length(p));
  return farthest;
}

/// Errors: InputError if a part of a leaf is beyond kFarthest.
void require_near(const OrganShape& shape, const Vec3& position, double size) {
  if (glm::length(position) + size <= kFarthest) return;
  throw InputError({}, "a " + shape.name + " that reaches beyond 1e9 m", "leaves nearer than that");
}

/// Appends one leaf to those of its material.
void append(const Sheet& shape, const FoliageInstance& leaf, MeshLeaves& all) {
  const auto first = static_cast<std::uint32_t>(all.sheet.positions.size());
  const Mat3 turn = leaf.axes / glm::length(leaf.axes[0]);
  for (const glm::vec3& p : shape.positions) all.sheet.positions.emplace_back(leaf.position + leaf.axes * Vec3(p));
  for (const glm::vec3& n : shape.normals) all.sheet.normals.emplace_back(glm::normalize(turn * Vec3(n)));
  all.sheet.uvs.insert(all.sheet.uvs.end(), shape.uvs.begin(), shape.uvs.end());
  for (const auto& [a, b, c] : shape.triangles) all.sheet.triangles.push_back({first + a, first + b, first + c});
  all.branch.resize(all.sheet.positions.size(), static_cast<std::uint32_t>(leaf.branch));
  all.pivot.resize(all.sheet.positions.size(), glm::vec3(leaf.position));
}

MeshMaterial mesh_material(const LeafRecipe& rule, const FoliageMaterial& look, ImageFiles& images) {
  MeshMaterial material;
  material.name = "leaf " + rule.name;
  for (int c = 0; c < 3; ++c) material.color[c] = static_cast<float>(std::min(1.0, look.color[c]));
  material.roughness = static_cast<float>(rule.roughness);
  material.leaf = true;
  if (rule.texture) material.texture = images.read(rule.texture->file, "leaves are without it");
  return material;
}

}  // namespace

std::size_t Leaves::triangles() const {
  std::size_t count = 0;
  for (const FoliageInstance& leaf : scene.instances) count += scene.shapes[leaf.shape].sheet.triangles.size();
  return count;
}

Leaves dress_leaves(const Recipe& recipe, const Foliage& foliage, std::span<const std::uint32_t> organ_branches) {
  const std::vector<LeafRecipe> rules = rules_of(recipe);
  Leaves leaves;
  FoliageScene& scene = leaves.scene;
  for (const LeafRecipe& rule : rules) scene.materials.push_back(material_of(rule));
  std::vector<std::size_t> rule_of;   // by shape
  std::vector<double> reaches;        // likewise
  for (const OrganShape& shape : foliage.shapes) {
    std::size_t rule = 0;
    while (!rules[rule].matches(shape.name)) ++rule;   // the last one matches all
    rule_of.push_back(rule);
    scene.shapes.push_back({sheet_of(rules[rule], scene.materials[rule], shape), static_cast<std::uint32_t>(rule)});
    reaches.push_back(reach(scene.shapes.back().sheet));
  }
  for (std::size_t i = 0; i < foliage.organs.size(); ++i) {
    const OrganPlacement& organ = foliage.organs[i];
    const LeafRecipe& rule = rules[rule_of[organ.shape]];
    const OrganShape& shape = foliage.shapes[organ.shape];
    // An outline's scale is its size in metres, which a card has of its own.
    const double scale = rule.scale * (rule.card && is_outline(shape.name) ? 1 : organ.scale);
    if (!(scale > 0)) continue;
    require_near(shape, organ.position, scale * reaches[organ.shape]);
    scene.instances.push_back({organ.shape, organ.position, scale * Mat3(organ.left, organ.heading, organ.up),
                               static_cast<std::int32_t>(organ_branches[i])});
    if (shape.triangles.empty() && !rule.mesh && !rule.card) ++leaves.shapeless[shape.name];
  }
  return leaves;
}

Leaves dress_leaves(Job& job, const BuiltTree& built) {
  if (built.foliage.organs.empty()) return {};
  const StageTimer timer(job.figures, "leaves");
  Leaves leaves = dress_leaves(job.recipe, built.foliage, built.organ_branches);
  Json figures = {{"organs", leaves.scene.instances.size()}, {"triangles", leaves.triangles()}};
  if (!leaves.shapeless.empty()) figures["without_shape"] = leaves.shapeless;
  job.figures.set("leaves", figures);
  return leaves;
}

std::vector<MeshLeaves> merged_leaves(const Recipe& recipe, const Leaves& leaves, std::vector<std::string>& warnings) {
  const FoliageScene& scene = leaves.scene;
  const std::vector<LeafRecipe> rules = rules_of(recipe);
  ImageFiles images(warnings);
  std::vector<MeshLeaves> parts(scene.materials.size());
  for (const FoliageInstance& leaf : scene.instances)
    append(scene.shapes[leaf.shape].sheet, leaf, parts[scene.shapes[leaf.shape].material]);
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (!parts[i].sheet.triangles.empty()) parts[i].material = mesh_material(rules[i], scene.materials[i], images);
  std::erase_if(parts, [](const MeshLeaves& part) { return part.sheet.triangles.empty(); });
  return parts;
}

}  // namespace cambium
