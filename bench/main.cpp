// Prints one table of what the field costs on this machine, each figure beside the machine's own limit and the target that
// the project set itself.
#include <fmt/format.h>

#include <exception>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/mesher_run.h"
#include "bench/sections.h"

namespace cambium::bench {
namespace {

constexpr const char* kUsage =
    "usage: cambium_bench [--quick] [--json FILE] [--only SECTION]...\n"
    "  --quick         shorter measurements and smaller trees: ratios are then rough\n"
    "  --json FILE     writes the table's rows there too\n"
    "  --only SECTION  batches, nodes, poplar, trees, lsystems, graphs, rays, or mesher, which takes minutes and runs only where it is named\n";

struct Arguments {
  bool quick = false;
  std::string json;
  std::vector<std::string> only;
};

struct Section {
  const char* name;
  void (*run)(Report&, const Pace&);
  bool always = true;   ///< not only where it is named
};
constexpr Section kSections[] = {
    {"batches", batch_section}, {"nodes", node_section}, {"poplar", poplar_section}, {"trees", trees_section},
    {"lsystems", lsystem_section}, {"graphs", graphs_section}, {"rays", rays_section},       {"mesher", mesher_section, false}};

/// False, with a line on the error stream, if there is something wrong with them.
bool read_arguments(int count, char** words, Arguments& arguments) {
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const bool takes_value = word == "--json" || word == "--only";
    if (takes_value && i + 1 == count) {
      fmt::print(stderr, "cambium_bench: {} needs a value\n{}", word, kUsage);
      return false;
    }
    if (word == "--quick")
      arguments.quick = true;
    else if (word == "--json")
      arguments.json = words[++i];
    else if (word == "--only")
      arguments.only.emplace_back(words[++i]);
    else {
      fmt::print(stderr, "cambium_bench: found '{}'\n{}", word, kUsage);
      return false;
    }
  }
  for (const std::string& name : arguments.only) {
    bool known = false;
    for (const Section& section : kSections) known = known || name == section.name;
    if (!known) {
      fmt::print(stderr, "cambium_bench: there is no section '{}'\n{}", name, kUsage);
      return false;
    }
  }
  return true;
}

int run(const Arguments& arguments) {
  const Pace pace = arguments.quick ? Pace{4, 0.005, 100'000, 2} : Pace{};
  Report report;
  for (const Section& section : kSections) {
    bool wanted = arguments.only.empty() && section.always;
    for (const std::string& name : arguments.only) wanted = wanted || name == section.name;
    if (!wanted) continue;
    fmt::print(stderr, "measuring: {}\n", section.name);
    section.run(report, pace);
  }
  fmt::print("{}", report.table());
  if (report.missed() > 0)
    fmt::print("\n{} of {} targets missed\n", report.missed(), report.judged());
  else
    fmt::print("\nall {} targets met\n", report.judged());
  if (!arguments.json.empty()) {
    std::ofstream file(arguments.json);
    file << report.json();
    if (!file.flush()) throw std::runtime_error("cannot write " + arguments.json);
  }
  return 0;
}

}  // namespace
}  // namespace cambium::bench

int main(int count, char** words) {
  if (count == 2 && std::string(words[1]) == "--help") {
    fmt::print("{}", cambium::bench::kUsage);
    return 0;
  }
  const bool is_child = count > 1 && std::string(words[1]) == "--measure-mesher";   // of this program itself
  cambium::bench::Arguments arguments;
  if (!is_child && !cambium::bench::read_arguments(count, words, arguments)) return 2;
  try {
    if (is_child) {
      cambium::bench::measure_mesher(count - 2, words + 2);
      return 0;
    }
    return cambium::bench::run(arguments);
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "cambium_bench: not enough memory\n");
    return cambium::bench::kOutOfMemory;
  } catch (const std::exception& error) {
    fmt::print(stderr, "cambium_bench: {}\n", error.what());
    return 1;
  }
}
