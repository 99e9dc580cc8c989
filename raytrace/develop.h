// From the sums of a frame to a film.
#pragma once

#include "raytrace/film.h"
#include "raytrace/frame.h"
#include "raytrace/framing.h"

namespace cambium {

struct DevelopOptions {
  double exposure = 1;
  bool smooth = true;          ///< the ambient light, between pixels of one surface
  View view;                   ///< of the whole picture
  bool transparent = false;    ///< as Film's
  std::set<Aov> aovs;
};

/// What developing looks at around a crop so that it comes out as in the whole picture.
PixelRect developed_area(const PixelRect& crop, const PixelRect& whole, bool smooth);

/// The pixels of `crop`. The frame's area must hold developed_area(crop), every pixel of that at least one sample.
Film develop(const Frame& frame, const PixelRect& crop, const DevelopOptions& options);

}  // namespace cambium
