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
  /// `label` chooses among several in one file; unset: the first. `#include` is read relative to `file`.
  /// Errors: InputError with line and column (in bytes, of the file before preprocessing).
  static LSystem parse(std::string_view text, const std::filesystem::path& file,
                       const std::optional<std::string>& label = std::nullopt);
  static LSystem load(const std::filesystem::path& file, const std::optional<std::string>& label = std::nullopt);
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
  /// What the homomorphism needs of the derivation that made this: its seed, and the variables' last values.
  std::uint64_t seed = 0;
  std::vector<double> variables;
  std::size_t size() const { return symbol.size(); }
};

/// Rewrites the axiom in parallel steps, each followed by the decomposition. `*` deletes a module; a module that no production
/// matches stays; a module `%` deletes what follows it up to the end of its branch. Stochastic choices and draws are functions of
/// (seed, step, place in the string). One thread, so the same for any RunOptions::threads.
/// nullopt if cancelled. Errors: InputError at the expression that is not finite, at the production that passes max_modules, for
/// a negative weight, or if neither the file nor the options say how many steps.
std::optional<ModuleString> derive(const LSystem& system, const DeriveOptions& options, const RunOptions& run);

/// cpfg notation, parameters as %.9g.
std::string to_text(const ModuleString& string);

struct TurtleOptions {
  double step = 1;                         ///< metres of an F without parameter
  double angle = 0;                        ///< radians of + - & ^ \ / without parameter; 0: 90 degrees
  double width = 0.1;                      ///< diameter before the first ! or #, in width units
  double width_unit = 1;                   ///< metres; ABOP's figures give widths in pixels beside lengths in metres, say
  double width_factor = 0.70710678118654752;  ///< of a `!` without parameter; `#` divides by it. Default: halves the area
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

/// Walks the turtle over the string, after the homomorphism (lsystem.md, Turtle). F and G draw: one node at the end of each, and
/// a node without parent where a piece begins. A piece begins where the turtle was moved away (f, g, @M) from what it last drew;
/// pieces that begin at one unmoved start share its node. Nothing inside { } is drawn. An F of length 0 is skipped (counted as
/// "F(0)"). `lateral` is set: true for the first internode behind a `[`. `radius` and `base_radius` are half the width when
/// drawn, or the parent's radius if that is smaller (counted in radii_clamped).
/// @M(x,y,z) places, @R(hx,hy,hz[,ux,uy,uz]) orients; @Ts(e) and @T(e) set the elasticity, @Td(x,y,z) the tropism.
/// Errors: InputError (place: the file) for a negative length, a width of 0 or less, a position that is not finite, more nodes
/// than int32 counts, or an error of the homomorphism.
Turtled interpret(const ModuleString& string, const LSystem& system, const TurtleOptions& options);

}  // namespace cambium
