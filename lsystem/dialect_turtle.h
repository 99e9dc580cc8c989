// What the turtle commands of other dialects are to cpfg's turtle.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "lsystem/lsystem.h"
#include "lsystem/program.h"

namespace cambium {

/// Respells a string of another dialect from left to right, keeping what that dialect's turtle knows and cpfg's does not:
/// current lengths, angles and scales, which brackets save. Cost: linear.
class DialectTurtle {
 public:
  /// `names` are those of the string to be respelled. `seed` is what random turns of Houdini's `~` depend on, and their
  /// keys.
  DialectTurtle(const LSystemProgram& program, const TurtleOptions& options, const std::vector<std::string>& names,
                std::uint64_t seed);

  /// Appends what module `at` is: nothing, itself, or several.
  void respell(const Modules& in, std::size_t at, Modules& out);
  /// Of the symbols in what was appended. A symbol without a meaning in its dialect never gets one here.
  const std::vector<std::string>& names() const { return symbols_.names(); }

 private:
  enum class Command : std::uint8_t;
  struct State {
    double length, angle, width;  // angle in degrees
    double scale = 1;             // of L-Py's @D
    bool bends = false;           // by Houdini's T, with the next internode
  };

  static Command lpy_command(const std::string& name);
  static Command houdini_command(const std::string& name);

  double parameter_or(double fallback) const { return count_ > 0 ? parameters_[0] : fallback; }
  void append(std::uint16_t symbol, const double* begin, const double* end);
  void emit(const std::string& cpfg, std::initializer_list<double> parameters);
  void keep();
  void obey(Command command);
  void turn(const std::string& cpfg);
  void random_turn();
  void draw(const std::string& cpfg, double length);
  void set_width(double width);

  const bool houdini_;
  const HoudiniValues values_;
  SymbolTable symbols_;
  std::vector<Command> commands_;    // by symbol of the string
  std::vector<std::uint16_t> same_;  // the number of its name here
  const std::uint64_t seed_;
  State state_;
  std::vector<State> saved_;
  bool begun_ = false;

  // The module being respelled, and where to.
  const Modules* in_ = nullptr;
  std::size_t at_ = 0;
  const double* parameters_ = nullptr;
  std::size_t count_ = 0;
  Modules* out_ = nullptr;
};

}  // namespace cambium
