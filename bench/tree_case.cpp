#include "bench/tree_case.h"

#include "bench/clock.h"
#include "skeletons/surface.h"

#include <utility>

namespace cambium::bench {

TreeCase make_tree_case(std::string name, Skeleton skeleton, std::size_t places) {
  double surface_seconds = 0, compile_seconds = 0;
  SurfaceOptions options;
  options.lip = 1.5;
  Surfaced surfaced = timed(surface_seconds, [&] { return surface(skeleton, options); });
  Field field = timed(compile_seconds, [&] { return Field(surfaced.tree); });
  TreeCase made{std::move(name), std::move(skeleton), std::move(surfaced.tree), std::move(field), {}, surface_seconds,
                compile_seconds};
  made.places = surface_places(made.skeleton, made.field, places, RandomNumbers(3));
  for (const SurfacePlace& place : made.places)
    made.mean_active += static_cast<double>(made.field.prune(place.cell()).atom_count()) / static_cast<double>(places);
  return made;
}

}  // namespace cambium::bench
