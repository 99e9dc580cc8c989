#include "polygonize/decimate.h"

#include "blobtree/input_error.h"
#include "polygonize/edge_collapse.h"
#include "polygonize/verify.h"

#include <utility>

namespace cambium {
namespace {

constexpr int kMostRings = 4;
constexpr int kMostRounds = 20;   // of mending; two or three are usual

using Pairs = std::vector<std::array<std::uint32_t, 2>>;

void widen(const Mesh& mesh, std::vector<bool>& marked) {
  std::vector<bool> wider = marked;
  for (const auto& t : mesh.triangles)
    if (marked[t[0]] || marked[t[1]] || marked[t[2]])
      for (const std::uint32_t v : t) wider[v] = true;
  marked = std::move(wider);
}

// Locks every vertex of the source that went into a triangle of a pair, from the third round on into their neighbours too, and
// where all of these are locked already into ever more of them. False if nothing is left to lock nearby.
bool lock_pairs(const Collapsed& made, const Pairs& pairs, int round, std::vector<bool>& locked) {
  std::vector<bool> marked(made.mesh.positions.size(), false);
  for (const auto& pair : pairs)
    for (const std::uint32_t triangle : pair)
      for (const std::uint32_t v : made.mesh.triangles[triangle]) marked[v] = true;
  if (round >= 2) widen(made.mesh, marked);
  for (int ring = 0; ring < kMostRings; ++ring) {
    bool more = false;
    for (std::size_t v = 0; v < locked.size(); ++v) {
      if (locked[v] || made.survivor[v] >= marked.size() || !marked[made.survivor[v]]) continue;
      locked[v] = more = true;
    }
    if (more) return true;
    widen(made.mesh, marked);
  }
  return false;
}

}  // namespace

std::optional<Mesh> decimate(const Mesh& mesh, const DecimateOptions& options, const RunOptions& run) {
  if (options.triangles == 0) throw InputError({}, "0 triangles to decimate to", "at least 1");
  if (mesh.triangles.size() <= options.triangles) return mesh;
  std::vector<bool> locked(mesh.positions.size(), false);
  std::optional<Collapsed> best;
  std::size_t fewest = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    auto made = collapse_edges(mesh, options.triangles, locked, run);
    if (!made) return std::nullopt;
    const auto pairs = self_intersections(made->mesh, run);
    if (!pairs) return std::nullopt;
    const bool more = !pairs->empty() && lock_pairs(*made, *pairs, round, locked);
    const bool better = !best || pairs->size() < fewest;
    if (better) {
      best = std::move(made);
      fewest = pairs->size();
    }
    if (!more || (round >= 2 && !better)) break;   // what is left was there before
  }
  return std::move(best->mesh);
}

}  // namespace cambium
