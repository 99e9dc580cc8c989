#include "bench/mesher_run.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <new>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "bench/clock.h"
#include "bench/generated_trees.h"
#include "bench/process_figures.h"
#include "bench/vdb_pipeline.h"
#include "polygonize/polygonize.h"
#include "polygonize/verify.h"
#include "skeletons/surface.h"

namespace cambium::bench {
namespace {

constexpr double kThinnestRadius = 0.001;
constexpr int kThreads = 2;
constexpr std::size_t kSamples = 2'000'000;   // each way, on either mesh alike

Field make_field(std::size_t internodes) {
  Skeleton skeleton = random_tree(internodes, 5);
  double thinnest = skeleton.nodes.front().radius;
  for (const auto& node : skeleton.nodes) thinnest = std::min(thinnest, node.radius);
  const double scale = kThinnestRadius / thinnest;
  for (auto& node : skeleton.nodes) {
    node.position *= scale;
    node.radius *= scale;
  }
  SurfaceOptions options;
  options.lip = 1.5;
  return Field(surface(skeleton, options).tree);
}

[[noreturn]] void end_out_of_memory() { ::_exit(kOutOfMemory); }

/// To three quarters of what the machine has: a mesh that takes more ends this process, not those beside it. At once, as libraries
/// throw where nobody catches.
void limit_memory() {
  std::set_new_handler(end_out_of_memory);
  rlimit limit{};
  ::getrlimit(RLIMIT_AS, &limit);
  const rlim_t most = static_cast<rlim_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) / 4 * 3;
  limit.rlim_cur = std::min(limit.rlim_max, most);
  ::setrlimit(RLIMIT_AS, &limit);
}

/// `made` is called when the mesh is there.
Mesh make_mesh(const Field& field, const MesherJob& job, const std::function<void()>& made) {
  if (job.mesher == "vdb") return vdb_pipeline(field, job.size, kThreads, made);
  if (job.mesher != "ours") throw std::runtime_error("no mesher '" + job.mesher + "'");
  PolygonizeOptions options;
  options.tolerance = job.size;
  RunOptions run;
  run.threads = kThreads;
  Mesh mesh = std::move(polygonize(field, options, run)->mesh);
  made();
  return mesh;
}

WayError way_error(const DistanceFigures& d) { return {d.max, d.p999, d.mean, d.max_at.x, d.max_at.y, d.max_at.z}; }

/// The numbers of a run, in the order in which they are written and read.
template <class Run, class Each>
void each_number(Run& run, const Each& each) {
  each(run.triangles), each(run.seconds), each(run.processor_seconds), each(run.peak_bytes), each(run.in_cracks);
  for (auto* way : {&run.to_surface, &run.from_surface}) {
    each(way->max), each(way->p999), each(way->mean);
    each(way->x), each(way->y), each(way->z);
  }
}

}  // namespace

double MesherRun::max() const { return std::max(to_surface.max, from_surface.max); }
double MesherRun::p999() const { return std::max(to_surface.p999, from_surface.p999); }
double MesherRun::mean() const { return std::max(to_surface.mean, from_surface.mean); }

void measure_mesher(int count, char** words) {
  if (count != 4) throw std::runtime_error("a mesher, its size, internodes and the tolerance it is judged at are expected");
  const MesherJob job{words[0], std::stod(words[1]), std::stoul(words[2]), std::stod(words[3])};
  limit_memory();
  const Field field = make_field(job.internodes);
  MesherRun run;
  reset_peak_resident_bytes();
  const std::size_t before = resident_bytes();
  const double begin = seconds_now(), processor_begin = processor_seconds_now();
  const Mesh mesh = make_mesh(field, job, [&] {
    run.seconds = seconds_now() - begin;
    run.processor_seconds = processor_seconds_now() - processor_begin;
    const std::size_t peak = peak_resident_bytes();
    run.peak_bytes = peak > before ? static_cast<double>(peak - before) : 0;
  });
  run.triangles = mesh.triangles.size();
  if (job.judged_at > 0) {
    VerifyOptions options;
    options.tolerance = job.judged_at;
    options.surface_samples = kSamples;
    options.mesh_samples = kSamples;
    options.self_intersections = false;
    const auto verified = verify_mesh(mesh, field, options, {});
    run.to_surface = way_error(verified->mesh_to_surface);
    run.from_surface = way_error(verified->open_surface_to_mesh);
    run.in_cracks = static_cast<double>(verified->in_cracks) / static_cast<double>(verified->surface_to_mesh.samples);
  }
  std::string line;
  each_number(run, [&](auto number) { line += fmt::format("{} ", number); });
  fmt::print("{}\n", line);
}

std::optional<MesherRun> run_mesher(const MesherJob& job) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string command =
      fmt::format("'{}' --measure-mesher {} {} {} {}", self, job.mesher, job.size, job.internodes, job.judged_at);
  std::FILE* const pipe = ::popen(("exec " + command).c_str(), "r");
  if (!pipe) throw std::runtime_error("cannot run " + command);
  std::string text;
  for (std::array<char, 256> part; std::fgets(part.data(), part.size(), pipe);) text += part.data();
  const int status = ::pclose(pipe);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemory) return std::nullopt;
  MesherRun run;
  std::istringstream words(text);
  bool complete = status == 0;
  each_number(run, [&](auto& number) {
    std::string word;
    complete = complete && words >> word;
    if (complete) number = static_cast<std::remove_reference_t<decltype(number)>>(std::stod(word));   // "inf" included
  });
  if (!complete) throw std::runtime_error(command + " failed");
  return run;
}

}  // namespace cambium::bench
