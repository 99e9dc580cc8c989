// What one would write without this project: the field put into an OpenVDB grid, and volumeToMesh.
#pragma once

#include "blobtree/field.h"
#include "polygonize/mesh.h"

#include <functional>

namespace cambium::bench {

/// The field in every leaf where it is above 0, leaves in parallel, each with the primitives that matter in it and in the widest
/// vectors of the machine (the kernel's own batches: nobody's would be faster); then volumeToMesh without adaptivity, which is what
/// keeps its error lowest; quads cut in two. voxel in metres. `made` is called when OpenVDB's own points and quads are there: what
/// it costs to copy them into a Mesh is not the pipeline's. No normals.
Mesh vdb_pipeline(const Field& field, double voxel, int threads, const std::function<void()>& made);

}  // namespace cambium::bench
