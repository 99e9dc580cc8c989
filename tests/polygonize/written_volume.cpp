#include "tests/polygonize/written_volume.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/VolumeToMesh.h>

namespace cambium::testing {

Mesh zero_set(const std::filesystem::path& path) {
  openvdb::initialize();
  openvdb::io::File file(path.string());
  file.open(false);
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(file.beginName().gridName()));
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(*grid, points, quads, 0.0);
  Mesh mesh;
  for (const auto& p : points) mesh.positions.emplace_back(p.x(), p.y(), p.z());
  for (const auto& q : quads) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}

}  // namespace cambium::testing
