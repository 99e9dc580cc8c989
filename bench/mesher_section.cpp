// Our mesher against the straight OpenVDB pipeline on the same tree, at equal error by the same verifier; and a big tree.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "bench/mesher_run.h"
#include "bench/sections.h"

namespace cambium::bench {
namespace {

constexpr double kTolerances[] = {0.5e-3, 0.25e-3};   // metres; half the radius of the thinnest twig, and a quarter
constexpr double kFinestVoxel = 0.25e-3;  // an eighth of the thinnest twig
constexpr double kCoarsestVoxel = 8e-3;
constexpr double kCloseEnough = 1.08;     // voxels of the search are this near to each other in the end
constexpr int kRaces = 2;                 // of both meshers by turns, for the times

constexpr std::size_t kBigTree = 100'000;
constexpr double kBigTolerance = 1e-3;
constexpr double kBigMemory = 8e9;        // bytes

using Error = double (MesherRun::*)() const;

/// OpenVDB's runs by voxel: searches for different errors meet at the same ones.
class Runs {
 public:
  explicit Runs(double judged_at) : judged_at_(judged_at) {}

  const std::optional<MesherRun>& at(double voxel) {
    const auto [it, is_new] = runs_.try_emplace(voxel);
    std::optional<MesherRun>& run = it->second;
    if (is_new) {
      run = run_mesher({.mesher = "vdb", .size = voxel, .judged_at = judged_at_});
      if (run)
        fmt::print(stderr, "  voxel {:.3f} mm: {} triangles, max {:.3f} mm, 99.9 % {:.3f} mm, {:.1f} s, {:.2f} GB\n", 1e3 * voxel,
                   run->triangles, 1e3 * run->max(), 1e3 * run->p999(), run->seconds, 1e-9 * run->peak_bytes);
      else
        fmt::print(stderr, "  voxel {:.3f} mm: not enough memory\n", 1e3 * voxel);
    }
    return run;
  }

 private:
  double judged_at_;
  std::map<double, std::optional<MesherRun>> runs_;
};

struct Found {
  double voxel = 0;
  MesherRun run;
  bool reached = false;   ///< the error that was asked for
};

/// The coarsest voxel whose error is at most `error`. The finest that there is memory for if none is.
Found search_voxel(Runs& runs, Error error_of, double error) {
  Found best;
  // Down from a coarse grid, so that fine ones, which take gigabytes, are made only where they must be.
  double coarse = kCoarsestVoxel, voxel = std::clamp(2 * error, kFinestVoxel, kCoarsestVoxel);
  for (;; voxel = std::max(kFinestVoxel, voxel / 2)) {
    const auto& run = runs.at(voxel);
    if (!run) break;   // what is finer takes more
    best = {voxel, *run, ((*run).*error_of)() <= error};
    if (best.reached || voxel == kFinestVoxel) break;
    coarse = voxel;
  }
  double fine = voxel;   // reached there, or no memory for it
  while (fine < coarse && coarse / fine > kCloseEnough) {
    const double middle = std::sqrt(coarse * fine);
    const auto& run = runs.at(middle);
    if (run && ((*run).*error_of)() > error) {
      coarse = middle;
      if (!best.reached) best = {middle, *run, false};
    } else {
      fine = middle;
      if (run) best = {middle, *run, true};
    }
  }
  return best;
}

/// Times of both by turns, a round right after the other, so that what else the machine does falls on both.
void race(const MesherJob& one, MesherRun& run_one, const MesherJob& other, MesherRun& run_other) {
  for (int round = 0; round < kRaces; ++round) {
    for (const auto& [job, run] : {std::pair{&one, &run_one}, std::pair{&other, &run_other}}) {
      const auto again = run_mesher(*job);
      if (!again) continue;
      const auto least = [&](double MesherRun::*time) {
        (*run).*time = round == 0 ? (*again).*time : std::min((*run).*time, (*again).*time);
      };
      least(&MesherRun::seconds);
      least(&MesherRun::processor_seconds);
    }
  }
}

void add_run(Report& report, const std::string& name, const MesherRun& run, const MesherRun* ours) {
  const auto row = [&](const char* what, double figure, const char* unit, std::optional<double> of_ours = {}) {
    Row r{.what = name + ", " + what, .figure = figure, .unit = unit};
    if (of_ours) {
      const bool fewer = unit[0] == '\0';   // triangles
      r.ratio = fewer ? figure / *of_ours : *of_ours / figure;
      r.ratio_to = fewer ? "ours" : "that: ours";
      r.target = fewer ? at_least(8) : at_most(0.5);
    }
    report.add(r);
  };
  const auto of_ours = [&](auto figure) { return ours ? std::optional<double>(figure(*ours)) : std::nullopt; };
  row("triangles", static_cast<double>(run.triangles), "", of_ours([](const MesherRun& r) { return double(r.triangles); }));
  row("time", run.seconds, "s", of_ours([](const MesherRun& r) { return r.seconds; }));
  row("processor time", run.processor_seconds, "s", of_ours([](const MesherRun& r) { return r.processor_seconds; }));
  row("memory at most", run.peak_bytes / 1e6, "MB", of_ours([](const MesherRun& r) { return r.peak_bytes / 1e6; }));
  row("error, max", 1e3 * run.max(), "mm");
  row("error, 99.9 %", 1e3 * run.p999(), "mm");
  row("error, mean", 1e3 * run.mean(), "mm");
  for (const auto& [way, error] : {std::pair{"from the mesh", &run.to_surface}, std::pair{"from the surface", &run.from_surface}})
    report.note(fmt::format("{}: 99.9 % {:.3f} mm, max {:.3f} mm at ({:.5f}, {:.5f}, {:.5f})", way, 1e3 * error->p999, 1e3 * error->max,
                            error->x, error->y, error->z));
}

void against_vdb(Report& report, double tolerance) {
  report.heading(fmt::format("Meshes of a tree of 10^4 internodes within {:g} mm, thinnest twigs 2 mm across, 2 threads, each in its own process",
                             1e3 * tolerance));
  report.note(fmt::format("error: distances both ways, 2 million samples each, even over the mesh and over the surface, for both meshers "
                          "alike; surface in cracks narrower than {:g} mm does not count for either",
                          1e3 * tolerance));
  const MesherJob our_job{.mesher = "ours", .size = tolerance, .judged_at = tolerance};
  const auto ours = run_mesher(our_job);
  if (!ours) return report.note("there was not the memory for it");
  add_run(report, fmt::format("polygonize, {:g} mm", 1e3 * tolerance), *ours, nullptr);
  Runs runs(tolerance);
  const auto compare = [&](Error error, const char* what) {
    Found found = search_voxel(runs, error, ((*ours).*error)());
    if (found.voxel == 0) return report.note("there was not the memory for OpenVDB's");
    MesherRun ours_beside = *ours;
    race({.mesher = "ours", .size = tolerance}, ours_beside, {.mesher = "vdb", .size = found.voxel}, found.run);
    add_run(report, fmt::format("OpenVDB at {:.3g} mm", 1e3 * found.voxel), found.run, &ours_beside);
    report.note(found.reached
                    ? fmt::format("the coarsest voxel of that pipeline whose {} error is no larger than ours", what)
                    : fmt::format("the finest voxel tried: the pipeline does not reach our {} error, {:.3f} mm, there", what,
                                  1e3 * ((*ours).*error)()));
    report.note(fmt::format("times are the best of {} by turns; ours beside it took {:.2f} s, {:.2f} s of processors", kRaces,
                            ours_beside.seconds, ours_beside.processor_seconds));
  };
  compare(&MesherRun::p999, "99.9 %");
  compare(&MesherRun::max, "largest");
}

void big_tree(Report& report) {
  report.heading(fmt::format("A mesh of a tree of 10^5 internodes, thinnest twigs 2 mm across, within {:g} mm, 2 threads", 1e3 * kBigTolerance));
  const auto run = run_mesher({.mesher = "ours", .size = kBigTolerance, .internodes = kBigTree});
  if (!run) return report.note("there was not the memory for it");
  report.add({.what = "triangles", .figure = static_cast<double>(run->triangles) / 1e6, .unit = "million"});
  report.add({.what = "time", .figure = run->seconds, .unit = "s"});
  report.add({.what = "processor time", .figure = run->processor_seconds, .unit = "s"});
  report.add({.what = "memory at most", .figure = run->peak_bytes / 1e9, .unit = "GB", .target = at_most(kBigMemory / 1e9)});
}

}  // namespace

void mesher_section(Report& report, const Pace&) {
  for (const double tolerance : kTolerances) against_vdb(report, tolerance);
  big_tree(report);
}

}  // namespace cambium::bench
