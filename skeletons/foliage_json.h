// The optional "shapes" and "organs" of a .skel.json. Private to its reading and writing.
#pragma once

#include "blobtree/located_json.h"
#include "skeletons/foliage.h"

#include <cstdint>
#include <span>
#include <string>

namespace cambium {

/// `places`: which of the skeleton's nodes each node of the file became. Errors: InputError at the value: an index without an item,
/// a scale that is not above 0, vectors that are not unit and at right angles (within 1e-6).
Foliage read_foliage(const JsonValue& root, std::span<const std::int32_t> places);

/// Members that follow others; nothing for a foliage without shapes.
void append_foliage(std::string& out, const Foliage& foliage);

}  // namespace cambium
