#include "lsystem/curve.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <system_error>
#include <utility>

#include "lsystem/preprocessor.h"
#include "lsystem/view_file.h"

namespace cambium {
namespace {

constexpr std::size_t kOrder = 4;  // of a cubic
constexpr std::size_t kMaxPoints = 10'000;

// Lines of a text with their numbers, blank ones left out.
class Lines {
 public:
  Lines(std::string_view text, std::string file) : text_(text), file_(std::move(file)) { advance(); }

  bool at_end() const { return at_end_; }
  std::string_view line() const { return line_; }
  void advance() {
    do {
      if (next_ >= text_.size()) {
        at_end_ = true;
        line_ = {};
        return;
      }
      const std::size_t end = std::min(text_.find('\n', next_), text_.size());
      line_ = text_.substr(next_, end - next_);
      while (!line_.empty() && (line_.back() == '\r' || line_.back() == ' ' || line_.back() == '\t')) line_.remove_suffix(1);
      next_ = end + 1;
      ++number_;
    } while (line_.empty());
  }

  /// What stands behind `key` at the beginning of the line; nullopt if it begins with something else.
  std::optional<std::string> value(std::string_view key) const {
    if (line_.substr(0, key.size()) != key) return std::nullopt;
    const std::size_t begin = std::min(line_.find_first_not_of(" \t", key.size()), line_.size());
    return std::string(line_.substr(begin));
  }
  /// The same of a line that has to be there; goes on to the next.
  std::string take(std::string_view key) {
    auto found = value(key);
    if (!found) fail("'" + std::string(key) + "'");
    advance();
    return *found;
  }
  std::size_t take_count(std::string_view key, std::size_t least, std::size_t most) {
    const auto text = value(key);
    if (!text) fail("'" + std::string(key) + "'");
    char* end = nullptr;
    const double count = std::strtod(text->c_str(), &end);
    if (end == text->c_str() || *end != '\0' ||
        !(count >= static_cast<double>(least) && count <= static_cast<double>(most)) || count != std::floor(count))
      fail("a whole number from " + std::to_string(least) + " to " + std::to_string(most));
    advance();
    return static_cast<std::size_t>(count);
  }

  [[noreturn]] void fail(std::string expected) const {
    const std::string found(line_.substr(0, 40));
    throw InputError({file_, static_cast<int>(number_), 1}, at_end_ ? "the end of the file" : "'" + found + "'",
                     std::move(expected));
  }
  const std::string& file() const { return file_; }

 private:
  std::string_view text_;
  std::string file_;
  std::string_view line_;
  std::size_t next_ = 0;
  std::size_t number_ = 0;
  bool at_end_ = false;
};

// `x y`, or `x y multiplicity`: cpfg repeats the point.
void read_point(Lines& lines, std::vector<CurvePoint>& out) {
  const std::string line(lines.line());
  double numbers[3] = {0, 0, 1};
  const char* at = line.c_str();
  int count = 0;
  for (; count < 3; ++count) {
    char* end = nullptr;
    const double number = std::strtod(at, &end);
    if (end == at) break;
    numbers[count] = number;
    at = end;
  }
  const double times = numbers[2];
  if (count < 2 || *at != '\0' || !std::isfinite(numbers[0]) || !std::isfinite(numbers[1]) || !(times >= 1 && times <= 100))
    lines.fail("the x and y of a point");
  lines.advance();
  out.insert(out.end(), static_cast<std::size_t>(times), {numbers[0], numbers[1]});
}

std::vector<CurvePoint> read_points(Lines& lines) {
  std::vector<CurvePoint> points;
  for (std::size_t left = lines.take_count("points:", kOrder, kMaxPoints); left > 0; --left) read_point(lines, points);
  return points;
}

Curve read_ranged(Lines& lines) {
  lines.take("range:");
  std::vector<CurvePoint> points = read_points(lines);
  return Curve(std::filesystem::path(lines.file()).stem().string(), std::move(points), 0);
}

// Lines of an editor's own (a background picture, markers, flip) say nothing of the curve.
Curve read_versioned(Lines& lines) {
  if (lines.take("fver") != "1 1") throw InputError({lines.file(), 0, 0}, "a function of another version", "'fver 1 1'");
  std::string name = lines.take("name:");
  const std::size_t samples = lines.take_count("samples:", 0, 1'000'000);
  while (!lines.at_end() && !lines.value("points:") && !lines.value("fver")) lines.advance();
  std::vector<CurvePoint> points = read_points(lines);
  return Curve(std::move(name), std::move(points), samples);
}

void append_curves(const std::filesystem::path& file, const SourceLocation& wanted_from, std::vector<Curve>& out) {
  const std::string text = read_source(file, wanted_from);
  for (Curve& curve : read_curves(text, file)) out.push_back(std::move(curve));
}

}  // namespace

Curve::Curve(std::string name, std::vector<CurvePoint> points, std::size_t samples)
    : name_(std::move(name)), points_(std::move(points)) {
  if (samples <= 2) return;
  for (std::size_t i = 0; i < samples; ++i)
    table_.push_back(solved(static_cast<double>(i) / static_cast<double>(samples - 1)));
}

// De Boor's algorithm over the knots 0,0,0,0,1,2,..,n,n,n,n.
CurvePoint Curve::at(double parameter) const {
  const std::size_t spans = points_.size() - kOrder + 1;
  const double u = parameter * static_cast<double>(spans);
  const std::size_t span = std::min(static_cast<std::size_t>(u), spans - 1);
  const auto knot = [&](std::size_t i) {  // i counts from the first of the four equal ones
    return static_cast<double>(i < kOrder ? 0 : std::min(i - kOrder + 1, spans));
  };
  CurvePoint d[kOrder];
  for (std::size_t j = 0; j < kOrder; ++j) d[j] = points_[span + j];
  for (std::size_t r = 1; r < kOrder; ++r)
    for (std::size_t j = kOrder - 1; j >= r; --j) {
      const double low = knot(span + j), high = knot(span + j + kOrder - r);
      const double t = (u - low) / (high - low);
      d[j] = {d[j - 1].x + t * (d[j].x - d[j - 1].x), d[j - 1].y + t * (d[j].y - d[j - 1].y)};
    }
  return d[kOrder - 1];
}

// Halving, as in cpfg, but down to the last bit.
double Curve::solved(double x) const {
  if (x <= at(0).x) return at(0).y;
  if (x >= at(1).x) return at(1).y;
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (at(middle).x > x ? high : low) = middle;
  }
  return at(0.5 * (low + high)).y;
}

double Curve::value(double x) const {
  const double clamped = std::clamp(x, 0.0, 1.0);
  if (table_.empty()) return solved(clamped);
  const double index = clamped * static_cast<double>(table_.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(index), table_.size() - 2);
  const double t = index - static_cast<double>(below);
  return table_[below] + t * (table_[below + 1] - table_[below]);
}

std::vector<Curve> read_curves(std::string_view text, const std::filesystem::path& file) {
  Lines lines(text, file.string());
  std::vector<Curve> out;
  if (lines.value("range:")) {
    out.push_back(read_ranged(lines));
  } else if (lines.value("funcgalleryver")) {
    lines.advance();
    for (std::size_t left = lines.take_count("items:", 0, kMaxPoints); left > 0; --left)
      out.push_back(read_versioned(lines));
  } else if (lines.value("fver")) {
    out.push_back(read_versioned(lines));
  } else {
    lines.fail("'fver', 'funcgalleryver' or 'range:'");
  }
  return out;
}

std::vector<Curve> curves_beside(const std::filesystem::path& model) {
  std::vector<Curve> out;
  if (const auto view = view_file_of(model))
    for (const ViewFile::Function& function : read_view_file(read_source(*view, {view->string(), 0, 0}), *view).functions)
      append_curves(function.file, function.place, out);
  if (!out.empty()) return out;
  const std::filesystem::path folder = model.parent_path().empty() ? "." : model.parent_path();
  for (const char* extension : {".fset", ".func"}) {
    for (const auto& file : files_with(folder, extension)) append_curves(file, {file.string(), 0, 0}, out);
    if (!out.empty()) break;
  }
  return out;
}

}  // namespace cambium
