// From a string of modules to a plant skeleton.
#include "lsystem/lsystem.h"
#include "lsystem/program.h"
#include "lsystem/rewriting_pass.h"
#include "lsystem/turtle.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace cambium {
namespace {

constexpr double kRadian = std::numbers::pi / 180.0;
// A turtle position counts as that of the last node within this part of its coordinates: `f(1)|f(1)` comes back to it but for rounding.
constexpr double kSamePlace = 1e-9;
constexpr int kTurnsBetweenRepairs = 64;

enum class Action {
  kSkip, kSilent, kDraw, kMove, kYawLeft, kYawRight, kPitchDown, kPitchUp, kRollLeft, kRollRight, kTurnBack, kLevel,
  kOpen, kClose, kPolygonOpen, kPolygonClose, kThinner, kThicker, kCut, kPlace, kOrient, kElasticity, kTropism, kCall,
  kAskPosition, kAskHeading, kAskUp, kAskLeft
};

Action action_of(std::string_view name) {
  static const std::unordered_map<std::string_view, Action> kActions = {
      {"F", Action::kDraw},       {"G", Action::kDraw},         {"f", Action::kMove},          {"g", Action::kMove},
      {"+", Action::kYawLeft},    {"-", Action::kYawRight},     {"&", Action::kPitchDown},     {"^", Action::kPitchUp},
      {"\\", Action::kRollLeft},  {"/", Action::kRollRight},    {"|", Action::kTurnBack},      {"$", Action::kLevel},
      {"@v", Action::kLevel},     {"[", Action::kOpen},         {"]", Action::kClose},         {"{", Action::kPolygonOpen},
      {"}", Action::kPolygonClose}, {".", Action::kSilent},     {"!", Action::kThinner},       {"#", Action::kThicker},
      {"%", Action::kCut},        {"@M", Action::kPlace},       {"@R", Action::kOrient},       {"@Ts", Action::kElasticity},
      {"@T", Action::kElasticity}, {"@Td", Action::kTropism},   {"?", Action::kCall},
      {"?P", Action::kAskPosition}, {"?H", Action::kAskHeading}, {"?U", Action::kAskUp},      {"?L", Action::kAskLeft}};
  const auto found = kActions.find(name);
  return found == kActions.end() ? Action::kSkip : found->second;
}

std::string number_text(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 9).ptr;
  return {text, end};
}

struct State {
  TurtleFrame frame;
  Vec3 position{0.0};
  double width = 0;
  double elasticity = 0;
  Vec3 tropism{0.0};
  std::int32_t node = -1;      // last drawn to; -1: nothing since the piece's start was set
  std::uint32_t start = 0;     // which unmoved start this piece has, see starts_
  int turns = 0;               // since the frame was last repaired
  bool lateral = false;        // the next internode is the first behind a bracket
};

// What the turtle says at queries, by the keys of their modules.
using Answers = std::unordered_map<std::uint64_t, Vec3>;

class Interpreter {
 public:
  Interpreter(const ModuleString& string, const std::string& file, const TurtleOptions& options, Answers* answers)
      : string_(string), file_(file), options_(options), answers_(answers), angle_(options.angle != 0 ? options.angle : std::numbers::pi / 2) {
    for (const std::string& name : string.names) actions_.push_back(action_of(name));
    skipped_.assign(string.names.size(), 0);
    state_.width = options.width;
    state_.elasticity = options.elasticity;
    state_.tropism = options.tropism;
    out_.last_width = options.width;
  }

  Turtled run() {
    for (index_ = 0; index_ < string_.size(); ++index_) obey(actions_[string_.symbol[index_]]);
    for (std::size_t i = 0; i < skipped_.size(); ++i)
      if (skipped_[i] > 0) out_.skipped[string_.names[i]] = skipped_[i];
    return std::move(out_);
  }

 private:
  std::size_t count() const { return string_.first[index_ + 1] - string_.first[index_]; }
  double parameter(std::size_t i) const { return string_.parameters[string_.first[index_] + i]; }
  double parameter_or(double fallback) const { return count() > 0 ? parameter(0) : fallback; }
  double length() const { return parameter_or(options_.step) * scale_; }
  double angle() const { return count() > 0 ? parameter(0) * kRadian : angle_; }
  void skip() { ++skipped_[string_.symbol[index_]]; }

  [[noreturn]] void fail(std::string found, std::string expected) const {
    throw InputError({file_, 0, 0}, std::move(found) + " in module " + std::to_string(index_ + 1) + " of the derived string",
                     std::move(expected));
  }

  void obey(Action action) {
    switch (action) {
      case Action::kSkip: return skip();
      case Action::kSilent: return;
      case Action::kDraw: return draw();
      case Action::kMove: return move(length());
      case Action::kYawLeft: return turn(&TurtleFrame::yaw, angle());
      case Action::kYawRight: return turn(&TurtleFrame::yaw, -angle());
      case Action::kPitchDown: return turn(&TurtleFrame::pitch, angle());
      case Action::kPitchUp: return turn(&TurtleFrame::pitch, -angle());
      case Action::kRollRight: return turn(&TurtleFrame::roll, angle());
      case Action::kRollLeft: return turn(&TurtleFrame::roll, -angle());
      case Action::kTurnBack: return state_.frame.turn_back();
      case Action::kLevel: return level_or_return();
      case Action::kCall: return call();
      case Action::kAskPosition: return answer(state_.position);
      case Action::kAskHeading: return answer(state_.frame.heading);
      case Action::kAskUp: return answer(state_.frame.up);
      case Action::kAskLeft: return answer(state_.frame.left);
      case Action::kOpen:
        stack_.emplace_back(state_, polygon_);
        state_.lateral = true;
        return;
      case Action::kClose:
        if (stack_.empty()) fail("a ']'", "a '[' before it");
        std::tie(state_, polygon_) = stack_.back();
        stack_.pop_back();
        return;
      case Action::kPolygonOpen:
        skip();
        ++polygon_;
        return;
      case Action::kPolygonClose:
        if (polygon_ > 0) --polygon_;
        return;
      case Action::kThinner: return set_width(parameter_or(state_.width * options_.width_factor));
      case Action::kThicker: return set_width(parameter_or(state_.width / options_.width_factor));
      case Action::kCut: return cut();
      case Action::kPlace:
        if (count() != 3) return skip();
        return place({parameter(0), parameter(1), parameter(2)});
      case Action::kOrient: return orient();
      case Action::kElasticity:
        if (count() == 0) return skip();
        state_.elasticity = parameter(count() - 1);
        return;
      case Action::kTropism:
        if (count() != 3) return skip();
        state_.tropism = {parameter(0), parameter(1), parameter(2)};
        return;
    }
  }

  void turn(void (TurtleFrame::*rotation)(double), double radians) {
    (state_.frame.*rotation)(radians);
    if (++state_.turns < kTurnsBetweenRepairs) return;
    state_.turns = 0;
    state_.frame.restore_orthonormality();
  }

  void answer(const Vec3& value) {
    if (!answers_ || count() != 3) return skip();
    answers_->emplace(string_.key[index_], value);
  }

  // `?(label)` and `?(label,scale)` up to their `$` are a sub-L-system's, whose lengths are scaled.
  void call() {
    if (count() == 0) return skip();
    callers_.push_back(scale_);
    if (count() > 1) scale_ *= parameter(1);
  }

  void level_or_return() {
    if (callers_.empty() || string_.names[string_.symbol[index_]] != "$") return state_.frame.level();
    scale_ = callers_.back();
    callers_.pop_back();
  }

  void set_width(double width) {
    if (!(width > 0) || !std::isfinite(width)) fail("a width of " + number_text(width), "a width above 0");
    state_.width = out_.last_width = width;
  }

  void orient() {
    const bool with_up = count() == 6;
    const Vec3 up = with_up ? Vec3(parameter(3), parameter(4), parameter(5)) : Vec3(0.0);
    if ((count() != 3 && !with_up) ||
        !state_.frame.orient({parameter(0), parameter(1), parameter(2)}, with_up ? &up : nullptr))
      skip();
  }

  // The rest of the branch: up to, not past, the ']' that closes it.
  void cut() {
    std::size_t depth = 0;
    while (index_ + 1 < string_.size()) {
      const Action next = actions_[string_.symbol[index_ + 1]];
      if (next == Action::kClose && depth == 0) return;
      if (next == Action::kOpen) ++depth;
      if (next == Action::kClose) --depth;
      ++index_;
    }
  }

  void check_position(const Vec3& p) const {
    // Half the range of a double, squared lengths included.
    if (!(std::abs(p.x) < 1e150 && std::abs(p.y) < 1e150 && std::abs(p.z) < 1e150))
      fail("a position beyond 1e150 m", "a turtle that stays within reach");
  }

  void place(const Vec3& position) {
    check_position(position);
    if (position == state_.position) return;
    state_.position = position;
    state_.start = static_cast<std::uint32_t>(starts_.size());
    starts_.push_back(-1);
  }

  void move(double length) { place(state_.position + length * state_.frame.heading); }

  bool stands_at(std::int32_t node) const {
    if (node < 0) return false;
    const Vec3& p = out_.skeleton.nodes[static_cast<std::size_t>(node)].position;
    return glm::length(p - state_.position) <= kSamePlace * (1.0 + glm::length(p));
  }

  std::int32_t add(const SkeletonNode& node) {
    if (out_.skeleton.nodes.size() >= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
      fail("more than 2147483647 nodes", "fewer derivation steps");
    out_.skeleton.nodes.push_back(node);
    return static_cast<std::int32_t>(out_.skeleton.nodes.size() - 1);
  }

  void draw() {
    const double length = this->length();
    if (polygon_ > 0) return move(length);
    if (length == 0) {
      ++out_.skipped["F(0)"];
      return;
    }
    if (length < 0) fail("a length of " + number_text(length), "a length of 0 or more");
    const Vec3 tip = state_.position + length * state_.frame.heading;
    check_position(tip);
    double radius = 0.5 * state_.width * options_.width_unit;
    bool lateral = state_.lateral;
    std::int32_t parent = state_.node;
    if (!stands_at(parent)) {
      parent = starts_[state_.start];
      if (!stands_at(parent)) {
        parent = add({state_.position, radius, -1, std::nullopt, std::nullopt});
        starts_[state_.start] = parent;
        lateral = false;
      }
    }
    const double parent_radius = out_.skeleton.nodes[static_cast<std::size_t>(parent)].radius;
    if (radius > parent_radius) {
      radius = parent_radius;
      ++out_.radii_clamped;
    }
    state_.node = add({tip, radius, parent, radius, lateral});
    state_.position = tip;
    state_.lateral = false;
    out_.total_length += length;
    state_.frame.bend(state_.tropism, state_.elasticity);
  }

  const ModuleString& string_;
  const std::string file_;
  const TurtleOptions& options_;
  Answers* const answers_;             // null: nobody asks
  const double angle_;
  std::vector<Action> actions_;        // by symbol
  std::vector<std::size_t> skipped_;   // by symbol
  std::size_t index_ = 0;
  State state_;
  int polygon_ = 0;                    // how deep in { }
  double scale_ = 1;                   // of lengths, by the sub-L-systems around
  std::vector<double> callers_;        // their callers' scales
  std::vector<std::pair<State, int>> stack_;
  // Node at each place where a piece can begin, -1 before one does: branches that all begin at the axiom's start, say, share it.
  std::vector<std::int32_t> starts_{-1};
  Turtled out_;
};

}  // namespace

namespace {

Turtled draw(const ModuleString& string, const LSystem& system, const TurtleOptions& options, Answers* answers) {
  const LSystemProgram& program = system.program();
  const std::string file = program.tables.files.empty() ? std::string() : program.tables.files[0];
  const auto has_homomorphism = [](const System& one) { return !one.homomorphism.empty(); };
  if (std::none_of(program.systems.begin(), program.systems.end(), has_homomorphism)) return Interpreter(string, file, options, answers).run();
  ModuleString drawn;
  RewritingPass pass(program, options.max_modules, {});
  pass.seed = program.main().homomorphism_seed.value_or(string.seed);
  if (string.variables.size() == pass.variables.size()) pass.variables = string.variables;
  pass.rewrite(string, Stage::kHomomorphism, drawn);
  drawn.names = program.symbols.names();
  return Interpreter(drawn, file, options, answers).run();
}

}  // namespace

Turtled interpret(const ModuleString& string, const LSystem& system, const TurtleOptions& options) {
  return draw(string, system, options, nullptr);
}

// What no rule of the homomorphism matches keeps its key.
void answer_queries(ModuleString& string, const LSystem& system, const TurtleOptions& options) {
  Answers answers;
  draw(string, system, options, &answers);
  for (std::size_t i = 0; i < string.size(); ++i) {
    if (string.names[string.symbol[i]][0] != '?' || string.arity(i) != 3) continue;
    const auto found = answers.find(string.key[i]);
    if (found == answers.end()) continue;
    for (glm::length_t axis = 0; axis < 3; ++axis)
      string.parameters[string.first[i] + static_cast<std::size_t>(axis)] = found->second[axis];
  }
}

}  // namespace cambium
