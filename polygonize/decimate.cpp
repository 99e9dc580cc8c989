#include "polygonize/decimate.h"

#include "blobtree/input_error.h"
#include "polygonize/edge_collapse.h"

namespace cambium {

std::optional<Mesh> decimate(const Mesh& mesh, const DecimateOptions& options, const RunOptions& run) {
  if (options.triangles == 0) throw InputError({}, "0 triangles to decimate to", "at least 1");
  if (mesh.triangles.size() <= options.triangles) return mesh;
  return collapse_edges(mesh, options.triangles, run);
}

}  // namespace cambium
