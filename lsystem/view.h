// What a model's view file, and the files that it names, tell the turtle.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "lsystem/patch_surface.h"
#include "lsystem/view_file.h"

namespace cambium {

struct View {
  std::string file;  ///< its name; empty: there is none
  ViewSettings settings;
  std::map<std::string, PatchSurface> surfaces;  ///< by their letters
  std::map<std::size_t, double> contours;        ///< read_contour_radius() by their numbers
  std::map<std::string, std::size_t> skipped;    ///< lines that were not read, and files that are not there
};

/// Of the view file beside a model, with those surfaces that `symbols` name, and contours if they choose any: a model must
/// not fail on a file that nothing asks for. As in cpfg, a file that is not there is no error. Errors: InputError in those
/// that are.
View view_beside(const std::filesystem::path& model, const std::vector<std::string>& symbols);

}  // namespace cambium
