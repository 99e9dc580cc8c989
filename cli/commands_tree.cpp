// derive, grow, surface: from an input to its string, its skeleton, its BlobTree.
#include <cstdio>
#include <map>
#include <stdexcept>
#include <utility>

#include "blobtree/blobtree_json.h"
#include "cli/commands.h"
#include "cli/output_file.h"
#include "skeletons/skeleton_io.h"

namespace cambium {
namespace {

/// False if cancelled.
bool report_string(Job& job, const ModuleString& string, const LSystem& system) {
  std::vector<std::size_t> counts(string.names.size(), 0);
  for (const auto symbol : string.symbol) ++counts[symbol];
  std::map<std::string, std::size_t> symbols;
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] > 0) symbols[string.names[i]] += counts[i];
  const StageTimer timer(job.figures, "turtle");
  const auto turtled = interpret(string, system, job.recipe.skeleton.turtle, job.run);
  if (!turtled) return false;
  job.figures.set("modules", string.size());
  job.figures.set("symbols", symbols);
  job.figures.set("total_length", turtled->total_length);
  job.figures.set("last_width", turtled->last_width);
  job.figures.set("skipped_symbols", turtled->skipped);
  return true;
}

struct Derived {
  ModuleString string;
  std::string explanation;   ///< empty unless --explain asks for it
};

std::optional<Derived> derive_text(Job& job, const LSystem& system) {
  if (!job.line.explain) {
    auto string = derive_string(job, system);
    if (!string) return std::nullopt;
    return Derived{std::move(*string), {}};
  }
  const StageTimer timer(job.figures, "derive");
  auto step = explain_step(system, derive_options(job), job.run);
  if (!step) return std::nullopt;
  std::string text = to_text(*step);
  return Derived{std::move(step->after), std::move(text)};
}

}  // namespace

Outcome run_derive(Job& job) {
  if (job.source_kind != InputKind::kLSystem)
    throw InputError({job.source.string()}, "no L-system", "an L-system (.l .lpy), or a recipe with lsystem = \"...\"");
  std::optional<OutputFile> output;
  if (!job.line.output.empty()) output.emplace(job.line.output);
  const LSystem system = load_lsystem(job);
  const auto derived = derive_text(job, system);
  if (!derived) return Outcome::kInterrupted;
  if (output || !job.line.json) {
    const StageTimer timer(job.figures, "write");
    const std::string text = derived->explanation.empty() ? to_text(derived->string) + "\n" : derived->explanation;
    if (output)
      write_text(output->temporary(), text);
    else if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size())
      throw std::runtime_error("stdout cannot be written");
  }
  if ((output || job.line.json) && !report_string(job, derived->string, system)) return Outcome::kInterrupted;
  if (job.run.cancelled()) return Outcome::kInterrupted;
  if (output) output->commit();
  return Outcome::kDone;
}

Outcome run_grow(Job& job) {
  const std::string format = require_extension(job.line.output, {".skel.json", ".swc"});
  OutputFile output(job.line.output);
  const auto plant = grow_plant(job);
  if (!plant) return Outcome::kInterrupted;
  const StageTimer timer(job.figures, "write");
  write_skeleton(plant->skeleton, output.temporary(), format, plant->foliage);
  job.figures.set("nodes", plant->skeleton.nodes.size());
  if (!plant->foliage.organs.empty()) job.figures.set("organs", plant->foliage.organs.size());
  if (format == ".swc" && !plant->foliage.organs.empty()) job.warnings.push_back("the leaves are left out: a .swc has no place for them");
  if (job.run.cancelled()) return Outcome::kInterrupted;
  output.commit();
  return Outcome::kDone;
}

Outcome run_surface(Job& job) {
  require_extension(job.line.output, {".blob.json"});
  OutputFile output(job.line.output);
  const auto built = build_tree(job);
  if (!built) return Outcome::kInterrupted;
  const StageTimer timer(job.figures, "write");
  write_text(output.temporary(), to_json(built->tree));
  job.figures.set("nodes", built->tree.size());
  if (built->report) job.figures.set("internodes", built->report->internodes);
  if (job.run.cancelled()) return Outcome::kInterrupted;
  output.commit();
  return Outcome::kDone;
}

}  // namespace cambium
