// One mesh made and measured in a process of its own, so that peak memory is that of the mesher alone.
#pragma once

#include <cstddef>
#include <string>

namespace cambium::bench {

struct MesherRun {
  std::size_t triangles = 0;
  double seconds = 0;
  double peak_bytes = 0;              ///< resident at most while it ran, above what the field took before
  double max = 0, p999 = 0, p99 = 0, mean = 0;   ///< metres, the larger of both ways
};

/// Both meshers know the same tree: 10,000 internodes, its thinnest twigs 2 mm across.
/// mesher: "ours" (size is the tolerance) or "vdb" (size is the voxel), metres. Errors: std::runtime_error if the child fails.
MesherRun run_mesher(const std::string& mesher, double size);

/// What the child does: one line of numbers on stdout.
void measure_mesher(const std::string& mesher, double size);

}  // namespace cambium::bench
