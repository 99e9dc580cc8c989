#include "polygonize/narrow_band.h"

#include "blobtree/input_error.h"
#include "tests/polygonize/sample_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <map>

namespace cambium {
namespace {

using Leaves = std::vector<std::unique_ptr<BandLeaf>>;

struct Voxel {
  Vec3 at;
  double distance;
};

std::vector<Voxel> active_voxels(const Field& field, double voxel, double half_width = 3, int threads = 0) {
  RunOptions run;
  run.threads = threads;
  std::vector<Voxel> result;
  const Leaves leaves = narrow_band(field, voxel, half_width, run).value();
  for (const auto& leaf : leaves)
    for (int i = 0; i < 512; ++i)
      if (leaf->active[i]) {
        const Vec3 index(leaf->first[0] + (i >> 6), leaf->first[1] + (i >> 3 & 7), leaf->first[2] + (i & 7));
        result.push_back({voxel * index, leaf->distances[i]});
      }
  return result;
}

// Largest errors in voxels: of those within a voxel of the surface, and of all.
std::pair<double, double> errors(const std::vector<Voxel>& voxels, double voxel, const std::function<double(const Vec3&)>& truth) {
  double next_to_it = 0, anywhere = 0;
  for (const Voxel& v : voxels) {
    const double true_distance = truth(v.at), error = std::abs(v.distance - true_distance) / voxel;
    anywhere = std::max(anywhere, error);
    if (std::abs(true_distance) < voxel) next_to_it = std::max(next_to_it, error);
  }
  return {next_to_it, anywhere};
}

// Distance from points where the surface crosses the edges of a lattice twelve times finer than voxels, by trying all near by.
class Cloud {
 public:
  Cloud(const Field& field, double voxel) : voxel_(voxel) {
    const Box bounds = field.bounds();
    const auto first = cell(bounds.lo), last = cell(bounds.hi);
    for (int x = first[0]; x <= last[0]; ++x)
      for (int y = first[1]; y <= last[1]; ++y)
        for (int z = first[2]; z <= last[2]; ++z) {
          const Box box{voxel * Vec3(x, y, z), voxel * Vec3(x + 1, y + 1, z + 1)};
          if (field.interval(box).contains(kIso)) add_crossings(field.prune(box.padded(0.1 * voxel)), box.lo);
        }
  }
  double distance(const Vec3& p) const {
    double best = kInfinity;
    const auto at = cell(p);
    for (int x = -4; x <= 4; ++x)
      for (int y = -4; y <= 4; ++y)
        for (int z = -4; z <= 4; ++z) {
          const auto found = cells_.find({at[0] + x, at[1] + y, at[2] + z});
          if (found == cells_.end()) continue;
          for (const Vec3& q : found->second) best = std::min(best, glm::distance(p, q));
        }
    return best;
  }

 private:
  std::array<int, 3> cell(const Vec3& p) const {
    return {int(std::floor(p.x / voxel_)), int(std::floor(p.y / voxel_)), int(std::floor(p.z / voxel_))};
  }
  void add_crossings(const PrunedField& pruned, const Vec3& corner) {
    constexpr int kFiner = 12;
    const double step = voxel_ / kFiner;
    const auto at = [&](int x, int y, int z) { return corner + step * Vec3(x, y, z); };
    std::vector<double> values;
    for (int x = 0; x <= kFiner; ++x)
      for (int y = 0; y <= kFiner; ++y)
        for (int z = 0; z <= kFiner; ++z) values.push_back(evaluator_.value(pruned, at(x, y, z)) - kIso);
    const auto value = [&](int x, int y, int z) { return values[static_cast<std::size_t>((x * (kFiner + 1) + y) * (kFiner + 1) + z)]; };
    const auto cross = [&](const Vec3& a, const Vec3& b, double f_a, double f_b) {
      if ((f_a >= 0) == (f_b >= 0)) return;
      const Vec3 p = glm::mix(a, b, f_a / (f_a - f_b));
      cells_[cell(p)].push_back(p);
    };
    for (int x = 0; x <= kFiner; ++x)
      for (int y = 0; y <= kFiner; ++y)
        for (int z = 0; z <= kFiner; ++z) {
          if (x < kFiner) cross(at(x, y, z), at(x + 1, y, z), value(x, y, z), value(x + 1, y, z));
          if (y < kFiner) cross(at(x, y, z), at(x, y + 1, z), value(x, y, z), value(x, y + 1, z));
          if (z < kFiner) cross(at(x, y, z), at(x, y, z + 1), value(x, y, z), value(x, y, z + 1));
        }
  }
  Evaluator evaluator_;
  double voxel_;
  std::map<std::array<int, 3>, std::vector<Vec3>> cells_;
};

TEST(NarrowBand, ASphereIsRightToATenthOfAVoxel) {
  const Vec3 center(0.03, -0.02, 0.01);
  for (const double voxel : {0.05, 0.2, 0.4}) {
    const auto voxels = active_voxels(testing::sphere_field(1, center), voxel);
    const auto [next_to_it, anywhere] =
        errors(voxels, voxel, [&](const Vec3& p) { return glm::distance(p, center) - 1; });
    SCOPED_TRACE(voxel);
    EXPECT_LT(next_to_it, 0.01);
    EXPECT_LT(anywhere, voxel > 0.3 ? 0.2 : 0.05);   // in the middle of a ball of few voxels many points are equally near
  }
}

TEST(NarrowBand, EveryVoxelWithinTheBandIsActiveAndNoOther) {
  const Vec3 center(0.03, -0.02, 0.01);
  for (const double half_width : {1.0, 2.5, 4.0}) {
    std::size_t expected = 0;
    const double voxel = 0.07;
    for (int x = -25; x <= 25; ++x)
      for (int y = -25; y <= 25; ++y)
        for (int z = -25; z <= 25; ++z)
          expected += std::abs(glm::distance(voxel * Vec3(x, y, z), center) - 1) < half_width * voxel;
    const auto voxels = active_voxels(testing::sphere_field(1, center), voxel, half_width);
    EXPECT_NEAR(double(voxels.size()), double(expected), 0.002 * double(expected)) << half_width;
  }
}

TEST(NarrowBand, ATorusIsRightToATenthOfAVoxel) {
  const Vec3 axis = glm::normalize(Vec3(1, 2, 3));
  for (const double voxel : {0.02, 0.1}) {
    const auto voxels = active_voxels(testing::torus_field(), voxel);
    const auto [next_to_it, anywhere] = errors(voxels, voxel, [&](const Vec3& p) {
      const Vec3 from = p - Vec3(0.1, 0, 0);
      const double along = glm::dot(from, axis);
      return std::hypot(glm::length(from - along * axis) - 1, along) - 0.3;
    });
    SCOPED_TRACE(voxel);
    EXPECT_LT(next_to_it, 0.03);
    EXPECT_LT(anywhere, 0.1);
  }
}

double signed_distance(const Field& field, const Cloud& cloud, const Vec3& p) {
  return field.value(p) >= kIso ? -cloud.distance(p) : cloud.distance(p);
}

TEST(NarrowBand, CutsAndReentrantCreasesAreRightToATenthOfAVoxel) {
  BlobTreeBuilder builder;
  const NodeId left = builder.add(Sphere{Vec3(-0.3, 0, 0), 0.7, 1}), right = builder.add(Sphere{Vec3(0.5, 0.1, 0), 0.6, 1});
  const NodeId both = builder.add(Union{{left, right}});
  const std::pair<const char*, Field> fields[] = {{"union", Field(builder.build(both))}, {"cut box", testing::cut_box_field()}};
  for (const auto& [name, field] : fields) {
    const double voxel = 0.08;
    const Cloud cloud(field, voxel);
    const auto voxels = active_voxels(field, voxel);
    const auto [next_to_it, anywhere] =
        errors(voxels, voxel, [&, &f = field](const Vec3& p) { return signed_distance(f, cloud, p); });
    SCOPED_TRACE(name);
    EXPECT_GT(voxels.size(), 1000u);
    EXPECT_LT(next_to_it, 0.1);
    EXPECT_LT(anywhere, 0.25);
  }
}

// Where contacts close up to a crevice the cloud's lattice misses its walls: no distance may be too long by much, and few differ.
TEST(NarrowBand, ContactsAreRightToATenthOfAVoxel) {
  for (const Field& field : {testing::contact_field(), testing::fork_field()}) {
    const double voxel = 0.08;
    const Cloud cloud(field, voxel);
    std::size_t next_to_it = 0, off = 0;
    for (const Voxel& v : active_voxels(field, voxel)) {
      const double error = (std::abs(v.distance) - cloud.distance(v.at)) / voxel;
      EXPECT_LT(error, 0.5);
      if (std::abs(v.distance) >= voxel) continue;
      ++next_to_it;
      off += std::abs(error) > 0.1;
    }
    EXPECT_GT(next_to_it, 500u);
    EXPECT_LT(double(off) / double(next_to_it), 0.02);
  }
}

TEST(NarrowBand, ATwigThinnerThanAVoxelIsThereAsADistance) {
  const Vec3 from(0.013, 0.021, 0), to(0.33, 0.1, 1);
  for (const double radius : {0.02, 0.005}) {
    const double voxel = 0.04;
    const auto voxels = active_voxels(testing::field_of(Capsule{from, to, radius, 1}), voxel);
    const auto [next_to_it, anywhere] = errors(voxels, voxel, [&](const Vec3& p) {
      const double t = std::clamp(glm::dot(p - from, to - from) / glm::dot(to - from, to - from), 0.0, 1.0);
      return glm::distance(p, from + t * (to - from)) - radius;
    });
    SCOPED_TRACE(radius);
    EXPECT_GT(voxels.size(), 500u);
    EXPECT_LT(next_to_it, 0.1);
    EXPECT_LT(anywhere, 0.1);
  }
}

TEST(NarrowBand, LeavesAreTheSameForAnyNumberOfThreads) {
  const Field field = testing::random_field(9);
  const auto one = active_voxels(field, 0.03, 3, 1), two = active_voxels(field, 0.03, 3, 2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i].at, two[i].at);
    ASSERT_EQ(one[i].distance, two[i].distance);
  }
}

TEST(NarrowBand, NothingComesOfNothingOrOfACancelledRun) {
  std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(narrow_band(testing::sphere_field(), 0.05, 3, run).has_value());
  EXPECT_TRUE(active_voxels(testing::field_of(Sphere{Vec3(0), 1, 0.4}), 0.05).empty());   // it never reaches the iso-value
}

}  // namespace
}  // namespace cambium
