#include "lsystem/view_file.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <system_error>
#include <utility>

#include "lsystem/module_parser.h"
#include "lsystem/preprocessor.h"
#include "lsystem/value_reader.h"

namespace cambium {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kColors = 256;

Vec3 z_up(const Vec3& v) { return {v.x, -v.z, v.y}; }

class ViewReader {
 public:
  ViewReader(const SourceText& source, const std::filesystem::path& file)
      : source_(source), file_(file), values_(source, ValueReader::Layout::kLines) {}

  ViewFile read() {
    for (; !values_.at_end(); values_.next_line()) {
      if (values_.at_line_end()) continue;
      const auto reader = readers().find(values_.label());
      if (reader == readers().end())
        ++view_.unread_lines;
      else
        (this->*reader->second)();
    }
    if (width_is_pixels_) view_.settings.width.reset();
    return std::move(view_);
  }

 private:
  static const std::map<std::string, void (ViewReader::*)(), std::less<>>& readers() {
    static const std::map<std::string, void (ViewReader::*)(), std::less<>> kReaders = {
        {"angle factor", &ViewReader::angle_factor},
        {"angle increment", &ViewReader::angle_increment},
        {"initial color", &ViewReader::color},
        {"color increment", &ViewReader::color_increment},
        {"initial line width", &ViewReader::width},
        {"line width increment", &ViewReader::width_increment},
        {"line style", &ViewReader::line_style},
        {"tropism direction", &ViewReader::tropism_direction},
        {"initial elasticity", &ViewReader::elasticity},
        {"elasticity increment", &ViewReader::elasticity_increment},
        {"tropism", &ViewReader::tropism},
        {"surface", &ViewReader::surface},
        {"contour", &ViewReader::contour},
        {"function", &ViewReader::function},
        {"function set", &ViewReader::function},
        {"functionset", &ViewReader::function}};
    return kReaders;
  }

  ViewSettings& settings() { return view_.settings; }
  SourceLocation location() { return located(source_.files, values_.place()); }
  std::filesystem::path beside(const std::string& name) const { return file_.parent_path() / name; }

  void angle_factor() { settings().angle = 2 * std::numbers::pi / values_.positive("parts of a turn"); }
  void angle_increment() { settings().angle = kDegree * values_.number("an angle in degrees"); }
  void color() { settings().color = static_cast<std::uint32_t>(values_.count("a colour", 0, 65535)); }
  void color_increment() {
    const double steps = std::fmod(std::trunc(values_.number("a number of colours")), kColors);
    settings().color_increment = static_cast<std::uint32_t>(steps < 0 ? steps + kColors : steps);
  }
  void width() {
    const double width = values_.number("a line width");
    if (width > 0) settings().width = width;
    width_is_pixels_ = values_.word().starts_with('p');
  }
  void width_increment() { settings().width_increment = values_.number("a line width"); }
  void line_style() {
    const std::string style = values_.word();
    width_is_pixels_ = style == "pixel" || style == "1";
  }
  void tropism_direction() { settings().tropism = z_up(values_.direction("a direction x,y,z")); }
  void elasticity() { settings().elasticity = values_.number("an elasticity"); }
  void elasticity_increment() { settings().elasticity_increment = values_.number("an elasticity"); }

  // `T: x y z A: angle I: intensity E: elasticity S: step`. The turtle knows one tropism, towards its vector.
  void tropism() {
    ViewSettings read;
    double angle = 0, intensity = 1;
    read.elasticity = 0;
    while (!values_.at_line_end()) {
      if (values_.accept("T:")) {
        read.tropism = z_up(values_.direction("a direction x y z"));
      } else if (values_.accept("A:")) {
        angle = values_.number("an angle in degrees");
      } else if (values_.accept("I:")) {
        intensity = std::clamp(values_.number("an intensity"), -1.0, 1.0);
      } else if (values_.accept("E:")) {
        read.elasticity = values_.number("an elasticity");
      } else if (values_.accept("S:")) {
        read.elasticity_increment = values_.number("an elasticity");
      } else {
        values_.fail("'T:', 'A:', 'I:', 'E:' or 'S:'");
      }
    }
    if (!read.tropism) values_.fail("'T:' and a direction");
    if (angle != 0 || settings().tropism) {
      ++view_.unread_lines;
      return;
    }
    settings().tropism = intensity * *read.tropism;
    settings().elasticity = read.elasticity;
    settings().elasticity_increment = read.elasticity_increment;
  }

  // `surface: l leaf.s size ...`: how fine cpfg draws it, and its texture, are not read. A size of 0 or less is 1.
  void surface() {
    ViewFile::Surface out;
    out.place = location();
    out.name = values_.word("the letter of a surface");
    out.place = location();
    out.file = beside(values_.word("the file of a surface"));
    out.size = values_.number("the size of a surface");
    if (!(out.size > 0)) out.size = 1;
    view_.surfaces.push_back(std::move(out));
  }

  void contour() {
    ViewFile::Contour out;
    out.number = values_.count("the number of a contour", 0, 1'000'000);
    out.place = location();
    out.file = beside(values_.word("the file of a contour"));
    view_.contours.push_back(std::move(out));
  }

  void function() {
    const SourceLocation place = location();
    view_.functions.push_back({beside(values_.word("the file of a function")), place});
  }

  const SourceText& source_;
  const std::filesystem::path& file_;
  ValueReader values_;
  ViewFile view_;
  bool width_is_pixels_ = false;
};

/// The only file that ends so, unless it stands beside another model that it is named for.
std::optional<std::filesystem::path> only_view(const std::filesystem::path& folder, std::string_view extension,
                                               const std::filesystem::path& model) {
  const auto views = files_with(folder, extension);
  if (views.size() != 1) return std::nullopt;
  std::filesystem::path its_model = views[0];
  std::error_code error;
  if (std::filesystem::is_regular_file(its_model.replace_extension(model.extension()), error)) return std::nullopt;
  return views[0];
}

}  // namespace

ViewFile read_view_file(std::string_view text, const std::filesystem::path& file) {
  const SourceText source = preprocess(text, file);
  return ViewReader(source, file).read();
}

std::vector<std::filesystem::path> files_with(const std::filesystem::path& folder, std::string_view extension) {
  std::vector<std::filesystem::path> out;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (extension.empty() || entry->path().extension() == extension) out.push_back(entry->path());
  std::sort(out.begin(), out.end());
  return out;
}

std::optional<std::filesystem::path> view_file_of(const std::filesystem::path& model) {
  const std::filesystem::path folder = model.parent_path().empty() ? "." : model.parent_path();
  std::error_code error;
  for (const char* extension : {".v", ".view"}) {
    std::filesystem::path same = model;
    if (std::filesystem::is_regular_file(same.replace_extension(extension), error)) return same;
  }
  for (const char* extension : {".v", ".view"})
    if (auto only = only_view(folder, extension, model)) return only;
  return std::nullopt;
}

}  // namespace cambium
