// Batches of every primitive and every operator in one cell.
#include <cmath>
#include <deque>
#include <functional>

#include "bench/batch_points.h"
#include "bench/cell_shapes.h"
#include "bench/sections.h"

namespace cambium::bench {
namespace {

constexpr int kEdge = 9;
constexpr double kPoints = kEdge * kEdge * kEdge;
constexpr double kRadius = kBranchRadius;

using Builder = BlobTreeBuilder;
using Random = RandomNumbers;

/// A node through the cell, and the number of primitives that it and its children are.
struct Subject {
  const char* name;
  std::size_t atoms;
  std::function<NodeId(Builder&, Random&)> add;
};

NodeId add_cone(Builder& builder, Random& random) { return builder.add(cone_through_cell(random)); }
std::vector<NodeId> two_cones(Builder& builder, Random& random) {
  const NodeId first = add_cone(builder, random);
  return {first, add_cone(builder, random)};
}

const Subject kPrimitives[] = {
    {"cone", 1, add_cone},
    {"round_cone", 1,
     [](Builder& b, Random& r) {
       const BranchLine line = branch_line(r);
       return b.add(RoundCone{line.middle - 0.15 * line.along, line.middle + 0.15 * line.along, 1.2 * kRadius, kRadius, 1});
     }},
    {"chain of 3 segments", 3, [](Builder& b, Random& r) { return b.add(chain_through_cell(r, 3, 0.06)); }},
    {"flare of 3 segments", 3,
     [](Builder& b, Random& r) {
       const Chain chain = chain_through_cell(r, 3, 0.06);
       const Vec3 base = chain.nodes.front().position, axis = chain.nodes.back().position - base;
       return b.add(Flare{chain.nodes, base, axis, 2 * glm::length(axis), 0.3, 0.6, {{0, 1}, {1, 1}, {2, 1}, {4, 1}}});
     }},
    {"sphere", 1,
     [](Builder& b, Random& r) {
       return b.add(Sphere{kRadius * r.direction(), kRadius, 1});
     }},
    {"capsule", 1,
     [](Builder& b, Random& r) {
       const BranchLine line = branch_line(r);
       return b.add(Capsule{line.middle - 0.15 * line.along, line.middle + 0.15 * line.along, kRadius, 1});
     }},
    {"disc", 1,
     [](Builder& b, Random& r) {
       return b.add(Disc{0.08 * r.direction(), r.direction(), kRadius, kRadius, 1});
     }},
    {"torus", 1,
     [](Builder& b, Random& r) {
       return b.add(Torus{0.1 * r.direction(), r.direction(), 0.1, kRadius, 1});
     }},
    {"box", 1,
     [](Builder& b, Random& r) {
       const Vec3 axis = r.direction();
       const double half = 0.4;  // of the angle it is turned by
       return b.add(RotatedBox{0.07 * r.direction(),
                               Vec3(0.03, 0.02, 0.04),
                               {std::cos(half), std::sin(half) * axis.x, std::sin(half) * axis.y, std::sin(half) * axis.z},
                               kRadius,
                               1});
     }},
    {"half_space (intersection with a cone)", 2,
     [](Builder& b, Random& r) {
       const NodeId cone = add_cone(b, r);
       const Vec3 normal = r.direction();
       return b.add(Intersection{{cone, b.add(HalfSpace{0.01 * normal, normal, 0.05 * kRadius})}});
     }},
};

const Subject kOperators[] = {
    {"sum of 2 cones", 2, [](Builder& b, Random& r) { return b.add(Sum{two_cones(b, r)}); }},
    {"union of 2 cones", 2, [](Builder& b, Random& r) { return b.add(Union{two_cones(b, r)}); }},
    {"intersection of 2 cones", 2, [](Builder& b, Random& r) { return b.add(Intersection{two_cones(b, r)}); }},
    {"difference of 2 cones", 2, [](Builder& b, Random& r) { return b.add(Difference{two_cones(b, r)}); }},
    {"ricci of 2 cones", 2,
     [](Builder& b, Random& r) {
       return b.add(Ricci{two_cones(b, r), 2.5});
     }},
    {"contact of 2 cones", 2,
     [](Builder& b, Random& r) {
       return b.add(Contact{two_cones(b, r), kIso, 1.5});
     }},
    {"fork: a cone bears a cone", 2,
     [](Builder& b, Random& r) {
       const std::vector<NodeId> both = two_cones(b, r);
       return b.add(Fork{both[0], {{both[1], Vec3(0.01, 0, -0.02), r.direction(), 0.6 * kRadius, 4 * kRadius}}, kIso, 1.5});
     }},
    {"scale_field of a cone", 1,
     [](Builder& b, Random& r) {
       return b.add(ScaleField{0.8, add_cone(b, r)});
     }},
    {"transform of a cone", 1,
     [](Builder& b, Random& r) {
       const double angle = 0.2, scale = 1.1;
       Mat4 matrix(1.0);
       matrix[0] = scale * glm::dvec4(std::cos(angle), std::sin(angle), 0, 0);
       matrix[1] = scale * glm::dvec4(-std::sin(angle), std::cos(angle), 0, 0);
       matrix[2] = scale * glm::dvec4(0, 0, 1, 0);
       matrix[3] = glm::dvec4(0.01, -0.01, 0.005, 1);
       return b.add(Transform{matrix, add_cone(b, r)});
     }},
    {"bend of a cone", 1,
     [](Builder& b, Random& r) {
       const BranchLine line = branch_line(r);
       const double angle = 0.4, arc = 0.3 * angle / 2 / std::sin(angle / 2);
       const Vec3 from = line.middle - 0.15 * line.along;
       const NodeId straight = b.add(Cone{from, from + arc * line.along, 1.2 * kRadius, kRadius, 1});
       return b.add(Bend{from, line.middle + 0.15 * line.along, r.across(line.along), angle, straight});
     }},
    {"twist of a cone", 1,
     [](Builder& b, Random& r) {
       return b.add(Twist{Vec3(0.0), r.direction(), 2.0, add_cone(b, r)});
     }},
    {"taper of a cone", 1,
     [](Builder& b, Random& r) {
       return b.add(Taper{Vec3(0.0), r.direction(), -0.1, 1.1, 0.1, 0.9, add_cone(b, r)});
     }},
};

/// One subject's field and its batch.
class Measured {
 public:
  Measured(const Subject& subject, Measurements& measurements) : subject_(subject), points_(kCell, kEdge) {
    Random random(7);
    Builder builder;
    const NodeId root = subject.add(builder, random);
    field_ = pruned_to_cell(builder.build(root), subject.atoms);
    measurements.add(value_name(), [this] { points_.values(evaluator_, field_); });
    measurements.add(sample_name(), [this] { points_.samples(evaluator_, field_); });
  }
  Measured(const Measured&) = delete;
  Measured& operator=(const Measured&) = delete;

  double value_ns(const Measurements& measured) const { return measured.ns(value_name()) / kPoints; }
  double sample_ns(const Measurements& measured) const { return measured.ns(sample_name()) / kPoints; }
  const Subject& subject() const { return subject_; }

 private:
  std::string value_name() const { return std::string(subject_.name) + " values"; }
  std::string sample_name() const { return std::string(subject_.name) + " samples"; }

  const Subject& subject_;
  PrunedField field_;
  BatchPoints points_;
  Evaluator evaluator_;
};

}  // namespace

void node_section(Report& report, const Pace& pace) {
  Measurements measurements(pace);
  std::deque<Measured> primitives, operators;
  for (const Subject& subject : kPrimitives) primitives.emplace_back(subject, measurements);
  for (const Subject& subject : kOperators) operators.emplace_back(subject, measurements);
  measurements.run();

  const double cone = primitives.front().value_ns(measurements);
  const auto add_rows = [&](const Measured& measured) {
    const double value = measured.value_ns(measurements), sample = measured.sample_ns(measurements);
    report.add({.what = measured.subject().name,
                .figure = value,
                .unit = "ns/point",
                .ratio = value / (cone * static_cast<double>(measured.subject().atoms)),
                .ratio_to = "as many cones' time"});
    report.add({.what = std::string(measured.subject().name) + ", gradients",
                .figure = sample,
                .unit = "ns/point",
                .ratio = sample / value,
                .ratio_to = "values' time"});
  };
  report.heading("Primitives in a cell, batches of 729 points");
  for (const Measured& measured : primitives) add_rows(measured);
  report.heading("Operators in a cell, with their children, batches of 729 points");
  for (const Measured& measured : operators) add_rows(measured);
}

}  // namespace cambium::bench
