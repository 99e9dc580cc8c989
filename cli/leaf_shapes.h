// The shapes that leaves come in: drawn by the L-system, cards, and a plain leaf. All are held at the origin and grow along y.
#pragma once

#include "blobtree/sheet.h"
#include "skeletons/foliage.h"

namespace cambium {

/// What was drawn; the image lies over its extent in x and y.
Sheet drawn_leaf(const OrganShape& shape);
/// A rectangle, for an image with a cut-out.
Sheet leaf_card(double width, double length);
/// The outline of an entire, ovate leaf; where there is no image to say what it looks like.
Sheet plain_leaf(double width, double length);

}  // namespace cambium
