// Numbers with units as people type them, on the command line and in recipes.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include "blobtree/input_error.h"
#include "raytrace/pixel_rect.h"

namespace cambium {

/// The whole text as a finite number. Errors: InputError at `at`.
double parse_number(std::string_view text, const SourceLocation& at);

/// "5mm", "0.4 cm", "2 m" or a bare number (metres), in metres; may be negative. Errors: InputError at `at`.
double parse_length(std::string_view text, const SourceLocation& at);
/// The same, greater than zero.
double parse_positive_length(std::string_view text, const SourceLocation& at);

/// "0.3pi", "-pi": 0.3, -1. nullopt for anything else.
std::optional<double> parse_parts_of_pi(std::string_view text);

/// "20000", "50k" or "1.2M": a whole number of at least 1. Errors: InputError at `at`.
std::size_t parse_count(std::string_view text, const SourceLocation& at);

/// "768x1024": width and height in pixels, each 1 to 65536. Errors: InputError at `at`.
std::pair<int, int> parse_image_size(std::string_view text, const SourceLocation& at);

/// "1..16": fewest and most; "16": most alone. Each 1 to 65535. Errors: InputError at `at`.
std::pair<std::optional<int>, int> parse_samples(std::string_view text, const SourceLocation& at);

/// "x0,y0,x1,y1": four whole numbers. Errors: InputError at `at`.
PixelRect parse_crop(std::string_view text, const SourceLocation& at);

}  // namespace cambium
