#include "cli/recipe_base.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cambium {
namespace {

const KeyRule<Prong> kProngKeys[] = {
    {"angle", [](const RecipeValue& v, Prong& p) { p.angle = v.degrees(); }},
    {"length", [](const RecipeValue& v, Prong& p) { p.length = v.number(0.01, 100); }},
};

/// Two at one angle would be one.
void require_apart(const RecipeValue& v, const std::vector<Prong>& prongs) {
  for (std::size_t i = 0; i < prongs.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (std::abs(std::remainder(prongs[i].angle - prongs[j].angle, 2 * std::numbers::pi)) < 1e-6) v.refuse("prongs at different angles");
}

/// How many, or a table for each.
void read_prongs(const RecipeValue& v, TrunkBase& base) {
  if (!v.is_array()) {
    base.count = static_cast<int>(v.integer(1, 64));
    return;
  }
  const auto tables = v.elements();
  if (tables.empty() || tables.size() > 64) v.refuse("1 to 64 prongs");
  for (const RecipeValue& table : tables) read_table(table, kProngKeys, base.prongs.emplace_back());
  require_apart(v, base.prongs);
}

const KeyRule<SurfaceRootOptions> kRootKeys[] = {
    {"length", [](const RecipeValue& v, SurfaceRootOptions& r) { r.length = std::min(v.not_negative_length(), 1e4); }},
    {"radius", [](const RecipeValue& v, SurfaceRootOptions& r) { r.radius = v.number(0.01, 1); }},
    {"taper", [](const RecipeValue& v, SurfaceRootOptions& r) { r.taper = v.number(0.01, 1); }},
    {"wander", [](const RecipeValue& v, SurfaceRootOptions& r) { r.wander = v.degrees(0, 170); }},
    {"rise", [](const RecipeValue& v, SurfaceRootOptions& r) { r.rise = v.number(-1, 1); }},
    {"depth", [](const RecipeValue& v, SurfaceRootOptions& r) { r.depth = std::min(v.not_negative_length(), 1e4); }},
    {"branches", [](const RecipeValue& v, SurfaceRootOptions& r) { r.branches = v.number(0, 100); }},
};

const KeyRule<TrunkBase> kBaseKeys[] = {
    {"height", [](const RecipeValue& v, TrunkBase& b) { b.height = v.positive_length(); }},
    {"spread", [](const RecipeValue& v, TrunkBase& b) { b.spread = v.number(0, 100); }},
    {"sharpness", [](const RecipeValue& v, TrunkBase& b) { b.sharpness = v.number(0, 0.95); }},
    {"section",
     [](const RecipeValue& v, TrunkBase& b) {
       constexpr FlareSection kSections[] = {FlareSection::kEnvelope, FlareSection::kQuadrifolium, FlareSection::kCircle};
       b.section = kSections[v.choice({"envelope", "quadrifolium", "circle"})];
     }},
    {"prongs", read_prongs},
    {"irregularity", [](const RecipeValue& v, TrunkBase& b) { b.irregularity = v.number(0, 1); }},
    {"roots", [](const RecipeValue& v, TrunkBase& b) { read_table(v, kRootKeys, b.roots); }},
    {"ground", [](const RecipeValue& v, TrunkBase& b) { b.ground = v.point(); }},
    {"up", [](const RecipeValue& v, TrunkBase& b) { b.up = v.direction(); }},
    {"below",
     [](const RecipeValue& v, TrunkBase& b) {
       constexpr BelowGround kBelow[] = {BelowGround::kKeep, BelowGround::kCut};
       b.below = kBelow[v.choice({"keep", "cut"})];
     }},
};

}  // namespace

TrunkBase read_trunk_base(const RecipeValue& table) {
  TrunkBase base;
  read_table(table, kBaseKeys, base);
  return base;
}

}  // namespace cambium
