#include "cli/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <new>

#include "cli/commands.h"
#include "cli/frames.h"
#include "cli/interrupt.h"
#include "cli/output_file.h"
#include "raytrace/aov.h"

namespace cambium {
namespace {

constexpr const char* kVersion = "cambium 0.1.0";
constexpr std::size_t kListedBranches = 12;  // of `info` on a terminal; --json lists all

void add_common(CLI::App& app, CommandLine& line) {
  app.add_option("INPUT", line.input,
                 "a recipe (.tree.toml), L-system (.l .lpy), skeleton (.skel.json .swc .csv) or BlobTree (.blob.json)")
      ->required();
  app.add_option("--threads", line.threads, "threads to use; 0: all")->check(CLI::Range(0, 4096));
  app.add_option("--seed", line.seed, "overrides the input's")->check(CLI::NonNegativeNumber);
  app.add_option("--lsystem", line.label, "which L-system of the file, by its label; else the first");
  app.add_option("--dialect", line.dialect, "that an L-system is written in: cpfg, lpy or houdini; by default .lpy is lpy, else cpfg")
      ->check(CLI::IsMember({"cpfg", "lpy", "houdini"}));
  app.add_option("--max-modules", line.max_modules, "an L-system's string may have so many; 100000000 by default")
      ->check(CLI::Range(1.0, 4e9));
  app.add_flag("--quiet", line.quiet, "print errors only");
  app.add_flag("--json", line.json, "one object of figures on stdout");
  app.add_flag("--no-leaves", line.no_leaves, "leave leaves and other organs out");
  app.add_option("--set", line.overrides, "key=value: overrides a recipe key, such as surface.lip=2 or prune.0.branch=3")
      ->allow_extra_args(false);
}

/// --step of the commands that make something of a tree as it grows.
void add_growth(CLI::App& app, CommandLine& line) {
  CLI::Option* step = app.add_option("--step", line.growth_step,
                 "an L-system as it grows: once for each so many derivation steps, such as 0.5, into numbered files");
  CLI::Option* frame = app.add_option("--frame", line.frame, "only this one of the numbered files, from 1")->check(CLI::Range(1, 9999));
  if (app.get_name() != "render") frame->needs(step);  // which has --turntable as well
}

CLI::App* add_command(CLI::App& app, CommandLine& line, Command command, const char* name, const char* what,
                      bool needs_output) {
  CLI::App* sub = app.add_subcommand(name, what);
  add_common(*sub, line);
  if (command != Command::kInfo) {
    CLI::Option* output = sub->add_option("-o,--output", line.output, "the file to write");
    if (needs_output) output->required();
  }
  sub->callback([&line, command, name] { line.command = command, line.command_name = name; });
  return sub;
}

void declare(CLI::App& app, CommandLine& line) {
  app.require_subcommand(1);
  app.set_version_flag("--version", kVersion);
  CLI::App* derive = add_command(app, line, Command::kDerive, "derive", "the derived string of an L-system", false);
  derive->add_option("--step", line.step, "derive only so many steps")->check(CLI::NonNegativeNumber);
  derive->add_flag("--explain", line.explain,
                   "instead of the string the last step: a line for each module before it, with the rule (file:line:column) and "
                   "what it made");
  add_growth(*add_command(app, line, Command::kGrow, "grow", "the skeleton only (.skel.json .swc)", true), line);
  add_command(app, line, Command::kSurface, "surface", "the BlobTree that it becomes (.blob.json)", true);
  CLI::App* eval = add_command(app, line, Command::kEval, "eval", "field and gradient at points (.csv)", true);
  eval->add_option("--points", line.points, "CSV of x,y,z rows, metres")->required();
  CLI::App* mesh = add_command(app, line, Command::kMesh, "mesh", "a closed triangle mesh (.obj .ply .stl .off .glb)", true);
  add_growth(*mesh, line);
  CLI::Option* voxel = mesh->add_option("--voxel", line.voxel, "edge of a cell, such as 2mm");
  mesh->add_option("--tolerance", line.tolerance, "largest distance from the surface, such as 0.5mm")->excludes(voxel);
  mesh->add_option("--min-sides", line.min_sides, "around the thinnest twig, at least: 4 to 64; 6 by default")->check(CLI::Range(4, 64));
  mesh->add_flag("--preview", line.preview, "a first look: 16 times the tolerance, thin twigs thickened, no occlusion");
  mesh->add_option("--max-triangles", line.max_triangles, "at most so many, such as 500k");
  mesh->add_option("--lod", line.lod,
                   "levels of detail, each of at most so many triangles, such as 1200k,50k,5k: all in one .glb, else a file each "
                   "(tree_lod0.obj ...)");
  mesh->add_flag("--verify", line.verify,
                 "measure every level: distance from the surface both ways, topology, self-intersections; what misses the "
                 "tolerance or is not sound is said on stderr, and the exit status stays 0");
  mesh->add_flag("--no-ao", line.no_ao, "leave ambient occlusion out");
  mesh->add_option("--up", line.up, "y or z (glTF is always y-up)");
  CLI::App* volume = add_command(app, line, Command::kVolume, "volume", "an OpenVDB grid (.vdb)", true);
  volume->add_option("--voxel", line.voxel, "edge of a voxel, such as 5mm");
  volume->add_option("--kind", line.kind, "sdf, field or fog");
  CLI::App* render = add_command(app, line, Command::kRender, "render", "a ray-traced still (.png .jpg .exr)", true);
  add_growth(*render, line);
  render->add_option("--size", line.size, "pixels, such as 768x1024");
  render->add_option("--samples", line.samples, "per pixel, as min..max such as 1..16; 16 alone: up to 16");
  render->add_option("--noise", line.noise,
                     "a pixel is done when the standard error of its brightness on the screen, 0 to 1, is below; 0.0175 by default");
  render->add_option("--bounces", line.bounces,
                     "surfaces that light may touch on its way to the one seen; 0: sun, sky and lamps alone; 1 by default");
  render->add_option("--crop", line.crop, "x0,y0,x1,y1: only these pixels of the whole picture, the last not included");
  render->add_option("--close-up", line.close_up, "of where this branch leaves its parent; cambium info lists the branches");
  render->add_option("--turntable", line.turntable, "so many pictures around the tree: tree.0001.png and on")->check(CLI::Range(1, 9999));
  render->add_option("--bits", line.bits, "of each channel of a .png: 8 or 16")->check(CLI::IsMember({8, 16}));
  render->add_option("--aov", line.aovs,
                     "auxiliary images, a list or all: " + aov_names() + "; layers of an .exr, files beside a .png")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_command(app, line, Command::kInfo, "info", "counts, bounds, radii, what conditioning did", false);
}

Outcome run_once(Job& job) {
  switch (job.line.command) {
    case Command::kDerive:
      return run_derive(job);
    case Command::kGrow:
      return run_grow(job);
    case Command::kSurface:
      return run_surface(job);
    case Command::kEval:
      return run_eval(job);
    case Command::kMesh:
      return run_mesh(job);
    case Command::kVolume:
      return run_volume(job);
    case Command::kRender:
      return run_render(job);
    case Command::kInfo:
      return run_info(job);
  }
  return Outcome::kDone;
}

Outcome run(Job& job) { return job.line.growth_step ? run_frames(job, run_once) : run_once(job); }

std::string text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void print_figures(const Job& job) {
  const CommandLine& line = job.line;
  const Json figures = job.figures.object();
  if (line.json) {
    std::printf("%s\n", figures.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    return;
  }
  if (line.quiet || (line.command == Command::kDerive && line.output.empty())) return;
  for (const auto& [key, value] : figures.items()) {
    if (key == "command") continue;
    if (!value.is_array() || key != "branches") {
      std::printf("%-18s %s\n", key.c_str(), text_of(value).c_str());
      continue;
    }
    std::printf("%-18s %zu\n", key.c_str(), value.size());
    for (std::size_t i = 0; i < std::min(value.size(), kListedBranches); ++i)
      std::printf("  %s\n", text_of(value[i]).c_str());
    if (value.size() > kListedBranches) std::printf("  ... (all with --json)\n");
  }
}

int fail(int status, std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  std::fprintf(stderr, "%s\n", text.c_str());
  return status;
}

int run_parsed(const CommandLine& line, const std::atomic<bool>& cancel) {
  try {
    Job job(line, cancel);
    const Outcome outcome = run(job);
    job.progress.clear();
    for (const std::string& warning : job.warnings) std::fprintf(stderr, "cambium: %s\n", warning.c_str());
    if (outcome == Outcome::kInterrupted) return fail(1, "cambium: interrupted");
    print_figures(job);
    if (std::fflush(stdout) != 0) return fail(1, "cambium: stdout cannot be written");
    return 0;
  } catch (const InputError& error) {
    if (!error.location().file.empty()) return fail(2, error.what());
    return fail(2, InputError({line.input}, error.found(), error.expected()).what());
  } catch (const std::bad_alloc&) {
    return fail(1, "cambium: out of memory");
  } catch (const std::exception& error) {
    return fail(1, std::string("cambium: ") + error.what());
  }
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CommandLine line;
  CLI::App app("Trees as implicit surfaces: from an L-system or a skeleton to a mesh, a volume and a still.", "cambium");
  declare(app, line);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    return fail(
        2, InputError({"cambium"}, "bad usage (" + std::string(error.what()) + ")", "what cambium --help shows").what());
  }
  return run_parsed(line, catch_interrupts());
}

}  // namespace cambium
