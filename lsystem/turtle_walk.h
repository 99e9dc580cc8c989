// The turtle's walk over a string of modules: what interpret() does after the homomorphism.
#pragma once

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "lsystem/foliage_collector.h"
#include "lsystem/growth_parts.h"
#include "lsystem/lsystem.h"
#include "lsystem/open_cylinders.h"
#include "lsystem/skeleton_pen.h"
#include "lsystem/turtle.h"
#include "lsystem/turtle_actions.h"
#include "lsystem/view.h"

namespace cambium {

/// What the turtle says at queries, by the keys of their modules.
using TurtleAnswers = std::unordered_map<std::uint64_t, Vec3>;

class TurtleWalk {
 public:
  /// `file` is where errors are said to be; `answers` null: nobody asks. All references outlive the walk.
  TurtleWalk(const ModuleString& string, const std::string& file, const View& view, const TurtleOptions& options,
             const RunOptions& run, TurtleAnswers* answers);

  /// New modules are drawn as far as they have grown. `parts` outlives the walk.
  void grow(const GrowthParts& parts) { parts_ = &parts; }

  /// Once. nullopt if cancelled. Errors: see interpret().
  std::optional<Turtled> walk();

 private:
  static constexpr double kRadian = std::numbers::pi / 180.0;

  /// What brackets save.
  struct State {
    TurtleFrame frame;
    Vec3 position{0.0};
    double width = 0;
    double elasticity = 0;
    Vec3 tropism{0.0};
    SkeletonPen::Place pen;
    std::uint32_t color = 0;
    double tangent_in = 1.2, tangent_out = 1.2;  // of generalized cylinders
    double contour = 1;                          // its radius, of the line's
    OpenCylinders::Number cylinder = OpenCylinders::kNone;
    int turns = 0;  // since the frame was last repaired
  };
  struct Bracket {
    State state;
    std::size_t outlines, cylinders;  // that were open
  };
  /// Between { and }: corners in the coordinates of the turtle at the {.
  struct Outline {
    FoliageCollector::Site site;
    std::vector<Vec3> corners;
  };

  std::size_t count() const { return string_.first[index_ + 1] - string_.first[index_]; }
  double parameter(std::size_t i) const { return string_.parameters[string_.first[index_] + i]; }
  double parameter_or(double fallback) const { return count() > 0 ? parameter(0) : fallback; }
  double length() const { return parameter_or(options_.step) * scale_ * grown_size(); }
  double grown_size() const { return parts_ ? parts_->size(index_) : 1; }
  double grown_turn() const { return parts_ ? parts_->turn(index_) : 1; }
  double angle() const { return count() > 0 ? parameter(0) * kRadian : angle_; }
  void skip() { ++skipped_[string_.symbol[index_]]; }
  bool cancelled();
  [[noreturn]] void fail(std::string found, std::string expected) const;

  void obey(TurtleAction action);
  void turn(void (TurtleFrame::*rotation)(double), double radians);
  void orient();
  void check_position(const Vec3& position) const;
  void place(const Vec3& position);
  void move(double length) { place(state_.position + length * state_.frame.heading); }
  void draw();
  void line(SkeletonPen::Place& pen, const AxisSample& from, const AxisSample& tip, double length);
  double radius() const { return radius(state_); }
  double radius(const State& state) const {
    return 0.5 * state.width * options_.width_unit * (parts_ ? parts_->width(index_) : 1);
  }
  void set_width(double width);
  double next_width(int steps_up) const;
  void change_color(std::uint32_t steps_up);
  FoliageCollector::Site site() const;
  void note(FoliageCollector::Outcome outcome);
  void open_brace();
  void open_outline();
  void close_brace();
  void close_outline();
  void corner();
  void corner_of_step();
  void drop_outlines(std::size_t kept);
  void surface();
  double diameter() const;
  bool in_cylinder() const { return cylinders_.hold(state_.cylinder, brackets_.size()); }
  void open_cylinder(GeneralizedCylinder axis, bool steps_are_points);
  OpenCylinder& own_cylinder();
  void draw_stretch(OpenCylinder& cylinder, const AxisStretch& stretch);
  ControlPoint control_point(const State& state) const;
  void pass_control_point();
  void tie_to_cylinder();
  void close_cylinder();
  void set_tangents();
  void choose_contour();
  void stiffen(double sign);
  void set_tropism_or_soften();
  void open_bracket();
  void close_bracket();
  void cut();
  void call();
  void level_or_return();
  void answer(const Vec3& value);

  const ModuleString& string_;
  const std::string& file_;
  const View& view_;
  const TurtleOptions& options_;
  const RunOptions& run_;
  TurtleAnswers* const answers_;
  const GrowthParts* parts_ = nullptr;  // null: all is full-grown
  const double angle_;
  std::vector<TurtleAction> actions_;  // by symbol
  std::vector<std::size_t> skipped_;   // by symbol
  std::size_t index_ = 0;              // of the module being obeyed
  std::size_t looks_ = 0;              // at modules, for polls of run_
  bool cancelled_ = false;
  State state_;
  SkeletonPen pen_;
  FoliageCollector foliage_;
  std::vector<Outline> outlines_;  // that are open; brackets do not close them
  OpenCylinders cylinders_;
  double scale_ = 1;             // of lengths, by the sub-L-systems around
  std::vector<double> callers_;  // their callers' scales
  std::vector<Bracket> brackets_;
  Turtled out_;
};

}  // namespace cambium
