#include "lsystem/turtle_walk.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

namespace cambium {
namespace {

constexpr int kTurnsBetweenRepairs = 64;
constexpr std::size_t kLooksBetweenPolls = 1024;
constexpr std::size_t kMostOutlines = 100'000;
constexpr std::uint32_t kColors = 256;  // in cpfg's colour map
constexpr double kWidthFactor = 0.70710678118654752;  // halves the area
constexpr double kLeastWidth = 1e-7;                  // cpfg's, of ! without a parameter

template <class T>
T first_of(const std::optional<T>& first, const std::optional<T>& second, const T& otherwise) {
  return first ? *first : second.value_or(otherwise);
}

std::string number_text(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 9).ptr;
  return {text, end};
}

}  // namespace

TurtleWalk::TurtleWalk(const ModuleString& string, const std::string& file, const View& view, const TurtleOptions& options,
                       const RunOptions& run, TurtleAnswers* answers)
    : string_(string),
      file_(file),
      view_(view),
      options_(options),
      run_(run),
      answers_(answers),
      angle_(first_of(options.angle, view.settings.angle, std::numbers::pi / 2)),
      foliage_(view.surfaces) {
  for (const std::string& name : string.names) actions_.push_back(turtle_action(name));
  skipped_.assign(string.names.size(), 0);
  state_.width = first_of(options.width, view.settings.width, TurtleOptions::kWidth);
  state_.elasticity = first_of(options.elasticity, view.settings.elasticity, 0.0);
  state_.tropism = first_of(options.tropism, view.settings.tropism, Vec3(0, 0, -1));
  state_.color = view.settings.color;
  out_.last_width = state_.width;
}

std::optional<Turtled> TurtleWalk::walk() {
  for (index_ = 0; index_ < string_.size() && !cancelled(); ++index_) obey(actions_[string_.symbol[index_]]);
  drop_outlines(0);
  if (cancelled_) return std::nullopt;
  for (std::size_t i = 0; i < skipped_.size(); ++i)
    if (skipped_[i] > 0) out_.skipped[string_.names[i]] = skipped_[i];
  out_.skipped.insert(view_.skipped.begin(), view_.skipped.end());
  out_.radii_clamped = pen_.radii_clamped();
  out_.skeleton = std::move(pen_).take();
  out_.foliage = std::move(foliage_).take();
  return std::move(out_);
}

bool TurtleWalk::cancelled() {
  if (!cancelled_ && ++looks_ % kLooksBetweenPolls == 0) cancelled_ = run_.cancelled();
  return cancelled_;
}

void TurtleWalk::fail(std::string found, std::string expected) const {
  throw InputError({file_, 0, 0}, std::move(found) + " in module " + std::to_string(index_ + 1) + " of the derived string",
                   std::move(expected));
}

void TurtleWalk::obey(TurtleAction action) {
  switch (action) {
    case TurtleAction::kSkip: return skip();
    case TurtleAction::kDraw:
    case TurtleAction::kDrawBetween:
      draw();
      if (action == TurtleAction::kDraw) corner_of_step();
      return;
    case TurtleAction::kMove:
      move(length());
      return corner_of_step();
    case TurtleAction::kMoveBetween: return move(length());
    case TurtleAction::kPlace:
      if (count() != 3) return skip();
      return place({parameter(0), parameter(1), parameter(2)});
    case TurtleAction::kOrient: return orient();
    case TurtleAction::kYawLeft: return turn(&TurtleFrame::yaw, angle());
    case TurtleAction::kYawRight: return turn(&TurtleFrame::yaw, -angle());
    case TurtleAction::kPitchDown: return turn(&TurtleFrame::pitch, angle());
    case TurtleAction::kPitchUp: return turn(&TurtleFrame::pitch, -angle());
    case TurtleAction::kRollRight: return turn(&TurtleFrame::roll, angle());
    case TurtleAction::kRollLeft: return turn(&TurtleFrame::roll, -angle());
    case TurtleAction::kTurnBack:
      return grown_turn() == 1 ? state_.frame.turn_back() : state_.frame.yaw(std::numbers::pi * grown_turn());
    case TurtleAction::kLevel: return level_or_return();
    case TurtleAction::kElasticity:
      if (count() == 0) return skip();
      state_.elasticity = parameter(count() - 1);
      return;
    case TurtleAction::kStiffer: return stiffen(1);
    case TurtleAction::kTropismOrSofter: return set_tropism_or_soften();
    case TurtleAction::kThinner: return set_width(count() > 0 ? parameter(0) : next_width(-1));
    case TurtleAction::kThicker: return set_width(count() > 0 ? parameter(0) : next_width(1));
    case TurtleAction::kNextColor: return change_color(view_.settings.color_increment);
    case TurtleAction::kLastColor: return change_color(kColors - view_.settings.color_increment);
    case TurtleAction::kOpen: return open_bracket();
    case TurtleAction::kClose: return close_bracket();
    case TurtleAction::kCut: return cut();
    case TurtleAction::kCall: return call();
    case TurtleAction::kBraceOpen: return open_brace();
    case TurtleAction::kBraceClose: return close_brace();
    case TurtleAction::kCorner: return corner();
    case TurtleAction::kSurface: return surface();
    case TurtleAction::kSphere: return note(foliage_.add_sphere(site(), diameter()));
    case TurtleAction::kDisc: return note(foliage_.add_disc(site(), diameter()));
    case TurtleAction::kAxisStart:
      open_cylinder(GeneralizedCylinder(), false);
      return pass_control_point();
    case TurtleAction::kAxisPoint: return pass_control_point();
    case TurtleAction::kAxisEnd:
      pass_control_point();
      return close_cylinder();
    case TurtleAction::kAxisTangents: return set_tangents();
    case TurtleAction::kContour: return choose_contour();
    case TurtleAction::kAskPosition: return answer(state_.position);
    case TurtleAction::kAskHeading: return answer(state_.frame.heading);
    case TurtleAction::kAskUp: return answer(state_.frame.up);
    case TurtleAction::kAskLeft: return answer(state_.frame.left);
  }
}

void TurtleWalk::turn(void (TurtleFrame::*rotation)(double), double radians) {
  (state_.frame.*rotation)(radians * grown_turn());
  if (++state_.turns < kTurnsBetweenRepairs) return;
  state_.turns = 0;
  state_.frame.restore_orthonormality();
}

void TurtleWalk::orient() {
  const bool with_up = count() == 6;
  const Vec3 up = with_up ? Vec3(parameter(3), parameter(4), parameter(5)) : Vec3(0.0);
  if ((count() != 3 && !with_up) ||
      !state_.frame.orient({parameter(0), parameter(1), parameter(2)}, with_up ? &up : nullptr))
    skip();
}

void TurtleWalk::check_position(const Vec3& p) const {
  // Half the range of a double, squared lengths included.
  if (!(std::abs(p.x) < 1e150 && std::abs(p.y) < 1e150 && std::abs(p.z) < 1e150))
    fail("a position beyond 1e150 m", "a turtle that stays within reach");
}

void TurtleWalk::place(const Vec3& position) {
  check_position(position);
  if (position == state_.position) return;
  state_.position = position;
  pen_.lift(state_.pen);
}

void TurtleWalk::line(SkeletonPen::Place& pen, const AxisSample& from, const AxisSample& tip, double length) {
  check_position(tip.position);
  if (pen_.full()) fail("more than 2147483647 nodes", "fewer derivation steps");
  pen_.draw(pen, from, tip);
  out_.total_length += length;
}

void TurtleWalk::draw() {
  const double length = this->length();
  if (!outlines_.empty()) return move(length);
  if (length == 0) {
    ++out_.skipped["F(0)"];
    return;
  }
  if (length < 0) fail("a length of " + number_text(length), "a length of 0 or more");
  if (in_cylinder()) {  // its wood is the cylinder's
    move(length);
  } else {
    tie_to_cylinder();
    const Vec3 tip = state_.position + length * state_.frame.heading;
    line(state_.pen, {state_.position, radius()}, {tip, radius()}, length);
    state_.position = tip;
  }
  state_.frame.bend(state_.tropism, state_.elasticity * grown_turn());
}

void TurtleWalk::set_width(double width) {
  if (!(width > 0) || !std::isfinite(width)) fail("a width of " + number_text(width), "a width above 0");
  state_.width = out_.last_width = width;
}

double TurtleWalk::next_width(int steps_up) const {
  if (const auto increment = view_.settings.width_increment; increment && !options_.width_factor)
    return std::max(state_.width + steps_up * *increment, kLeastWidth);
  const double factor = options_.width_factor.value_or(kWidthFactor);
  return steps_up > 0 ? state_.width / factor : state_.width * factor;
}

void TurtleWalk::stiffen(double sign) {
  state_.elasticity += sign * (count() > 1 ? parameter(1) : view_.settings.elasticity_increment);
}

void TurtleWalk::set_tropism_or_soften() {
  if (count() != 3) return stiffen(-1);
  state_.tropism = {parameter(0), parameter(1), parameter(2)};
}

void TurtleWalk::change_color(std::uint32_t steps_up) {
  if (count() == 0) {
    state_.color = (state_.color + steps_up) % kColors;
  } else if (parameter(0) >= 0 && parameter(0) <= std::numeric_limits<std::int32_t>::max()) {
    state_.color = static_cast<std::uint32_t>(parameter(0));
  } else {
    skip();
  }
}

FoliageCollector::Site TurtleWalk::site() const {
  FoliageCollector::Site out;
  out.position = state_.position;
  out.left = state_.frame.left;
  out.heading = state_.frame.heading;
  out.up = state_.frame.up;
  out.node = pen_.nearest_node(state_.pen);
  out.color = state_.color;
  return out;
}

void TurtleWalk::note(FoliageCollector::Outcome outcome) {
  if (outcome == FoliageCollector::Outcome::kNothing) skip();
  if (outcome == FoliageCollector::Outcome::kCancelled) cancelled_ = true;
}

// `{` and `{(0)` enclose an outline; `{(1)` to `{(4)` a generalized cylinder: Hermite open, closed, B-spline open, closed.
void TurtleWalk::open_brace() {
  const double kind = parameter_or(0);
  if (kind == 0) return open_outline();
  if (!(kind >= 1 && kind < 5)) return skip();
  const int number = static_cast<int>(kind) - 1;
  using Curve = GeneralizedCylinder::Curve;
  open_cylinder(GeneralizedCylinder(number < 2 ? Curve::kHermite : Curve::kBSpline, number % 2 == 1), true);
}

void TurtleWalk::open_outline() {
  if (outlines_.size() >= kMostOutlines) fail("polygons nested deeper than 100000", "a '}' behind each '{'");
  outlines_.push_back({site(), {}});
}

// A `}` without parameter closes whatever was opened.
void TurtleWalk::close_brace() {
  if (!outlines_.empty()) return close_outline();
  in_cylinder() ? close_cylinder() : skip();
}

// As in cpfg a polygon has the colour in which it is closed.
void TurtleWalk::close_outline() {
  Outline& outline = outlines_.back();
  outline.site.color = state_.color;
  note(foliage_.add_outline(outline.site, outline.corners, run_));
  outlines_.pop_back();
}

void TurtleWalk::corner_of_step() {
  if (!outlines_.empty() || (in_cylinder() && cylinders_[state_.cylinder].steps_are_points)) corner();
}

void TurtleWalk::corner() {
  if (outlines_.empty()) {
    if (in_cylinder()) pass_control_point();
    return;
  }
  auto& [site, corners] = outlines_.back();
  const Vec3 from_site = state_.position - site.position;
  corners.push_back({glm::dot(from_site, site.left), glm::dot(from_site, site.heading), glm::dot(from_site, site.up)});
}

void TurtleWalk::drop_outlines(std::size_t kept) {
  if (outlines_.size() <= kept) return;
  out_.skipped["{"] += outlines_.size() - kept;
  outlines_.resize(kept);
}

// As in cpfg the turtle goes on at the surface's end.
void TurtleWalk::surface() {
  const std::string name = string_.names[string_.symbol[index_]].substr(1);
  const Vec3 told = count() < 3 ? Vec3(parameter_or(1)) : Vec3(parameter(0), parameter(1), parameter(2));
  const Vec3 stretch = scale_ * grown_size() * told;
  note(foliage_.add_surface(site(), name, stretch));
  const auto known = view_.surfaces.find(name);
  if (known == view_.surfaces.end()) return;
  const Vec3 end = stretch * known->second.end_point;
  const TurtleFrame& frame = state_.frame;
  place(state_.position + end.x * frame.left + end.y * frame.heading + end.z * frame.up);
}

double TurtleWalk::diameter() const {
  return grown_size() * (count() > 0 ? parameter(0) * scale_ : state_.width * options_.width_unit);
}

void TurtleWalk::open_cylinder(GeneralizedCylinder axis, bool steps_are_points) {
  OpenCylinder cylinder{std::move(axis), state_.pen, brackets_.size(), steps_are_points};
  if (!cylinder.axis.passes_its_points()) pen_.lift(cylinder.pen);
  state_.cylinder = cylinders_.open(std::move(cylinder), state_.cylinder);
}

/// The one that the turtle is in; in brackets, a branch of the one around them.
OpenCylinder& TurtleWalk::own_cylinder() {
  if (state_.cylinder == OpenCylinders::kNone) open_cylinder(GeneralizedCylinder(), false);
  state_.cylinder = cylinders_.branch(state_.cylinder, brackets_.size());
  return cylinders_[state_.cylinder];
}

void TurtleWalk::draw_stretch(OpenCylinder& cylinder, const AxisStretch& stretch) {
  for (std::size_t i = 1; i < stretch.size(); ++i)
    line(cylinder.pen, stretch[i - 1], stretch[i], glm::distance(stretch[i - 1].position, stretch[i].position));
}

ControlPoint TurtleWalk::control_point(const State& state) const {
  return {state.position, state.frame.heading, state.contour * radius(state), state.tangent_in, state.tangent_out};
}

void TurtleWalk::pass_control_point() {
  OpenCylinder& cylinder = own_cylinder();
  draw_stretch(cylinder, cylinder.axis.pass(control_point(state_)));
  state_.pen = cylinder.pen;  // branches grow from here
}

// A branch that leaves the cylinder around its brackets between two control points makes one of where it leaves.
void TurtleWalk::tie_to_cylinder() {
  if (state_.cylinder == OpenCylinders::kNone || in_cylinder()) return;
  OpenCylinder& around = cylinders_[state_.cylinder];
  const State& leaving = brackets_[around.depth].state;
  const bool goes_from_there = state_.pen.start == leaving.pen.start && leaving.pen.start != around.pen.start;
  if (!goes_from_there || !around.axis.passes_its_points() || pen_.node_at(leaving.pen, leaving.position) >= 0) return;
  draw_stretch(around, around.axis.pass(control_point(leaving)));
  pen_.start_at(leaving.pen, around.pen.node);
}

void TurtleWalk::close_cylinder() {
  OpenCylinder& cylinder = own_cylinder();
  for (const AxisStretch& stretch : cylinder.axis.close()) draw_stretch(cylinder, stretch);
  state_.pen = cylinder.pen;
  cylinders_.close(state_.cylinder);
  state_.cylinder = OpenCylinders::kNone;
}

void TurtleWalk::set_tangents() {
  if (count() == 0) return skip();
  state_.tangent_in = parameter(0);
  state_.tangent_out = parameter(count() > 1 ? 1 : 0);
}

void TurtleWalk::choose_contour() {
  state_.contour = 1;
  if (count() == 0) return;
  const double number = parameter(0);
  const auto known = view_.contours.find(number >= 0 && number < 1e9 ? static_cast<std::size_t>(number) : 0);
  if (known != view_.contours.end())
    state_.contour = known->second;
  else if (number != 0)
    skip();
}

void TurtleWalk::open_bracket() {
  brackets_.push_back({state_, outlines_.size(), cylinders_.size()});
  state_.pen.lateral = true;
}

void TurtleWalk::close_bracket() {
  if (brackets_.empty()) fail("a ']'", "a '[' before it");
  state_ = brackets_.back().state;
  drop_outlines(brackets_.back().outlines);
  cylinders_.shrink(brackets_.back().cylinders);
  brackets_.pop_back();
}

// The rest of the branch: up to, not past, the ']' that closes it.
void TurtleWalk::cut() {
  std::size_t depth = 0;
  while (index_ + 1 < string_.size() && !cancelled()) {
    const TurtleAction next = actions_[string_.symbol[index_ + 1]];
    if (next == TurtleAction::kClose && depth == 0) return;
    if (next == TurtleAction::kOpen) ++depth;
    if (next == TurtleAction::kClose) --depth;
    ++index_;
  }
}

// `?(label)` and `?(label,scale)` up to their `$` are a sub-L-system's, whose lengths are scaled.
void TurtleWalk::call() {
  if (count() == 0) return skip();
  callers_.push_back(scale_);
  if (count() > 1) scale_ *= parameter(1);
}

void TurtleWalk::level_or_return() {
  if (callers_.empty() || string_.names[string_.symbol[index_]] != "$") return state_.frame.level();
  scale_ = callers_.back();
  callers_.pop_back();
}

void TurtleWalk::answer(const Vec3& value) {
  if (!answers_ || count() != 3) return skip();
  answers_->emplace(string_.key[index_], value);
}

}  // namespace cambium
