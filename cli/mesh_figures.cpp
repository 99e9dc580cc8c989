#include "cli/mesh_figures.h"

#include <fmt/format.h>

#include <algorithm>

namespace cambium {
namespace {

Json distances(const DistanceFigures& figures, bool against_tolerance) {
  Json json = {{"max", figures.max},   {"p999", figures.p999},       {"p99", figures.p99},
               {"mean", figures.mean}, {"samples", figures.samples}};
  json["max_at"] = Json::array({figures.max_at.x, figures.max_at.y, figures.max_at.z});
  if (against_tolerance) json["within_tolerance"] = figures.within, json["within_twice"] = figures.within_twice;
  return json;
}

Json topology(const MeshTopology& t) {
  return {{"boundary_edges", t.boundary_edges},
          {"nonmanifold_edges", t.nonmanifold_edges},
          {"nonmanifold_vertices", t.nonmanifold_vertices},
          {"degenerate_triangles", t.degenerate_triangles},
          {"unused_vertices", t.unused_vertices},
          {"components", t.components},
          {"euler", t.euler},
          {"volume", t.volume}};
}

std::string level_name(std::size_t level, std::size_t levels) {
  return levels > 1 ? fmt::format("level {} ", level) : std::string("the mesh ");
}

constexpr std::size_t kListedPlaces = 100;
constexpr double kWithin = 0.999;   // of the samples; the rest may be twice as far off

/// How many, and where the first of them are.
void set_places(Job& job, const std::string& name, const std::vector<Vec3>& places) {
  job.figures.set(name, places.size());
  Json list = Json::array();
  for (std::size_t i = 0; i < std::min(places.size(), kListedPlaces); ++i)
    list.push_back(Json::array({places[i].x, places[i].y, places[i].z}));
  if (!places.empty()) job.figures.set(name + "_at", list);
}

}  // namespace

void set_level_figures(Job& job, const std::vector<Mesh>& levels, const std::vector<std::size_t>& most) {
  job.figures.set("triangles", levels.front().triangles.size());
  job.figures.set("vertices", levels.front().positions.size());
  job.figures.set("creases", levels.front().creases.size());
  if (most.empty()) return;
  Json list = Json::array();
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const std::size_t triangles = levels[i].triangles.size();
    list.push_back({{"triangles", triangles}, {"vertices", levels[i].positions.size()}, {"creases", levels[i].creases.size()}});
    if (triangles > most[i])
      job.warnings.push_back(fmt::format("level {} has {} triangles: no fewer keep every piece closed", i, triangles));
  }
  job.figures.set("levels", list);
}

void set_polygonize_figures(Job& job, const PolygonizeReport& report) {
  job.figures.set("components", report.components);
  if (report.tolerance > 0) job.figures.set("tolerance", report.tolerance);
  job.figures.set("smallest_cell", report.smallest_cell);
  job.figures.set("largest_cell", report.largest_cell);
  job.figures.set("cells", report.cells);
  job.figures.set("rounds", report.rounds);
  job.figures.set("closed_voids", report.closed_voids);
  job.figures.set("crumbs", report.crumbs);
  set_places(job, "left_out", report.left_out);
  set_places(job, "uncertain", report.uncertain);
  set_places(job, "unseen", report.unseen);
}

void set_verify_figures(Job& job, const std::vector<Verification>& levels, double tolerance) {
  Json list = Json::array();
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const Verification& v = levels[i];
    list.push_back({{"mesh_to_surface", distances(v.mesh_to_surface, tolerance > 0)},
                    {"surface_to_mesh", distances(v.surface_to_mesh, tolerance > 0)},
                    {"open_surface_to_mesh", distances(v.open_surface_to_mesh, tolerance > 0)},
                    {"in_cracks", v.in_cracks},
                    {"self_intersections", v.self_intersections},
                    {"topology", topology(v.topology)}});
    const std::string name = level_name(i, levels.size());
    if (!v.topology.closed_manifold()) job.warnings.push_back(name + "is not a closed manifold");
    if (v.self_intersections > 0)
      job.warnings.push_back(fmt::format("{}has {} pairs of triangles that cross each other", name, v.self_intersections));
    if (i > 0 || tolerance == 0) continue;   // levels of detail are not asked to be within it
    for (const auto& [way, d] : {std::pair("the surface", &v.mesh_to_surface), std::pair("the mesh", &v.open_surface_to_mesh)})
      if (d->within < kWithin || d->within_twice < 1)
        job.warnings.push_back(fmt::format("{}misses its tolerance of {:g} m: {:.3f} % of the samples are within it, the farthest is "
                                           "{:g} m from {}",
                                           name, tolerance, 100 * d->within, d->max, way));
  }
  if (tolerance > 0) job.figures.set("tolerance", tolerance);
  job.figures.set("verify", levels.size() == 1 ? list[0] : list);
}

}  // namespace cambium
