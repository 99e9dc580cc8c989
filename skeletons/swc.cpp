#include "skeletons/number_text.h"
#include "skeletons/skeleton_io.h"
#include "skeletons/skeleton_rows.h"

namespace cambium {

Skeleton parse_swc(std::string_view text, const std::string& file) {
  std::vector<SkeletonRow> rows;
  LineReader lines(text);
  std::string_view line;
  while (lines.next(line)) {
    const std::vector<TextField> fields = split_at_blanks(line.substr(0, line.find('#')));
    if (fields.empty()) continue;
    const int number = lines.number();
    if (fields.size() != 7)
      throw InputError({file, number, fields.size() > 7 ? fields[7].column : fields.back().column},
                       std::to_string(fields.size()) + " columns", "7: id type x y z radius parent");
    SkeletonRow row;
    row.line = number;
    row.id_column = fields[0].column;
    row.parent_column = fields[6].column;
    row.id = parse_integer(fields[0], file, number, "an id");
    if (row.id < 0) throw InputError({file, number, fields[0].column}, quoted(fields[0].text), "an id of 0 or more");
    parse_integer(fields[1], file, number, "a type");
    for (int axis = 0; axis < 3; ++axis)
      row.node.position[axis] = parse_finite(fields[2 + axis], file, number, "a coordinate");
    row.node.radius = parse_positive(fields[5], file, number, "a radius");
    row.parent = parse_integer(fields[6], file, number, "a parent");
    if (row.parent < -1)
      throw InputError({file, number, fields[6].column}, quoted(fields[6].text), "the id of a node, or -1 at a root");
    rows.push_back(std::move(row));
  }
  return skeleton_from_rows(rows, file);
}

}  // namespace cambium
