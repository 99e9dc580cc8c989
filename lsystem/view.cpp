#include "lsystem/view.h"

#include <algorithm>
#include <optional>
#include <system_error>

#include "lsystem/contour_file.h"
#include "lsystem/module_parser.h"
#include "lsystem/preprocessor.h"

namespace cambium {
namespace {

bool names(const std::vector<std::string>& symbols, const std::string& symbol) {
  return std::find(symbols.begin(), symbols.end(), symbol) != symbols.end();
}

/// The file, or the first of its folder whose name differs by letters' case alone: many a model comes from Windows.
std::optional<std::filesystem::path> found(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error)) return file;
  for (const auto& other : files_with(file.parent_path().empty() ? "." : file.parent_path(), {}))
    if (lower_case(other.filename().string()) == lower_case(file.filename().string())) return other;
  return std::nullopt;
}

class ViewLoader {
 public:
  ViewLoader(const std::filesystem::path& file, const std::vector<std::string>& symbols) : symbols_(symbols) {
    const ViewFile read = read_view_file(read_source(file, {file.string(), 0, 0}), file);
    view_.file = file.filename().string();
    view_.settings = read.settings;
    if (read.unread_lines > 0) view_.skipped["lines of " + view_.file] = read.unread_lines;
    for (const ViewFile::Surface& surface : read.surfaces) load(surface);
    for (const ViewFile::Contour& contour : read.contours) load(contour);
  }
  View take() && { return std::move(view_); }

 private:
  /// Its text; nullopt, and a note, if it is not there.
  std::optional<std::string> text_of(const std::filesystem::path& file, const SourceLocation& place) {
    if (const auto there = found(file)) return read_source(*there, place);
    ++view_.skipped[file.filename().string() + ", which is not there"];
    return std::nullopt;
  }

  // As in cpfg the first of a letter counts.
  void load(const ViewFile::Surface& surface) {
    if (!names(symbols_, "~" + surface.name) || view_.surfaces.contains(surface.name)) return;
    if (const auto text = text_of(surface.file, surface.place))
      view_.surfaces.emplace(surface.name, read_patch_surface(*text, surface.file, surface.name, surface.size));
  }

  void load(const ViewFile::Contour& contour) {
    if (!names(symbols_, "@#") || view_.contours.contains(contour.number)) return;
    if (const auto text = text_of(contour.file, contour.place))
      view_.contours.emplace(contour.number, read_contour_radius(*text, contour.file));
  }

  const std::vector<std::string>& symbols_;
  View view_;
};

}  // namespace

View view_beside(const std::filesystem::path& model, const std::vector<std::string>& symbols) {
  const auto file = view_file_of(model);
  if (!file) return {};
  return ViewLoader(*file, symbols).take();
}

}  // namespace cambium
