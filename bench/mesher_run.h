// One mesh made and measured in a process of its own, so that peak memory is that of the mesher alone.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace cambium::bench {

/// What a child is to do. Both meshers know the same tree: generated, its thinnest twigs 2 mm across.
struct MesherJob {
  std::string mesher = "ours";       ///< or "vdb"
  double size = 0;                   ///< the tolerance of ours, the voxel of OpenVDB; metres
  std::size_t internodes = 10'000;
  /// The verifier's: surface in cracks narrower than this does not count, for either mesher. 0: errors are not measured.
  double judged_at = 0;
};

/// Of one mesher's mesh; metres.
struct WayError {
  double max = 0, p999 = 0, mean = 0;
  double x = 0, y = 0, z = 0;        ///< where it is largest
};

struct MesherRun {
  std::size_t triangles = 0;
  double seconds = 0;                ///< by the wall clock
  double processor_seconds = 0;      ///< of all threads, user and system: what other programs take does not count
  double peak_bytes = 0;             ///< resident at most while it ran, above what the field took before
  WayError to_surface, from_surface; ///< from samples of the mesh, and from the surface outside of cracks
  double in_cracks = 0;              ///< share of the surface's samples

  double max() const;                ///< the larger of both ways
  double p999() const;
  double mean() const;
};

/// nullopt where there was not the memory for it. Errors: std::runtime_error if the child fails otherwise.
std::optional<MesherRun> run_mesher(const MesherJob& job);

/// What the child does with its arguments (mesher, size, internodes, judged_at): one line of numbers on stdout. Errors:
/// std::runtime_error for others.
void measure_mesher(int count, char** words);

/// The child's exit status when there was not the memory for its mesh.
inline constexpr int kOutOfMemory = 3;

}  // namespace cambium::bench
