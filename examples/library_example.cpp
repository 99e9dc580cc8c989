#include <blobtree/field.h>
#include <lsystem/lsystem.h>
#include <polygonize/mesh_io.h>
#include <polygonize/polygonize.h>
#include <skeletons/surface.h>

int main(int, char** argv) {  // tree.l, tree.ply
  using namespace cambium;
  const LSystem system = LSystem::load(argv[1]);
  const Skeleton skeleton = interpret(*derive(system, {}, {}), system, {}, {})->skeleton;
  const Field field(surface(skeleton, {.lip = 1.5}).tree);
  const Polygonized made = *polygonize(field, {.tolerance = 0.01}, {});
  write_mesh(made.mesh, argv[2], ".ply", UpAxis::kZ);
}
