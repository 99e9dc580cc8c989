#include "lsystem/dialect_turtle.h"

#include <numbers>
#include <unordered_map>
#include <utility>

#include "lsystem/counter_random.h"
#include "lsystem/turtle_actions.h"

namespace cambium {
namespace {

constexpr double kLpyAngle = 60;                          // degrees, where neither a module nor a recipe says
constexpr std::uint64_t kRandomTurnStage = 0x7e57'0001;   // tells their draws from the engine's

}  // namespace

enum class DialectTurtle::Command : std::uint8_t {
  kKeep, kDrop, kOpen, kClose,
  kDraw, kMove, kHalfDraw, kHalfMove, kDrawWithoutPoint,
  kYawLeft, kYawRight, kPitchDown, kPitchUp, kRollLeft, kRollRight, kHalfRoll, kRandomTurn, kLevel,
  kRadius, kThickerRadius, kSphereRadius, kSetScale, kMultiplyScale, kDivideScale, kTropism, kColor,  // L-Py
  kLonger, kShorter, kWiderAngle, kNarrowerAngle, kThicker, kThinner, kBend, kInstance                // Houdini
};

DialectTurtle::Command DialectTurtle::lpy_command(const std::string& name) {
  using enum Command;
  static const std::unordered_map<std::string_view, Command> kCommands = {
      {"[", kOpen},       {"]", kClose},      {"F", kDraw},        {"nF", kDraw},         {"f", kMove},
      {"+", kYawLeft},    {"-", kYawRight},   {"&", kPitchDown},   {"^", kPitchUp},       {"/", kRollLeft},
      {"\\", kRollRight}, {"iRollL", kRollLeft}, {"iRollR", kRollRight}, {"!", kRadius},  {"SetWidth", kRadius},
      {"_", kThickerRadius}, {"@O", kSphereRadius}, {"@D", kSetScale}, {"@Di", kMultiplyScale}, {"@Dd", kDivideScale},
      {"@Tp", kTropism},  {"SetColor", kColor}, {"|", kKeep},      {"@v", kKeep},         {"@M", kKeep},
      {"@R", kKeep},      {"{", kKeep},       {"}", kKeep},        {".", kKeep},          {";", kKeep},
      {",", kKeep},       {"%", kKeep},       {"@Ts", kKeep},      {"?P", kKeep},         {"?H", kKeep},
      {"?U", kKeep},      {"?L", kKeep},      {"@Gc", kDrop},      {"@Ge", kDrop}};
  const auto found = kCommands.find(name);
  if (found != kCommands.end()) return found->second;
  return name[0] == '~' || turtle_action(name) == TurtleAction::kSkip ? kKeep : kDrop;
}

DialectTurtle::Command DialectTurtle::houdini_command(const std::string& name) {
  using enum Command;
  static const std::unordered_map<std::string_view, Command> kCommands = {
      {"[", kOpen},       {"]", kClose},     {"F", kDraw},         {"f", kMove},          {"H", kHalfDraw},
      {"h", kHalfMove},   {"G", kDrawWithoutPoint}, {"+", kYawRight}, {"-", kYawLeft},    {"&", kPitchUp},
      {"^", kPitchDown},  {"\\", kRollRight}, {"/", kRollLeft},    {"*", kHalfRoll},      {"~", kRandomTurn},
      {"$", kLevel},      {"\"", kLonger},   {"_", kShorter},      {";", kWiderAngle},    {"@", kNarrowerAngle},
      {"!", kThicker},    {"?", kThinner},   {"T", kBend},         {"J", kInstance},      {"K", kInstance},
      {"M", kInstance},   {"|", kKeep},      {"{", kKeep},         {"}", kKeep},          {".", kKeep},
      {"%", kKeep}};
  const auto found = kCommands.find(name);
  if (found != kCommands.end()) return found->second;
  return turtle_action(name) == TurtleAction::kSkip ? kKeep : kDrop;
}

DialectTurtle::DialectTurtle(const LSystemProgram& program, const TurtleOptions& options,
                             const std::vector<std::string>& names, std::uint64_t seed)
    : houdini_(program.dialect == Dialect::kHoudini),
      values_(program.houdini),
      seed_(seed),
      state_{options.step, options.angle ? *options.angle * 180 / std::numbers::pi : kLpyAngle,
             options.width.value_or(TurtleOptions::kWidth)} {
  if (houdini_) state_ = {values_.step, values_.angle, values_.thickness};
  for (const std::string& name : names) {
    commands_.push_back(houdini_ ? houdini_command(name) : lpy_command(name));
    same_.push_back(symbols_.number(name));
  }
}

void DialectTurtle::append(std::uint16_t symbol, const double* begin, const double* end) {
  out_->symbol.push_back(symbol);
  out_->key.push_back(in_->key[at_]);
  out_->parameters.insert(out_->parameters.end(), begin, end);
  out_->first.push_back(static_cast<std::uint32_t>(out_->parameters.size()));
}

void DialectTurtle::emit(const std::string& cpfg, std::initializer_list<double> parameters) {
  append(symbols_.number(cpfg), parameters.begin(), parameters.end());
}

void DialectTurtle::keep() { append(same_[in_->symbol[at_]], parameters_, parameters_ + count_); }

void DialectTurtle::respell(const Modules& in, std::size_t at, Modules& out) {
  in_ = &in;
  at_ = at;
  parameters_ = in.parameters.data() + in.first[at];
  count_ = in.arity(at);
  out_ = &out;
  if (houdini_ && !begun_) emit("!", {state_.width});
  begun_ = true;
  obey(commands_[in.symbol[at]]);
}

void DialectTurtle::turn(const std::string& cpfg) { emit(cpfg, {parameter_or(state_.angle)}); }

// Of Houdini's `~`: as much as its parameter about each axis.
void DialectTurtle::random_turn() {
  CounterRandom random(seed_);
  random.move_to(kRandomTurnStage, in_->key[at_]);
  const double most = parameter_or(180);
  for (const char* turn : {"^", "/", "-"}) emit(turn, {most * (2 * random.uniform() - 1)});
}

void DialectTurtle::set_width(double width) {
  state_.width = width;
  emit("!", {width});
}

void DialectTurtle::draw(const std::string& cpfg, double length) {
  const bool own_width = count_ > 1 && parameters_[1] > 0;  // L-Py's cones may end in a point
  if (own_width) emit("!", {houdini_ ? parameters_[1] : 2 * parameters_[1] * state_.scale});
  emit(cpfg, {length});
  if (own_width && houdini_) emit("!", {state_.width});
  if (state_.bends) emit("@Ts", {0});
  state_.bends = false;
}

void DialectTurtle::obey(Command command) {
  const double length = parameter_or(state_.length) * state_.scale;
  switch (command) {
    case Command::kKeep: return keep();
    case Command::kDrop: return;
    case Command::kOpen:
      saved_.push_back(state_);
      return keep();
    case Command::kClose:
      if (!saved_.empty()) state_ = saved_.back(), saved_.pop_back();
      return keep();
    case Command::kDraw: return draw("F", length);
    case Command::kDrawWithoutPoint: return draw("G", length);
    case Command::kHalfDraw: return draw("F", length / 2);
    case Command::kMove: return emit("f", {length});
    case Command::kHalfMove: return emit("f", {length / 2});
    case Command::kYawLeft: return turn("+");
    case Command::kYawRight: return turn("-");
    case Command::kPitchDown: return turn("&");
    case Command::kPitchUp: return turn("^");
    case Command::kRollLeft: return turn("\\");
    case Command::kRollRight: return turn("/");
    case Command::kHalfRoll: return emit("/", {180});
    case Command::kRandomTurn: return random_turn();
    case Command::kLevel: return emit("$", {});
    case Command::kRadius: return count_ > 0 ? emit("!", {2 * parameters_[0] * state_.scale}) : emit("!", {});
    case Command::kThickerRadius: return count_ > 0 ? emit("#", {2 * parameters_[0] * state_.scale}) : emit("#", {});
    case Command::kSphereRadius: return count_ > 0 ? emit("@O", {2 * parameters_[0] * state_.scale}) : emit("@O", {});
    case Command::kSetScale:
      state_.scale = parameter_or(1);
      return;
    case Command::kMultiplyScale:
      state_.scale *= parameter_or(1);
      return;
    case Command::kDivideScale:
      state_.scale /= parameter_or(1);
      return;
    case Command::kTropism:
      if (count_ == 3) emit("@Td", {parameters_[0], parameters_[1], parameters_[2]});
      return;
    case Command::kColor: return count_ == 1 ? emit(";", {parameters_[0]}) : void();
    case Command::kLonger:
      state_.length *= parameter_or(values_.step_scale);
      return;
    case Command::kShorter:
      state_.length /= parameter_or(values_.step_scale);
      return;
    case Command::kWiderAngle:
      state_.angle *= parameter_or(values_.angle_scale);
      return;
    case Command::kNarrowerAngle:
      state_.angle /= parameter_or(values_.angle_scale);
      return;
    case Command::kThicker: return set_width(state_.width * parameter_or(values_.thickness_scale));
    case Command::kThinner: return set_width(state_.width / parameter_or(values_.thickness_scale));
    case Command::kBend:
      state_.bends = true;
      return emit("@Ts", {parameter_or(values_.gravity)});
    case Command::kInstance: return emit("~" + symbols_.names()[same_[in_->symbol[at_]]], {parameter_or(1)});
  }
}

}  // namespace cambium
