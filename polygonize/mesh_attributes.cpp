#include "polygonize/mesh_attributes.h"

#include "blobtree/input_error.h"
#include "polygonize/lattice.h"
#include "polygonize/surface_places.h"
#include "polygonize/texture_layout.h"

#include <tbb/task_arena.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace cambium {

std::optional<MeshAttributes> mesh_attributes(const Field& field, const Mesh& mesh, const MeshAttributeOptions& options,
                                              const RunOptions& run) {
  if (options.tile) require_length(*options.tile, "repeat of the texture");
  if (!(options.aspect > 0) || !std::isfinite(options.aspect))
    throw InputError({}, "a texture " + std::to_string(options.aspect) + " times as wide as high", "a finite number above 0");
  if (mesh.normals.size() != mesh.positions.size()) throw std::invalid_argument("attributes of a mesh without normals");
  MeshAttributes out;
  out.branches = options.branches;
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  bool complete = false;
  arena.execute([&] {
    const auto places = surface_places(field, mesh, options.color, out, run);
    complete = places && lay_out_texture(mesh, *places, options, out, run);
  });
  if (!complete) return std::nullopt;
  if (options.occlusion) {
    auto occlusion = ambient_occlusion(mesh, *options.occlusion, run);
    if (!occlusion) return std::nullopt;
    out.occlusion = std::move(*occlusion);
  }
  return out;
}

}  // namespace cambium
