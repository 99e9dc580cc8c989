// User curves: what cpfg's func(number, x) reads from function files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace cambium {

struct CurvePoint {
  double x = 0, y = 0;
};

/// y as a function of x in [0, 1]: the clamped uniform cubic B-spline of at least 4 control points, met at x. With more than
/// 2 `samples` it is a table of that many values, equally spaced and joined by straight lines, as in cpfg.
class Curve {
 public:
  Curve(std::string name, std::vector<CurvePoint> points, std::size_t samples);

  const std::string& name() const { return name_; }
  /// x below 0 counts as 0, above 1 as 1.
  double value(double x) const;

 private:
  CurvePoint at(double parameter) const;  ///< in [0, 1] along the curve
  double solved(double x) const;

  std::string name_;
  std::vector<CurvePoint> points_;
  std::vector<double> table_;
};

/// One function (`fver 1 1`, or the older form that begins with `range:`) or a set of them (`funcgalleryver 1 1`). The older
/// form has no name: it gets the file's. Errors: InputError with the line.
std::vector<Curve> read_curves(std::string_view text, const std::filesystem::path& file);

/// The curves of a model, number 1 first: those that the `function:` and `function set:` lines of its view file name (see
/// view_file.h); without any such line, those of the folder's .fset files, and without any of these those of its .func files,
/// by name. Errors: InputError.
std::vector<Curve> curves_beside(const std::filesystem::path& model);

}  // namespace cambium
