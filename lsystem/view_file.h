// View files: how cpfg is to draw a model.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "blobtree/geometry.h"
#include "blobtree/input_error.h"

namespace cambium {

/// What of a view file concerns the plant rather than its picture. Directions are the world's, z up: cpfg's (x,y,z) is
/// (x,-z,y).
struct ViewSettings {
  std::optional<double> angle;            ///< radians; from `angle increment:`, or `angle factor:` parts of a turn
  std::optional<double> width;            ///< `initial line width:`, unless in pixels
  std::optional<double> width_increment;  ///< `line width increment:`, what # adds and ! takes away
  std::optional<Vec3> tropism;  ///< `tropism direction:`, or the first `tropism:` line; its length is the intensity
  std::optional<double> elasticity;
  double elasticity_increment = 0;
  std::uint32_t color = 0;
  std::uint32_t color_increment = 1;  ///< 0 to 255
};

struct ViewFile {
  struct Surface {
    std::string name;
    std::filesystem::path file;
    double size = 1;
    SourceLocation place;
  };
  struct Contour {
    std::size_t number = 0;
    std::filesystem::path file;
    SourceLocation place;
  };
  struct Function {
    std::filesystem::path file;
    SourceLocation place;
  };
  ViewSettings settings;
  std::vector<Surface> surfaces;
  std::vector<Contour> contours;
  std::vector<Function> functions;  ///< and sets of them
  std::size_t unread_lines = 0;     ///< that say something of the picture, or nothing known
};

/// After the C preprocessor, as in cpfg. Files it names are looked for beside it. Errors: InputError with line and column.
ViewFile read_view_file(std::string_view text, const std::filesystem::path& file);

/// MODEL.v or MODEL.view, or else the only .v or the only .view of the model's folder, if that is not another model's by its
/// name.
std::optional<std::filesystem::path> view_file_of(const std::filesystem::path& model);

/// The files of a folder that end so, or all if `extension` is empty, by name.
std::vector<std::filesystem::path> files_with(const std::filesystem::path& folder, std::string_view extension);

}  // namespace cambium
