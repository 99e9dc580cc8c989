#include "lsystem/patch_surface.h"

#include <array>
#include <utility>

#include "lsystem/preprocessor.h"
#include "lsystem/value_reader.h"

namespace cambium {
namespace {

constexpr std::uint32_t kCuts = 8;
constexpr std::size_t kMaxPatches = 10'000;

using Row = std::array<Vec3, 4>;
using Patch = std::array<Row, 4>;

/// From the file's coordinates to the shape's.
struct Fitting {
  Vec3 contact{0.0};
  Vec3 left, heading, up;
  double scale = 1;

  Vec3 operator()(const Vec3& p) const {
    const Vec3 from_contact = scale * (p - contact);
    return {glm::dot(from_contact, left), glm::dot(from_contact, heading), glm::dot(from_contact, up)};
  }
};

Vec3 on_curve(const Row& c, double t) {
  const double s = 1 - t;
  return s * s * s * c[0] + 3 * s * s * t * c[1] + 3 * s * t * t * c[2] + t * t * t * c[3];
}

Vec3 on_patch(const Patch& patch, double s, double t) {
  return on_curve({on_curve(patch[0], t), on_curve(patch[1], t), on_curve(patch[2], t), on_curve(patch[3], t)}, s);
}

/// Without triangles that have no area: many a patch ends in a point.
void append_triangle(OrganShape& shape, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const auto& v = shape.vertices;
  if (v[a] != v[b] && v[b] != v[c] && v[c] != v[a]) shape.triangles.push_back({a, b, c});
}

void append_patch(OrganShape& shape, const Patch& patch) {
  const auto first = static_cast<std::uint32_t>(shape.vertices.size());
  for (std::uint32_t i = 0; i <= kCuts; ++i)
    for (std::uint32_t j = 0; j <= kCuts; ++j)
      shape.vertices.push_back(on_patch(patch, static_cast<double>(i) / kCuts, static_cast<double>(j) / kCuts));
  const auto vertex = [&](std::uint32_t i, std::uint32_t j) { return first + i * (kCuts + 1) + j; };
  for (std::uint32_t i = 0; i < kCuts; ++i)
    for (std::uint32_t j = 0; j < kCuts; ++j) {
      append_triangle(shape, vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
      append_triangle(shape, vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
}

class SurfaceReader {
 public:
  explicit SurfaceReader(const SourceText& source) : values_(source, ValueReader::Layout::kFree) {}

  PatchSurface read(std::string name, double size) {
    PatchSurface out;
    out.shape.name = std::move(name);
    const Fitting fitting = header(size, out.end_point);
    std::size_t patches = 0;
    do {
      if (++patches > kMaxPatches) values_.fail("at most 10000 patches");
      append_patch(out.shape, patch(fitting));
    } while (!values_.at_end());
    return out;
  }

 private:
  Fitting header(double size, Vec3& end_point) {
    if (values_.accept("VERSION")) values_.word();
    for (int i = 0; i < 6; ++i) values_.number("six numbers of a bounding box");
    if (values_.accept("PRECISION")) precision();
    Fitting out;
    values_.expect("CONTACT");
    values_.expect("POINT");
    out.contact = point();
    values_.expect("END");
    values_.expect("POINT");
    end_point = point();
    values_.expect("HEADING");
    out.heading = unit(point(), "a heading");
    values_.expect("UP");
    const Vec3 up = point();
    out.left = unit(glm::cross(out.heading, up), "an up vector across the heading");
    out.up = glm::cross(out.left, out.heading);
    values_.expect("SIZE:");
    out.scale = size / values_.positive("a size");
    end_point = out(end_point);
    return out;
  }

  void precision() {
    for (const char* of : {"S:", "T:"}) {
      values_.expect(of);
      values_.number("a number of steps");
    }
  }

  Vec3 point() {
    Vec3 out(0.0);
    glm::length_t axis = 0;
    for (const char* name : {"X:", "Y:", "Z:"}) {
      values_.expect(name);
      out[axis++] = values_.number("a coordinate");
    }
    return out;
  }

  /// Of the line just read.
  Vec3 unit(const Vec3& v, const char* what) {
    const double length = glm::length(v);
    if (!(length > 1e-6 && length < 1e100)) values_.fail(std::string(what) + " before this");
    return v / length;
  }

  Patch patch(const Fitting& fitting) {
    values_.word("the name of a patch");
    for (const char* line : {"TOP", "AL:", "L:", "BL:"}) {  // colours, and the patches around it
      values_.expect(line);
      values_.next_line();
    }
    Patch out;
    for (Row& row : out)
      for (Vec3& p : row) {
        p = fitting(values_.vector("the x, y and z of a control point"));
        if (!(glm::length(p) < 1e100)) values_.fail("a control point within 1e100 sizes of the contact point before this");
      }
    return out;
  }

  ValueReader values_;
};

}  // namespace

PatchSurface read_patch_surface(std::string_view text, const std::filesystem::path& file, std::string name, double size) {
  const SourceText source = preprocess(text, file);
  return SurfaceReader(source).read(std::move(name), size);
}

}  // namespace cambium
