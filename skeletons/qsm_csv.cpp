// Cylinder models of scanned trees (quantitative structure models) as SimpleForest, TreeQSM and rTwig export them.
#include "skeletons/number_text.h"
#include "skeletons/skeleton_io.h"
#include "skeletons/skeleton_rows.h"

#include <array>
#include <cctype>
#include <initializer_list>
#include <optional>

namespace cambium {
namespace {

struct Columns {
  std::optional<std::size_t> id, parent, radius, length;
  std::array<std::optional<std::size_t>, 3> start, end, axis;
};

/// Letters and digits in lower case; a unit in brackets is left out.
std::string plain_name(std::string_view name) {
  std::string plain;
  for (const char c : name.substr(0, name.find_first_of("(["))) {
    if (std::isalnum(static_cast<unsigned char>(c)))
      plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return plain;
}

std::optional<std::size_t> find_column(const std::vector<std::string>& names, std::initializer_list<std::string> wanted) {
  for (const std::string& name : wanted)
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == name) return i;
  return std::nullopt;
}

std::array<std::optional<std::size_t>, 3> find_vector(const std::vector<std::string>& names, const std::string& stem) {
  std::array<std::optional<std::size_t>, 3> columns;
  for (int k = 0; k < 3; ++k) {
    const std::string letter(1, "xyz"[k]), number(1, "123"[k]);
    columns[k] = find_column(names, {stem + letter, letter + stem, stem + "point" + letter, stem + number});
  }
  return columns;
}

bool complete(const std::array<std::optional<std::size_t>, 3>& columns) {
  return columns[0] && columns[1] && columns[2];
}

char separator_of(std::string_view header) {
  for (const char c : {',', ';', '\t'})
    if (header.find(c) != std::string_view::npos) return c;
  return ',';
}

Columns read_header(const std::vector<TextField>& fields, const std::string& file, int line) {
  std::vector<std::string> names;
  for (const TextField& field : fields) names.push_back(plain_name(field.text));
  Columns columns;
  columns.id = find_column(names, {"id", "cylinderid", "cylid", "cylinder"});
  columns.parent = find_column(names, {"parentid", "parent", "parentcylinderid", "parentcylinder", "parentcylid"});
  columns.radius = find_column(names, {"radius", "radiuscyl", "r"});
  columns.length = find_column(names, {"length", "cyllength", "cylinderlength"});
  columns.start = find_vector(names, "start");
  columns.end = find_vector(names, "end");
  columns.axis = find_vector(names, "axis");
  const char* missing = !columns.parent                                                              ? "parentID"
                        : !columns.radius                                                            ? "radius"
                        : !complete(columns.start)                                                   ? "startX, startY, startZ"
                        : !complete(columns.end) && !(complete(columns.axis) && columns.length)      ? "endX, endY, endZ"
                                                                                                     : nullptr;
  if (missing)
    throw InputError({file, line, 1}, "a header without " + std::string(missing),
                     "columns parentID, radius, startX..startZ and endX..endZ (or axisX..axisZ and length)");
  return columns;
}

Vec3 read_vector(const std::array<std::optional<std::size_t>, 3>& columns, const std::vector<TextField>& fields,
                 const std::string& file, int line) {
  Vec3 v;
  for (int k = 0; k < 3; ++k) v[k] = parse_finite(fields[*columns[k]], file, line, "a coordinate");
  return v;
}

struct Cylinder {
  Vec3 start, end;
};

/// Cylinders in an order in which parents stand first, as nodes.
Skeleton join_cylinders(const std::vector<SkeletonRow>& rows, const std::vector<Cylinder>& cylinders,
                        const std::vector<std::int32_t>& parents) {
  Skeleton skeleton;
  std::vector<std::int32_t> start_node(rows.size(), -1), end_node(rows.size(), -1);
  const auto add = [&](const Vec3& position, double radius, std::int32_t parent) {
    skeleton.nodes.push_back({position, radius, parent, std::nullopt, std::nullopt});
    return static_cast<std::int32_t>(skeleton.nodes.size()) - 1;
  };
  for (const std::uint32_t i : parents_first(parents)) {
    const Cylinder& cylinder = cylinders[i];
    const double radius = rows[i].node.radius;
    if (parents[i] < 0) {
      start_node[i] = add(cylinder.start, radius, -1);
    } else {
      // A child usually leaves at its parent's end; some exports let it leave at the start.
      const std::int32_t at_end = end_node[parents[i]], at_start = start_node[parents[i]];
      const double to_end = glm::distance(cylinder.start, skeleton.nodes[at_end].position);
      const double to_start = glm::distance(cylinder.start, skeleton.nodes[at_start].position);
      start_node[i] = to_start < to_end ? at_start : at_end;
      if (std::min(to_start, to_end) > radius) start_node[i] = add(cylinder.start, radius, start_node[i]);
    }
    end_node[i] = add(cylinder.end, radius, start_node[i]);
  }
  return skeleton;
}

}  // namespace

Skeleton parse_qsm_csv(std::string_view text, const std::string& file) {
  LineReader lines(text);
  std::string_view line;
  while (lines.next(line) && split_at_blanks(line).empty()) {
  }
  if (split_at_blanks(line).empty()) throw InputError({file, 0, 0}, "an empty file", "a header and one row per cylinder");
  const char separator = separator_of(line);
  const std::vector<TextField> header = split_at(line, separator);
  const Columns columns = read_header(header, file, lines.number());

  std::vector<SkeletonRow> rows;
  std::vector<Cylinder> cylinders;
  bool has_id_zero = false;
  while (lines.next(line)) {
    if (split_at_blanks(line).empty()) continue;
    const int number = lines.number();
    const std::vector<TextField> fields = split_at(line, separator);
    if (fields.size() != header.size())
      throw InputError({file, number, fields[std::min(fields.size() - 1, header.size())].column},
                       std::to_string(fields.size()) + " columns", std::to_string(header.size()) + " as in the header");
    SkeletonRow row;
    row.line = number;
    row.id_column = columns.id ? fields[*columns.id].column : 1;
    row.parent_column = fields[*columns.parent].column;
    row.id = columns.id ? parse_integer(fields[*columns.id], file, number, "an id")
                        : static_cast<std::int64_t>(rows.size()) + 1;  // TreeQSM counts rows from 1
    if (row.id < 0) throw InputError({file, number, row.id_column}, quoted(fields[*columns.id].text), "an id of 0 or more");
    row.parent = parse_integer(fields[*columns.parent], file, number, "a parent");
    row.node.radius = parse_positive(fields[*columns.radius], file, number, "a radius");
    Cylinder cylinder;
    cylinder.start = read_vector(columns.start, fields, file, number);
    if (complete(columns.end)) {
      cylinder.end = read_vector(columns.end, fields, file, number);
    } else {
      const Vec3 axis = read_vector(columns.axis, fields, file, number);
      const double norm = glm::length(axis);
      if (!(norm > 0))
        throw InputError({file, number, fields[*columns.axis[0]].column}, "an axis of length 0", "a direction");
      cylinder.end =
          cylinder.start + axis * (parse_positive(fields[*columns.length], file, number, "a length") / norm);
    }
    has_id_zero = has_id_zero || row.id == 0;
    rows.push_back(std::move(row));
    cylinders.push_back(cylinder);
  }
  if (!has_id_zero)  // TreeQSM writes parent 0 at the root
    for (SkeletonRow& row : rows)
      if (row.parent == 0) row.parent = -1;
  return join_cylinders(rows, cylinders, link_parents(rows, file));
}

}  // namespace cambium
