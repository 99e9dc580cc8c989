// Our mesher against the straight OpenVDB pipeline on the same tree, at equal error by the same verifier.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "bench/mesher_run.h"
#include "bench/sections.h"

namespace cambium::bench {
namespace {

constexpr double kTolerance = 0.5e-3;     // metres
constexpr double kFinestVoxel = 0.25e-3;  // an eighth of the thinnest twig: a finer grid of this tree takes tens of gigabytes
constexpr double kCoarsestVoxel = 8e-3;
constexpr double kCloseEnough = 1.08;     // voxels of the search are this near to each other in the end

struct Found {
  double voxel = 0;
  MesherRun run;
  bool reached = false;   ///< the error that was asked for
};

/// OpenVDB's runs by voxel: searches for different errors meet at the same ones.
class Runs {
 public:
  const MesherRun& at(double voxel) {
    const auto [it, is_new] = runs_.try_emplace(voxel);
    MesherRun& run = it->second;
    if (is_new) {
      run = run_mesher("vdb", voxel);
      fmt::print(stderr, "  voxel {:.3f} mm: {} triangles, max {:.3f} mm, 99.9 % {:.3f} mm, {:.1f} s\n", 1e3 * voxel, run.triangles,
                 1e3 * run.max, 1e3 * run.p999, run.seconds);
    }
    return run;
  }

 private:
  std::map<double, MesherRun> runs_;
};

/// The coarsest voxel whose error is at most `error`. The finest if none is.
Found search_voxel(Runs& runs, double MesherRun::*error_of, double error) {
  const auto run_at = [&](double voxel) {
    const MesherRun& run = runs.at(voxel);
    return Found{voxel, run, run.*error_of <= error};
  };
  // Down from a coarse grid, so that fine ones, which take gigabytes, are made only where they must be.
  Found fine = run_at(kCoarsestVoxel);
  double coarse = kCoarsestVoxel;
  while (!fine.reached && fine.voxel > kFinestVoxel) {
    coarse = fine.voxel;
    fine = run_at(std::max(kFinestVoxel, fine.voxel / 2));
  }
  while (fine.reached && coarse / fine.voxel > kCloseEnough) {
    const Found middle = run_at(std::sqrt(coarse * fine.voxel));
    if (middle.reached)
      fine = middle;
    else
      coarse = middle.voxel;
  }
  return fine;
}

void add_mesher(Report& report, const std::string& name, const MesherRun& run, const MesherRun* ours) {
  const auto row = [&](const char* what, double figure, const char* unit, std::optional<double> of_ours, double bound, bool at_least_bound) {
    Row r{.what = name + ", " + what, .figure = figure, .unit = unit};
    if (ours && of_ours) {
      r.ratio = at_least_bound ? figure / *of_ours : *of_ours / figure;
      r.ratio_to = at_least_bound ? "ours" : "ours over it";
      r.target = at_least_bound ? at_least(bound) : at_most(bound);
    }
    report.add(r);
  };
  const auto count = [](const MesherRun& r) { return static_cast<double>(r.triangles); };
  row("triangles", count(run), "", ours ? std::optional(count(*ours)) : std::nullopt, 8, true);
  row("time", run.seconds, "s", ours ? std::optional(ours->seconds) : std::nullopt, 0.5, false);
  row("memory at most", run.peak_bytes / 1e6, "MB", ours ? std::optional(ours->peak_bytes / 1e6) : std::nullopt, 0.5, false);
  row("error, max", 1e3 * run.max, "mm", std::nullopt, 0, false);
  row("error, 99.9 %", 1e3 * run.p999, "mm", std::nullopt, 0, false);
  row("error, mean", 1e3 * run.mean, "mm", std::nullopt, 0, false);
}

}  // namespace

void mesher_section(Report& report, const Pace&) {
  report.heading("Meshes of a tree of 10^4 internodes, thinnest twigs 2 mm across, 2 threads, each in its own process");
  const MesherRun ours = run_mesher("ours", kTolerance);
  add_mesher(report, fmt::format("polygonize, tolerance {:g} mm", 1e3 * kTolerance), ours, nullptr);
  Runs runs;
  const auto compare = [&](double MesherRun::*error, const char* what) {
    const Found found = search_voxel(runs, error, ours.*error);
    add_mesher(report, fmt::format("OpenVDB at {:.3g} mm", 1e3 * found.voxel), found.run, &ours);
    report.note(found.reached ? fmt::format("the coarsest voxel of that pipeline whose {} error is no larger", what)
                              : fmt::format("the finest voxel tried: the pipeline does not reach our {} error there", what));
  };
  compare(&MesherRun::max, "largest");
  compare(&MesherRun::p999, "99.9 %");
}

}  // namespace cambium::bench
