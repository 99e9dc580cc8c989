#include "cli/points_csv.h"

#include <cctype>
#include <cstdio>

#include "cli/read_text.h"
#include "cli/units.h"

namespace cambium {
namespace {

/// One row. column counts characters from 1.
Vec3 parse_row(std::string_view row, SourceLocation at) {
  Vec3 point{0.0};
  std::size_t begin = 0;
  int fields = 0;
  while (true) {
    const std::size_t end = std::min(row.find(',', begin), row.size());
    at.column = static_cast<int>(begin) + 1;
    if (fields == 3) throw InputError(at, "more than three columns", "x,y,z");
    point[fields++] = parse_number(row.substr(begin, end - begin), at);
    if (end == row.size()) break;
    begin = end + 1;
  }
  at.column = static_cast<int>(row.size()) + 1;
  if (fields < 3) throw InputError(at, std::to_string(fields) + (fields == 1 ? " column" : " columns"), "x,y,z");
  return point;
}

bool is_header(std::string_view row) {
  std::string letters;
  for (const char c : row)
    if (c != ' ' && c != '\t' && c != '"') letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return letters == "x,y,z";
}

}  // namespace

std::vector<Vec3> read_points(const std::filesystem::path& path) {
  const std::string text = read_text(path);
  std::vector<Vec3> points;
  SourceLocation at{path.string()};
  bool first = true;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view row(text.data() + begin, end - begin);
    begin = end + 1;
    ++at.line;
    if (row.ends_with('\r')) row.remove_suffix(1);
    if (row.find_first_not_of(" \t") == std::string_view::npos) continue;
    if (!(first && is_header(row))) points.push_back(parse_row(row, at));
    first = false;
  }
  return points;
}

std::string samples_as_csv(const std::vector<Vec3>& points, const std::vector<Sample>& samples) {
  std::string text = "x,y,z,f,gx,gy,gz\n";
  char row[256];
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    const Sample& s = samples[i];
    const int length = std::snprintf(row, sizeof row, "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", p.x, p.y, p.z, s.value,
                                     s.gradient.x, s.gradient.y, s.gradient.z);
    text.append(row, static_cast<std::size_t>(length));
  }
  return text;
}

}  // namespace cambium
