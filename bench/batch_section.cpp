// Sums of cones and chains in one cell through the public batches, with the machine's own limit measured beside them.
#include <cmath>
#include <deque>

#include "bench/batch_points.h"
#include "bench/cell_shapes.h"
#include "bench/cone_yardstick.h"
#include "bench/sections.h"

namespace cambium::bench {
namespace {

constexpr std::size_t kYardstickPoints = 2048;  // with their values 32 kB: in the first cache
constexpr int kCounts[] = {1, 2, 6, 12};
constexpr int kEdges[] = {9, 16};

PrunedField sum_of_cones(int count) {
  RandomNumbers random(1);
  BlobTreeBuilder builder;
  Sum sum;
  for (int i = 0; i < count; ++i) sum.children.push_back(builder.add(cone_through_cell(random)));
  const NodeId root = builder.add(sum);
  return pruned_to_cell(builder.build(root), static_cast<std::size_t>(count));
}

/// The yardstick's own cone, through the cell like the others. It has to give the library's values: else it is no yardstick.
YardstickCone checked_yardstick(BatchPoints& points) {
  RandomNumbers random(1);
  const Cone cone = cone_through_cell(random);
  const YardstickCone yardstick = make_yardstick_cone(
      {cone.base.x, cone.base.y, cone.base.z}, {cone.tip.x, cone.tip.y, cone.tip.z}, cone.radius_base, cone.radius_tip);
  cone_yardstick(yardstick, points.x().data(), points.y().data(), points.z().data(), points.f_data(), kYardstickPoints);
  BlobTreeBuilder builder;
  const NodeId root = builder.add(cone);
  const Field field(builder.build(root));
  for (std::size_t i = 0; i < kYardstickPoints; ++i) {
    const Vec3 p = kCell.center() + Vec3(points.x()[i], points.y()[i], points.z()[i]);
    if (std::abs(field.value(p) - points.f()[i]) > 1e-5) throw std::logic_error("the yardstick differs from the library");
  }
  return yardstick;
}

/// The same field's values and samples over batches of both sizes, added to what is measured.
class Measured {
 public:
  Measured(std::string name, PrunedField field, Measurements& measurements)
      : name_(std::move(name)), field_(std::move(field)) {
    for (const int edge : kEdges) {
      BatchPoints& points = points_.emplace_back(kCell, edge);
      measurements.add(value_name(edge), [this, &points] { points.values(evaluator_, field_); });
      measurements.add(sample_name(edge), [this, &points] { points.samples(evaluator_, field_); });
    }
  }
  Measured(const Measured&) = delete;
  Measured& operator=(const Measured&) = delete;

  static double points(int edge) { return static_cast<double>(edge) * edge * edge; }
  double value_ns(const Measurements& measured, int edge) const { return measured.ns(value_name(edge)) / points(edge); }
  double sample_ns(const Measurements& measured, int edge) const { return measured.ns(sample_name(edge)) / points(edge); }

 private:
  std::string value_name(int edge) const { return name_ + " values " + std::to_string(edge); }
  std::string sample_name(int edge) const { return name_ + " samples " + std::to_string(edge); }

  std::string name_;
  PrunedField field_;
  std::deque<BatchPoints> points_;
  Evaluator evaluator_;
};

std::string counted(int count, const std::string& thing, int edge) {
  return std::to_string(count) + " " + thing + (count > 1 ? "s, " : ", ") + std::to_string(edge * edge * edge) + " points";
}

}  // namespace

void batch_section(Report& report, const Pace& pace) {
  Measurements measurements(pace);
  BatchPoints yardstick_points(kCell, 16);
  const YardstickCone yardstick = checked_yardstick(yardstick_points);
  measurements.add("yardstick", [&] {
    cone_yardstick(yardstick, yardstick_points.x().data(), yardstick_points.y().data(), yardstick_points.z().data(),
                   yardstick_points.f_data(), kYardstickPoints);
  });
  std::deque<Measured> cones, chains;
  for (const int count : kCounts) {
    cones.emplace_back("cones " + std::to_string(count), sum_of_cones(count), measurements);
    chains.emplace_back("chain " + std::to_string(count), chain_pruned_to_cell(RandomNumbers(1), count), measurements);
  }
  measurements.run();
  const double limit = measurements.ns("yardstick") / kYardstickPoints;

  report.heading("The machine's limit: a bare cone, 2048 points in cache, vector set " + std::string(yardstick_target()));
  report.add({.what = "yardstick", .figure = limit, .unit = "ns/sample"});

  report.heading("Sums of cones in a cell: values, per sample and cone");
  for (const int edge : kEdges)
    for (std::size_t i = 0; i < std::size(kCounts); ++i) {
      const double ns = cones[i].value_ns(measurements, edge) / kCounts[i];
      report.add({.what = counted(kCounts[i], "cone", edge),
                  .figure = ns,
                  .unit = "ns/sample/cone",
                  .ratio = limit / ns,
                  .ratio_to = "yardstick's rate",
                  .target = at_least(0.5)});
      if (kCounts[i] == 6)  // 200 M points a second is the figure for an AVX-512 core
        report.add({.what = counted(6, "cone", edge) + ", all at once",
                    .figure = 6 * ns,
                    .unit = "ns/point",
                    .target = at_most(5)});
    }

  report.heading("Sums of cones in a cell: values with gradients, per sample and cone");
  for (const int edge : kEdges)
    for (std::size_t i = 0; i < std::size(kCounts); ++i) {
      const double ns = cones[i].sample_ns(measurements, edge) / kCounts[i];
      report.add({.what = counted(kCounts[i], "cone", edge),
                  .figure = ns,
                  .unit = "ns/sample/cone",
                  .ratio = ns * kCounts[i] / cones[i].value_ns(measurements, edge),
                  .ratio_to = "values' time",
                  .target = at_most(2)});
    }

  report.heading("A chain in a cell, per sample and segment");
  for (const int edge : kEdges)
    for (std::size_t i = 0; i < std::size(kCounts); ++i) {
      const double value = chains[i].value_ns(measurements, edge), sample = chains[i].sample_ns(measurements, edge);
      report.add({.what = counted(kCounts[i], "segment", edge),
                  .figure = value / kCounts[i],
                  .unit = "ns/sample/segment",
                  .ratio = value / cones[i].value_ns(measurements, edge),
                  .ratio_to = "cones' time",
                  .target = at_most(1.3)});
      report.add({.what = counted(kCounts[i], "segment", edge) + ", gradients",
                  .figure = sample / kCounts[i],
                  .unit = "ns/sample/segment",
                  .ratio = sample / value,
                  .ratio_to = "values' time"});
    }
}

}  // namespace cambium::bench
