// Derivation of strings of ten million modules, their memory, and the skeleton that becomes of them.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include "bench/clock.h"
#include "bench/process_figures.h"
#include "bench/sections.h"
#include "blobtree/geometry.h"
#include "lsystem/lsystem.h"

namespace cambium::bench {
namespace {

constexpr int kRounds = 3;  // the best of each counts
constexpr double kModulesPerSecond =
    5e6;  // the issue's: of the final string, per second of one core, however many steps it took
constexpr double kBytesPerModule = 24;

struct Model {
  const char* what;
  const char* text;
  int steps, quick_steps;
  bool is_drawn;
};

constexpr Model kModels[] = {
    {"parametric and bracketed (ABOP 2.6 a)",
     "#define r1 0.9\n#define r2 0.6\n#define a0 45\n#define a2 45\n#define d 137.5\n#define wr 0.707\n"
     "lsystem: honda\naxiom: A(1,10)\n"
     "A(l,w) : * --> !(w)F(l)[&(a0)B(l*r2,w*wr)]/(d)A(l*r1,w*wr)\n"
     "B(l,w) : * --> !(w)F(l)[-(a2)$C(l*r2,w*wr)]C(l*r1,w*wr)\n"
     "C(l,w) : * --> !(w)F(l)[+(a2)$B(l*r2,w*wr)]B(l*r1,w*wr)\nendlsystem\n",
     21, 17, true},
    {"stochastic, with draws in parameters",
     "lsystem: drawn\naxiom: A(1)\n"
     "A(l) --> F(l)[+(20+ran(10))A(l*0.9)]/(137.5+nran(0,3))A(l*0.95) : 0.5\n"
     "A(l) --> F(l)[-(20+ran(10))A(l*0.9)]/(137.5+nran(0,3))A(l*0.95) : 0.5\nendlsystem\n",
     21, 17, false},
    {"with contexts: a signal through a growing tree",
     "lsystem: signal\nignore: +-\naxiom: S(1)A(19)\n"
     "A(n) : n > 0 --> I(0)[+I(0)A(n-1)][-I(0)A(n-1)]\n"
     "S(x) < I(y) --> I(y+x)\nI(x) < I(y) : x > 0 --> I(x)\nendlsystem\n",
     20, 16, false},
};

double bytes_per_module(const ModuleString& string) {
  const auto bytes = [](const auto& array) { return array.capacity() * sizeof(array[0]); };
  return static_cast<double>(bytes(string.symbol) + bytes(string.first) + bytes(string.key)) /
         static_cast<double>(string.size());
}

ModuleString derived(const LSystem& system, int steps, int threads) {
  DeriveOptions options;
  options.steps = steps;
  options.seed = 1;
  RunOptions run;
  run.threads = threads;
  auto string = derive(system, options, run);
  if (!string) throw std::logic_error("a derivation that nothing cancels was cancelled");
  return std::move(*string);
}

bool same(const ModuleString& a, const ModuleString& b) {
  return a.symbol == b.symbol && a.first == b.first && a.parameters == b.parameters && a.key == b.key;
}

void add_drawing(Report& report, const LSystem& system, const ModuleString& string) {
  double seconds = 0;
  const Turtled turtled = timed(seconds, [&] { return *interpret(string, system, {}, {}); });
  report.add(
      {.what = fmt::format("  turtle, {:.1f} million internodes", static_cast<double>(turtled.skeleton.nodes.size()) / 1e6),
       .figure = seconds,
       .unit = "s"});
}

void add_model(Report& report, const Model& model, bool quick) {
  const LSystem system = LSystem::parse(model.text, "bench.l");
  const int steps = quick ? model.quick_steps : model.steps;
  double one = kInfinity, one_wall = kInfinity, two_wall = kInfinity;
  ModuleString string;
  reset_peak_resident_bytes();
  const auto before = static_cast<double>(resident_bytes());
  double peak = 0;
  bool equal = true;
  for (int round = 0; round < kRounds; ++round) {
    double wall = 0;
    const double begin = processor_seconds_now();
    string = {};
    string = timed(wall, [&] { return derived(system, steps, 1); });
    one = std::min(one, processor_seconds_now() - begin);
    one_wall = std::min(one_wall, wall);
    if (round == 0) peak = static_cast<double>(peak_resident_bytes()) - before;
    const ModuleString other = timed(wall, [&] { return derived(system, steps, 2); });
    two_wall = std::min(two_wall, wall);
    equal = equal && same(string, other);
  }
  const auto modules = static_cast<double>(string.size());
  report.add({.what = fmt::format("{}: {:.1f} million modules in {} steps", model.what, modules / 1e6, steps),
              .figure = modules / one / 1e6,
              .unit = "M modules/s",
              .target = at_least(kModulesPerSecond / 1e6)});
  report.add({.what = "  with two threads",
              .figure = modules / two_wall / 1e6,
              .unit = "M modules/s",
              .ratio = two_wall / one_wall,
              .ratio_to = "one thread's time"});
  report.add({.what = "  without parameters",
              .figure = bytes_per_module(string),
              .unit = "B/module",
              .target = at_most(kBytesPerModule)});
  report.add({.what = "  most memory while deriving", .figure = peak / modules, .unit = "B/module"});
  if (!equal) report.note("  TWO THREADS MADE ANOTHER STRING THAN ONE");
  if (model.is_drawn) add_drawing(report, system, string);
}

}  // namespace

void lsystem_section(Report& report, const Pace& pace) {
  const bool quick = pace.largest_tree < Pace{}.largest_tree;
  report.heading("L-systems: modules of the final string per second of derivation, processor time of one thread");
  for (const Model& model : kModels) add_model(report, model, quick);
}

}  // namespace cambium::bench
