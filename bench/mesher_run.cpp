#include "bench/mesher_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "bench/clock.h"
#include "bench/generated_trees.h"
#include "bench/process_figures.h"
#include "bench/vdb_pipeline.h"
#include "polygonize/polygonize.h"
#include "polygonize/verify.h"
#include "skeletons/surface.h"

namespace cambium::bench {
namespace {

constexpr std::size_t kInternodes = 10'000;
constexpr double kThinnestRadius = 0.001;
constexpr int kThreads = 2;

Field make_field() {
  Skeleton skeleton = random_tree(kInternodes, 5);
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

Mesh make_mesh(const Field& field, const std::string& mesher, double size) {
  if (mesher == "vdb") return vdb_pipeline(field, size, kThreads);
  if (mesher != "ours") throw std::runtime_error("no mesher '" + mesher + "'");
  PolygonizeOptions options;
  options.tolerance = size;
  RunOptions run;
  run.threads = kThreads;
  return std::move(polygonize(field, options, run)->mesh);
}

}  // namespace

void measure_mesher(const std::string& mesher, double size) {
  const Field field = make_field();
  reset_peak_resident_bytes();
  const std::size_t before = resident_bytes();
  double seconds = 0;
  const Mesh mesh = timed(seconds, [&] { return make_mesh(field, mesher, size); });
  const std::size_t peak = peak_resident_bytes();
  VerifyOptions options;
  options.self_intersections = false;
  const auto verified = verify_mesh(mesh, field, options, {});
  const DistanceFigures &to = verified->mesh_to_surface, &from = verified->surface_to_mesh;
  fmt::print("{} {} {} {} {} {} {}\n", mesh.triangles.size(), seconds, peak > before ? peak - before : 0, std::max(to.max, from.max),
             std::max(to.p999, from.p999), std::max(to.p99, from.p99), std::max(to.mean, from.mean));
}

MesherRun run_mesher(const std::string& mesher, double size) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string command = fmt::format("'{}' --measure-mesher {} {}", self, mesher, size);
  std::FILE* const pipe = ::popen(command.c_str(), "r");
  if (!pipe) throw std::runtime_error("cannot run " + command);
  std::string text;
  for (std::array<char, 256> part; std::fgets(part.data(), part.size(), pipe);) text += part.data();
  const int status = ::pclose(pipe);
  MesherRun run;
  std::istringstream words(text);
  words >> run.triangles >> run.seconds >> run.peak_bytes >> run.max >> run.p999 >> run.p99 >> run.mean;
  if (status != 0 || !words) throw std::runtime_error(command + " failed");
  return run;
}

}  // namespace cambium::bench
