#include "lsystem/open_cylinders.h"

#include <utility>

namespace cambium {

OpenCylinders::Number OpenCylinders::append(OpenCylinder cylinder) {
  open_.push_back(std::move(cylinder));
  return static_cast<Number>(open_.size() - 1);
}

OpenCylinders::Number OpenCylinders::open(OpenCylinder cylinder, Number present) {
  if (present != kNone && is_at(present, cylinder.depth)) close(present);
  return append(std::move(cylinder));
}

OpenCylinders::Number OpenCylinders::branch(Number number, std::size_t depth) {
  if (is_at(number, depth)) return number;
  OpenCylinder out = (*this)[number];
  out.pen.lateral = true;
  out.depth = depth;
  return append(std::move(out));
}

}  // namespace cambium
