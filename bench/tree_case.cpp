#include "bench/tree_case.h"

#include <utility>

#include "bench/clock.h"
#include "bench/process_figures.h"
#include "skeletons/surface.h"

namespace cambium::bench {

TreeCase make_tree_case(std::string name, const std::function<Skeleton()>& make_skeleton, std::size_t places) {
  reset_peak_resident_bytes();
  const std::size_t before = resident_bytes();
  Skeleton skeleton = make_skeleton();
  SurfaceOptions options;
  options.lip = 1.5;
  double surface_seconds = 0, compile_seconds = 0;
  const auto threads_begin = thread_times();
  Surfaced surfaced = timed(surface_seconds, [&] { return surface(skeleton, options); });
  const Field field = timed(compile_seconds, [&] { return Field(surfaced.tree); });
  const double processor_seconds = threads_since(threads_begin).busiest_ran;
  TreeCase made{std::move(name), std::move(skeleton), std::move(surfaced.tree), field, CoverTimings(field), {},
                surface_seconds, compile_seconds,     processor_seconds};
  made.cover.measure_cover(2);
  const std::size_t peak = peak_resident_bytes();
  made.peak_bytes = peak > before ? peak - before : 0;
  made.cover.release();

  made.places = surface_places(made.skeleton, made.field, places, RandomNumbers(3));
  for (const SurfacePlace& place : made.places)
    made.mean_active += static_cast<double>(made.field.prune(place.cell()).atom_count()) / static_cast<double>(places);
  return made;
}

}  // namespace cambium::bench
