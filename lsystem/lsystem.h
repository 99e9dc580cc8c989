// cpfg L-systems: parse, derive, interpret (spec: lsystem.md; Prusinkiewicz & Lindenmayer 1990, ABOP).
#pragma once

#include "blobtree/input_error.h"
#include "blobtree/run_options.h"
#include "lsystem/dialect.h"
#include "skeletons/foliage.h"
#include "skeletons/skeleton.h"

#include <cstdint>
#include <filesystem>
#include <functional>
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
  /// `label` chooses among several in one file; unset: the first. `#include` is read relative to `file`, and so are the curves
  /// of a model that calls func() (see curve.h) and its view file (see view.h).
  /// Errors: InputError with line and column (in bytes, of the file before preprocessing).
  static LSystem parse(std::string_view text, const std::filesystem::path& file,
                       const std::optional<std::string>& label = std::nullopt, Dialect dialect = Dialect::kCpfg);
  /// `dialect` unset: the file's extension tells.
  static LSystem load(const std::filesystem::path& file, const std::optional<std::string>& label = std::nullopt,
                      std::optional<Dialect> dialect = std::nullopt);
  const LSystemProgram& program() const { return *program_; }

 private:
  std::shared_ptr<const LSystemProgram> program_;
};

/// What is unset is the view file's, if there is one beside the model: see view_file.h.
struct TurtleOptions {
  static constexpr double kWidth = 0.1;

  double step = 1;                         ///< metres of an F without parameter
  std::optional<double> angle{};           ///< radians of + - & ^ \ / without parameter. Default: 90 degrees
  std::optional<double> width{};           ///< diameter before the first ! or #, in width units. Default: kWidth
  double width_unit = 1;                   ///< metres; ABOP's figures give widths in pixels beside lengths in metres, say
  std::optional<double> width_factor{};    ///< of a `!` without parameter; `#` divides by it. Default: halves the area
  std::optional<Vec3> tropism{};           ///< its length is its intensity. Default: down
  std::optional<double> elasticity{};      ///< default: 0
  std::size_t max_modules = 100'000'000;   ///< of the string that the homomorphism makes
};

struct DeriveOptions {
  std::optional<std::uint64_t> seed;       ///< overrides the file's
  std::optional<int> steps;                ///< overrides the file's derivation length
  std::size_t max_modules = 100'000'000;   ///< at most 4'000'000'000; there may be 8 parameters for each
  TurtleOptions turtle;                    ///< that answers queries
  /// Gets what the model's printf writes, from the calling thread; unset: it is dropped.
  std::function<void(std::string_view)> print;
};

/// Modules in a row, SoA: module i has parameters[first[i] .. first[i+1]). 14 bytes per module and 8 per parameter.
struct Modules {
  std::vector<std::uint16_t> symbol;
  std::vector<std::uint32_t> first;        ///< one more than there are modules
  std::vector<double> parameters;
  std::vector<std::uint64_t> key;          ///< the module's place in the tree: see lineage.h

  std::size_t size() const { return symbol.size(); }
  std::size_t arity(std::size_t module) const { return first[module + 1] - first[module]; }
};

/// A string of modules: symbol i is called names[symbol[i]].
struct ModuleString : Modules {
  std::vector<std::string> names;
  /// What the homomorphism needs of the derivation that made this: its seed, and the variables' last values.
  std::uint64_t seed = 0;
  std::vector<double> variables;
};

/// Rewrites the axiom in parallel steps. What a step's productions make is decomposed at once, depth first, contexts being those
/// of the string before the step. `*` deletes a module; a module that no production matches stays; a module `%` goes with all that
/// follows it in its branch. Between `?(n)` and `$` the L-system labelled n rewrites. A string with queries is interpreted before
/// each step and at the end: see answer_queries().
///
/// Stochastic choices and draws are functions of (seed, the module's key): they depend on the module's line of descent alone, so
/// an edited production changes the draws of what it makes and of nothing else.
///
/// Costs 15 to 60 ns of one thread per module of the result where each step doubles the string. Uses run.threads where no
/// production assigns to a variable of the L-system, calls srand or printf or has several modules for a predecessor, and the
/// string has no `%` and no `?(n)`; the result is the same for any number of them. Looks at run.cancel every few milliseconds.
/// nullopt if cancelled. Errors: InputError at the expression that is not finite, at the production that passes max_modules, for
/// a negative weight, or if neither the file nor the options say how many steps.
std::optional<ModuleString> derive(const LSystem& system, const DeriveOptions& options, const RunOptions& run);

/// One derivation step and where each module of its result comes from.
struct ExplainedStep {
  static constexpr std::uint32_t kStayed = 0xffffffff;
  struct Origin {
    std::uint32_t parent = 0;              ///< the module before the step that became, or made, this one
    std::uint32_t rule = kStayed;          ///< of the rules below: the production, or the decomposition's that made it last
  };
  ModuleString before, after;
  std::vector<Origin> origins;             ///< of each module of `after`
  std::vector<SourceLocation> rules;
};

/// The last of the steps that derive() would make. nullopt if cancelled. Errors: as derive(), and if there is no step.
std::optional<ExplainedStep> explain_step(const LSystem& system, const DeriveOptions& options, const RunOptions& run);

/// cpfg notation, parameters as %.9g.
std::string to_text(const ModuleString& string);
/// Of modules [begin, end).
std::string to_text(const ModuleString& string, std::size_t begin, std::size_t end);

/// A line for each run of modules that one rule made of one module: the rule's `file:line:column` (`stays`: none matched), what it
/// was applied to, and what it made, between tabs. A module of which nothing is left has a line with `-` and `*`; so have the
/// further modules of a predecessor of several.
std::string to_text(const ExplainedStep& step);

struct Turtled {
  Skeleton skeleton;                       ///< one internode per F, and those of generalized cylinders
  Foliage foliage;                         ///< outlines, named surfaces, spheres and discs
  double total_length = 0;                 ///< of all internodes, metres
  double last_width = 0;                   ///< the last width set
  std::map<std::string, std::size_t> skipped;  ///< symbols without meaning here, and of the view file what was not read; with counts
  std::size_t radii_clamped = 0;           ///< radii that rose towards the tip
};

/// Walks the turtle over the string, after the homomorphism (lsystem.md, Turtle). F and G draw: one node at the end of each, and
/// a node without parent where a piece begins. A piece begins where the turtle was moved away (f, g, @M) from what it last drew;
/// pieces that begin at one unmoved start share its node. An F of length 0 is skipped (counted as "F(0)"). `lateral` is set: true
/// for the first internode behind a `[`. `radius` and `base_radius` are half the width when drawn, or the parent's radius if that
/// is smaller (counted in radii_clamped).
///
/// Between { and }, whatever brackets are between them, F and f end in corners of an outline, `.` is one, G and g only move, and
/// nothing else is drawn; { } inside are outlines of their own. An outline is an organ in the frame of the turtle at its {, held
/// where the turtle stood; equal ones, also of different sizes, share a shape. One without an area is left out (counted as "}"),
/// as is one that is not closed (as "{"). ~x(s) and ~x(sx,sy,sz) place the surface x; @O(d) a sphere, @o(d) and @c(d) discs, of
/// the line's width if without parameter. Behind a surface the turtle goes on at its end point. `;` and `'` raise the colour or set
/// it, `,` lowers it, round after 255; it begins as 0 or the view file's.
///
/// @Gs, @Gc and @Ge, and { with a parameter of 1 to 4, draw internodes along a smooth curve: see generalized_cylinder.h. F and G
/// between them only move. @#(n) chooses the view file's contour n: see contour_file.h.
///
/// @M(x,y,z) places, @R(hx,hy,hz[,ux,uy,uz]) orients; @Ts(i,e), @Ts(e) and @T(e) set the elasticity, @Ti(i,e) raises it, @Td(i,e)
/// lowers it, both without e by the view file's increment; @Td(x,y,z) sets the tropism.
/// Looks at run.cancel every few milliseconds; only the homomorphism uses more than one thread. nullopt if cancelled.
/// Errors: InputError (place: the file) for a negative length, a width of 0 or less, a position that is not finite, more nodes
/// than int32 counts, outlines nested 100000 deep, or an error of the homomorphism.
std::optional<Turtled> interpret(const ModuleString& string, const LSystem& system, const TurtleOptions& options,
                                 const RunOptions& run);

/// Gives every module ?P, ?H, ?U and ?L of three parameters the turtle's position, heading, up or left vector where it stands.
/// False if cancelled; the string is then as it was. Errors: as interpret().
bool answer_queries(ModuleString& string, const LSystem& system, const TurtleOptions& options, const RunOptions& run);

}  // namespace cambium
