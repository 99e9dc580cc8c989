// What the user typed, and running it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cambium {

enum class Command { kDerive, kGrow, kSurface, kEval, kMesh, kVolume, kRender, kInfo };

/// One parsed command line. Lengths and sizes are still text; an empty string or optional was not given.
struct CommandLine {
  Command command = Command::kInfo;
  std::string command_name;
  std::string input, output;
  int threads = 0;
  std::optional<std::uint64_t> seed;
  std::optional<std::string> label;          ///< of --lsystem
  std::string dialect;                       ///< of an L-system
  std::optional<std::size_t> max_modules;
  std::optional<int> step;                   ///< derive
  bool explain = false;                      ///< derive
  std::optional<double> growth_step;         ///< grow, mesh, render: derivation steps from one frame to the next
  bool quiet = false, json = false;
  bool no_leaves = false;
  std::vector<std::string> overrides;        ///< of --set
  std::string points;                        ///< eval
  std::string voxel;                         ///< mesh, volume
  std::string tolerance, max_triangles;      ///< mesh
  std::string lod, up;                       ///< mesh
  std::optional<int> min_sides;              ///< mesh
  bool preview = false;                      ///< mesh
  bool verify = false, no_ao = false;        ///< mesh
  std::string kind;                          ///< volume
  std::string size;                          ///< render
  std::string samples, crop;                 ///< render
  std::optional<double> noise;               ///< render
  std::optional<int> bounces;                ///< render
  std::optional<std::uint32_t> close_up;     ///< render: a branch
  std::optional<int> turntable;              ///< render: how many pictures around the tree
  std::optional<int> frame;                  ///< of --turntable or --step the only one to make, from 1
  int bits = 8;                              ///< render
  std::vector<std::string> aovs;             ///< render
};

/// Parses and runs; prints figures on stdout, at most one line of error on stderr, and before it warnings.
/// Returns the exit status: 0 done, 2 bad usage or input, 1 anything else.
int run_command_line(int argc, char** argv);

}  // namespace cambium
