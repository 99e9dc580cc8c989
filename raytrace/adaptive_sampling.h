// Which pixels need more samples, and taking them pass by pass.
#pragma once

#include "raytrace/frame.h"
#include "raytrace/sampling.h"
#include "raytrace/silhouette.h"

#include <functional>

namespace cambium {

/// The pixels of `region` (places in the frame's array, tile by tile) that are not done: their own samples' error is above the
/// noise wanted, or what differs around them is so much that their few samples may well have missed it.
std::vector<std::uint32_t> unfinished_pixels(const Frame& frame, const PixelRect& region, const PixelMask& surface,
                                             const Sampling& sampling);

/// What passes look at around a crop so that it comes out as in the whole picture: each decision sees two pixels further.
PixelRect sampled_area(const PixelRect& crop, const PixelRect& whole, const Sampling& sampling);

/// Passes over `crop` until all pixels are done or have sampling.max samples (Mitchell 1987's two levels, repeated). Returns the
/// most samples a pixel of the last finished pass has, less than sampling.max only if cancelled: 0 before the first is finished.
/// pass_finished is called with that number after each pass. The frame's area must hold sampled_area(crop).
int take_passes(Frame& frame, const SampleSource& source, const PixelRect& crop, const PixelMask& surface, const Sampling& sampling,
                const RunOptions& run, const std::function<void(int samples)>& pass_finished);

}  // namespace cambium
