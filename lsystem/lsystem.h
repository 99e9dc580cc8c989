// cpfg L-systems: parse, derive, interpret (spec: lsystem.md; Prusinkiewicz & Lindenmayer 1990, ABOP).
#pragma once

#include "blobtree/input_error.h"
#include "blobtree/run_options.h"
#include "skeletons/skeleton.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cambium {

struct LSystemProgram;  // private to lsystem/

/// A parsed L-system; immutable, shareable by threads.
class LSystem {
 public:
  /// Errors: InputError with line and column.
  static LSystem parse(std::string_view text, const std::filesystem::path& file);
  static LSystem load(const std::filesystem::path& file);
  const LSystemProgram& program() const { return *program_; }

 private:
  std::shared_ptr<const LSystemProgram> program_;
};

struct DeriveOptions {
  std::optional<std::uint64_t> seed;       ///< overrides the file's
  std::optional<int> steps;                ///< overrides the file's derivation length
  std::size_t max_modules = 100'000'000;
};

/// A string of modules, SoA: symbol i is names[symbol[i]] with parameters[first[i] .. first[i+1]).
struct ModuleString {
  std::vector<std::string> names;
  std::vector<std::uint16_t> symbol;
  std::vector<std::uint32_t> first;
  std::vector<double> parameters;
  std::size_t size() const { return symbol.size(); }
};

/// nullopt if cancelled. Errors: InputError when max_modules is passed or an expression divides by zero etc.
std::optional<ModuleString> derive(const LSystem& system, const DeriveOptions& options, const RunOptions& run);

/// cpfg notation, parameters as %.9g.
std::string to_text(const ModuleString& string);

struct TurtleOptions {
  double step = 1;                         ///< metres of an F without parameter
  double angle = 0;                        ///< radians of + - & ^ \ / without parameter; 0: the file's #define-free default 90 deg
  double width = 0.1;                      ///< metres (diameter) before the first ! or #
  Vec3 tropism{0, 0, -1};
  double elasticity = 0;
};

struct Turtled {
  Skeleton skeleton;                       ///< one internode per F
  double total_length = 0;                 ///< of F, metres
  double last_width = 0;                   ///< the last width set
  std::map<std::string, std::size_t> skipped;  ///< symbols without meaning here, with their counts
  std::size_t radii_clamped = 0;           ///< radii that rose towards the tip
};

Turtled interpret(const ModuleString& string, const LSystem& system, const TurtleOptions& options);

}  // namespace cambium
