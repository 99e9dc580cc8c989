// A stroke out of a drawing: the outline of a crown, drawn beside its axis in any program that writes SVG.
#pragma once

#include <glm/glm.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cambium {

struct SvgStrokeOptions {
  std::string id = {};               ///< of the <path> that is read; empty: the first that is drawn
  std::optional<double> axis = {};   ///< the line x = axis in the document's coordinates; unset: through the stroke's leftmost point
  double height = 1;                 ///< metres from the stroke's lowest point to its highest, > 0
  double tolerance = 1e-3;           ///< curves become lines that are not farther from them, in heights, > 0
};

/// (distance from the axis, z) in metres of each point, z up and 0 at the lowest, in the order in which they were drawn; a stroke left
/// of its axis is mirrored. Of several subpaths the first. A path that is closed ends with its first point. Transforms of the path and
/// of the groups around it hold; styles, units and viewBox do not matter. `file` is only named in messages.
/// Errors: InputError with line and column where the text, the path's data or a transform is malformed, where there is no such path or
/// it is flat, and where it crosses its axis. Cost: linear; a stroke of more than 2^16 points is refused.
std::vector<glm::dvec2> read_svg_stroke(std::string_view text, const std::string& file, const SvgStrokeOptions& options);

}  // namespace cambium
