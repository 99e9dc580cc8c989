// What a planned tree grows by: lifespan, thickness, and what edges cost.
#include "cli/recipe_graph_tables.h"

namespace cambium {
namespace {

// ---- [lifespan] ------------------------------------------------------------------------------------------------
const KeyRule<LifespanOutcome> kOutcomeKeys[] = {
    {"probability", [](const RecipeValue& v, LifespanOutcome& o) { o.probability = v.positive(); }},
    {"low", [](const RecipeValue& v, LifespanOutcome& o) { o.low = v.number(0, 1e6); }},
    {"high", [](const RecipeValue& v, LifespanOutcome& o) { o.high = v.number(0, 1e6); }},
    {"relative", [](const RecipeValue& v, LifespanOutcome& o) { o.relative = v.flag(); }},
};

std::vector<LifespanOutcome> read_outcomes(const RecipeValue& array) {
  std::vector<LifespanOutcome> outcomes;
  for (const RecipeValue& element : array.elements()) {
    read_table(element, kOutcomeKeys, outcomes.emplace_back());
    if (outcomes.back().low > outcomes.back().high) element.refuse("low not above high");
  }
  if (outcomes.empty()) array.refuse("one outcome at least");
  return outcomes;
}

/// By name, or a table of outcomes.
void read_rule(const RecipeValue& v, Lifespan& l) {
  if (v.is_array())
    l.outcomes = read_outcomes(v);
  else
    l.outcomes = v.choice({"constant", "30/70"}) == 0 ? Lifespan{}.outcomes : Lifespan::thirty_seventy();
}

const KeyRule<Lifespan> kLifespanKeys[] = {
    {"L", [](const RecipeValue& v, Lifespan& l) { l.initial = v.number(0, 1000); }},
    {"rule", read_rule},
    {"sizes", [](const RecipeValue& v, Lifespan& l) { l.sizes = v.flag(); }},
};

// ---- [thickness] -----------------------------------------------------------------------------------------------
const KeyRule<GraphThickness> kThicknessKeys[] = {
    {"rule",
     [](const RecipeValue& v, GraphThickness& t) {
       t.rule = v.choice({"path", "pipe"}) == 0 ? ThicknessRule::kPath : ThicknessRule::kPipe;
     }},
    {"trunk_radius", [](const RecipeValue& v, GraphThickness& t) { t.trunk_radius = v.positive_length(); }},
    {"tip_radius", [](const RecipeValue& v, GraphThickness& t) { t.tip_radius = v.positive_length(); }},
    {"e", [](const RecipeValue& v, GraphThickness& t) { t.exponent = v.positive(); }},
    {"unit", [](const RecipeValue& v, GraphThickness& t) { t.unit = v.positive_length(); }},
    {"every_level", [](const RecipeValue& v, GraphThickness& t) { t.every_level = v.flag(); }},
};

// ---- [weights] -------------------------------------------------------------------------------------------------
const KeyRule<WeightBall> kBallKeys[] = {
    {"center", [](const RecipeValue& v, WeightBall& b) { b.center = v.point(); }},
    {"radius", [](const RecipeValue& v, WeightBall& b) { b.radius = v.positive_length(); }},
    {"factor", [](const RecipeValue& v, WeightBall& b) { b.factor = v.positive(); }},
};

void read_balls(const RecipeValue& v, GraphRecipe& g) {
  for (const RecipeValue& element : v.elements()) read_table(element, kBallKeys, g.weight_balls.emplace_back());
}

void read_highest(const RecipeValue& v, GraphRecipe& g) {
  g.options.weight_high = v.positive();
  if (g.options.weight_high < g.options.weight_low) v.refuse("a number of at least " + std::to_string(g.options.weight_low) + ", the low");
}

// In this order: high is checked against low.
const KeyRule<GraphRecipe> kWeightKeys[] = {
    {"low", [](const RecipeValue& v, GraphRecipe& g) { g.options.weight_low = v.number(0, 1e6); }},
    {"high", read_highest},
    {"times_length", [](const RecipeValue& v, GraphRecipe& g) { g.options.weight_times_length = v.flag(); }},
    {"ball", read_balls},
    {"volume", [](const RecipeValue& v, GraphRecipe& g) { g.weight_volume = {v.file(), v.location()}; }},
};

}  // namespace

void read_lifespan(const RecipeValue& table, Lifespan& lifespan) { read_table(table, kLifespanKeys, lifespan); }
void read_thickness(const RecipeValue& table, GraphThickness& thickness) { read_table(table, kThicknessKeys, thickness); }
void read_weights(const RecipeValue& table, GraphRecipe& graph) { read_table(table, kWeightKeys, graph); }

void add_lifespan_keys(const std::string& prefix, KeySet& keys) {
  add_keys(prefix, kLifespanKeys, keys);
  add_keys(prefix + "rule.", kOutcomeKeys, keys);
}

void add_thickness_keys(const std::string& prefix, KeySet& keys) { add_keys(prefix, kThicknessKeys, keys); }

void add_weight_keys(const std::string& prefix, KeySet& keys) {
  add_keys(prefix, kWeightKeys, keys);
  add_keys(prefix + "ball.", kBallKeys, keys);
}

}  // namespace cambium
