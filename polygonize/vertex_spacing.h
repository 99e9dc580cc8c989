// How far apart the vertices of a mesh stand: what is drawn at vertices can show no finer detail.
#pragma once

#include "blobtree/run_options.h"
#include "polygonize/mesh.h"

#include <vector>

namespace cambium {

/// By vertex, metres: the geometric mean of the longest and the shortest of its edges, 0 without edges. Runs in the current arena; the
/// same at any thread count. Cancelled, it is of no use. Cost: about 10 ns a triangle.
std::vector<float> vertex_spacing(const Mesh& mesh, const RunOptions& run);

}  // namespace cambium
