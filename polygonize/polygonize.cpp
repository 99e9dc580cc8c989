#include "polygonize/polygonize.h"

#include "blobtree/cell_search.h"
#include "blobtree/input_error.h"
#include "blobtree/progress_meter.h"
#include "polygonize/block_contour.h"
#include "polygonize/cell_blocks.h"
#include "polygonize/lattice.h"
#include "polygonize/mesh_components.h"
#include "polygonize/voxel_choice.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>

namespace cambium {
namespace {

using Contours = std::vector<std::unique_ptr<BlockContour>>;

// Every block that holds the surface, in Morton order.
struct Survey {
  bool cancelled = false;
  bool too_many = false;               // stopped early: more triangles than `enough`
  std::size_t triangles = 0;
  Contours blocks;
};

Survey survey(const Field& field, const Lattice& lattice, const PolygonizeOptions& options, bool count_only,
              std::size_t enough, const RunOptions& run) {
  Survey result;
  std::mutex mutex;
  std::atomic<std::size_t> triangles{0};
  std::atomic<bool> stop{false};
  tbb::enumerable_thread_specific<BlockContourer> contourers([&] { return BlockContourer(lattice); });
  ProgressMeter progress(run, count_only ? "counting cells" : "finding the surface");
  const auto visit = [&](Evaluator& evaluator, const PrunedField& pruned, const CellPlace& place) {
    BlockContourer& contourer = contourers.local();
    auto block = std::make_unique<BlockContour>();
    contourer.find_cells(evaluator, pruned, place, *block);
    if (block->cells.masks.empty()) return;
    const std::size_t so_far = triangles.fetch_add(2 * block->owned_crossings) + 2 * block->owned_crossings;
    if (so_far > enough) stop = true;
    if (count_only || stop) return;
    contourer.place_vertices(evaluator, pruned, options, *block);
    const std::lock_guard lock(mutex);
    result.blocks.push_back(std::move(block));
  };
  const bool complete = visit_cells(field, lattice.blocks, Wanted::kSurface, visit, run, progress, &stop);
  result.triangles = triangles;
  result.too_many = stop;
  result.cancelled = !complete && !stop;
  if (run.cancelled()) result.cancelled = true;
  if (complete) {
    tbb::parallel_sort(result.blocks.begin(), result.blocks.end(), [](const auto& a, const auto& b) {
      return morton_key(a->cells.place) < morton_key(b->cells.place);
    });
  }
  return result;
}

// How well a pair of triangles does: shape first, then how little it bends across the diagonal.
double diagonal_score(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {   // diagonal a-c
  const auto quality = [](const Vec3& p, const Vec3& q, const Vec3& r, Vec3& normal) {
    normal = glm::cross(q - p, r - p);
    const double doubled_area = glm::length(normal);
    const double longest = std::max({glm::dot(q - p, q - p), glm::dot(r - q, r - q), glm::dot(p - r, p - r)});
    if (!(doubled_area > 0)) return 0.0;
    normal /= doubled_area;
    return doubled_area / longest;
  };
  Vec3 first, second;
  const double worst = std::min(quality(a, b, c, first), quality(a, c, d, second));
  return worst * (1.1 + glm::dot(first, second));
}

void append_triangles(const Quad& q, const std::vector<Vec3>& positions, std::array<std::uint32_t, 3>* out) {
  const Vec3 &a = positions[q[0]], &b = positions[q[1]], &c = positions[q[2]], &d = positions[q[3]];
  if (diagonal_score(a, b, c, d) >= diagonal_score(b, c, d, a)) {
    out[0] = {q[0], q[1], q[2]};
    out[1] = {q[0], q[2], q[3]};
  } else {
    out[0] = {q[1], q[2], q[3]};
    out[1] = {q[1], q[3], q[0]};
  }
}

// Copies the vertices that the connectivity settled on into the mesh and gives back the block's share of memory.
void take_vertices(BlockContour& block, std::size_t index, const CellConnectivity& connectivity, Mesh& mesh,
                   double& largest_distance) {
  std::size_t standard = 0, flipped = 0;
  block.cells.for_each([&](int cell, int, int, int) {
    const int mask = block.cells.masks[cell], face = connectivity.flipped_face(index, cell);
    const std::uint32_t first = connectivity.first_vertex(index, cell);
    const PatchVertex* from = face == kNoFace ? &block.vertices[standard] : &block.flipped[flipped];
    for (std::uint32_t i = 0; i < cell_cycles(mask, face).count; ++i) {
      mesh.positions[first + i] = from[i].position;
      mesh.normals[first + i] = from[i].normal;
      if (!mesh.colors.empty()) mesh.colors[first + i] = from[i].color;
      largest_distance = std::max(largest_distance, static_cast<double>(from[i].distance));
    }
    standard += cell_cycles(mask).count;
    if (const int own = flippable_face(mask); own != kNoFace) flipped += cell_cycles(mask, own).count;
  });
  block.vertices = {};
  block.flipped = {};
}

std::optional<Polygonized> assemble(Contours blocks, double voxel, bool colors, const RunOptions& run) {
  ProgressMeter progress(run, "joining cells");
  std::vector<const CellBlock*> cells;
  cells.reserve(blocks.size());
  for (const auto& block : blocks) cells.push_back(&block->cells);
  const CellConnectivity connectivity(cells);
  if (run.cancelled()) return std::nullopt;

  Polygonized result;
  Mesh& mesh = result.mesh;
  mesh.positions.resize(connectivity.vertex_count());
  mesh.normals.resize(connectivity.vertex_count());
  if (colors) mesh.colors.resize(connectivity.vertex_count());
  std::vector<double> distances(blocks.size(), 0.0);
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
    if (!run.cancelled()) take_vertices(*blocks[b], b, connectivity, mesh, distances[b]);
  });
  progress.add(0.4);

  std::vector<std::size_t> first_triangle(blocks.size() + 1, 0);
  for (std::size_t b = 0; b < blocks.size(); ++b) first_triangle[b + 1] = first_triangle[b] + 2 * blocks[b]->owned_crossings;
  mesh.triangles.resize(first_triangle.back());
  tbb::enumerable_thread_specific<std::vector<Quad>> scratch;
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
    if (run.cancelled()) return;
    std::vector<Quad>& quads = scratch.local();
    connectivity.quads(b, quads);
    for (std::size_t i = 0; i < quads.size(); ++i) {
      append_triangles(quads[i], mesh.positions, &mesh.triangles[first_triangle[b] + 2 * i]);
    }
  });
  if (run.cancelled()) return std::nullopt;
  progress.add(0.4);

  result.report.cells = connectivity.cell_count();
  result.report.ambiguous_faces = connectivity.flipped_faces();
  const auto components = close_small_voids(mesh, voxel * voxel * voxel, run);
  if (!components) return std::nullopt;
  result.report.components = components->components;
  result.report.closed_voids = components->closed_voids;
  for (const double distance : distances) result.report.largest_distance = std::max(result.report.largest_distance, distance);
  progress.finish();
  return result;
}

std::optional<Polygonized> polygonize_in_arena(const Field& field, const PolygonizeOptions& options, const RunOptions& run) {
  const AtomSummary atoms = summarise_atoms(field);
  double voxel = choose_voxel(field, atoms, options);
  const bool free_choice = !options.voxel && !options.tolerance;
  if (options.max_triangles && *options.max_triangles == 0) throw InputError({}, "a limit of 0 triangles", "at least 1");
  std::optional<std::size_t> limit = options.max_triangles;
  if (!limit && free_choice) limit = kMostTriangles;
  // Start near a limit and not far beyond it: the estimate counts overlaps twice, so it may be cut by half.
  if (limit) voxel = std::max(voxel, 0.5 * voxel_for_triangles(atoms.area, static_cast<double>(*limit)));

  bool count_first = limit && 3 * expected_triangles(atoms.area, voxel) > static_cast<double>(*limit);
  Polygonized result;
  if (!field.bounds().empty()) {
    for (;;) {
      const Lattice lattice = make_lattice(field.bounds(), voxel);
      constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
      const std::size_t enough = limit && *limit < kAll / 4 ? 4 * *limit : kAll;
      Survey found = survey(field, lattice, options, count_first, enough, run);
      if (found.cancelled) return std::nullopt;
      if (limit && found.triangles > *limit) {
        // Whether a survey stops early depends on the total alone, so every thread count takes the same steps.
        const double ratio = static_cast<double>(found.triangles) / static_cast<double>(*limit);
        voxel *= found.too_many ? 2.0 : std::max(1.02, 1.01 * std::sqrt(ratio));
        count_first = true;
      } else if (count_first) {
        count_first = false;
      } else {
        auto assembled = assemble(std::move(found.blocks), voxel, static_cast<bool>(options.color), run);
        if (!assembled) return std::nullopt;
        result = std::move(*assembled);
        break;
      }
    }
  }
  result.report.voxel = voxel;
  report_thin_primitives(field, result.report);
  return result;
}

}  // namespace

std::optional<Polygonized> polygonize(const Field& field, const PolygonizeOptions& options, const RunOptions& run) {
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  std::optional<Polygonized> result;
  arena.execute([&] { result = polygonize_in_arena(field, options, run); });
  return result;
}

}  // namespace cambium
