#include "lsystem/curve.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "blobtree/input_error.h"
#include "grammar.h"

namespace cambium {
namespace {

const std::vector<CurvePoint> kBump = {{0, 0}, {0.2, 0}, {0.4, 1}, {0.6, 1}, {0.8, 0}, {1, 0}};

TEST(Curve, PassesThroughItsEndPointsAndRepeatsThemBeyond) {
  const Curve curve("c", {{0, 1}, {0.3, 5}, {0.7, -5}, {1, 2}}, 0);
  EXPECT_EQ(curve.value(0), 1);
  EXPECT_EQ(curve.value(1), 2);
  EXPECT_EQ(curve.value(-3), 1);
  EXPECT_EQ(curve.value(9), 2);
}

TEST(Curve, IsACubicBSplineMetAtX) {
  // Control points on a line make that line, however they are spaced.
  const Curve line("c", {{0, 1}, {0.1, 1.2}, {0.5, 2}, {0.6, 2.2}, {1, 3}}, 0);
  for (double x = 0; x <= 1; x += 0.05) EXPECT_NEAR(line.value(x), 1 + 2 * x, 1e-12) << x;
  // Four points: the Bezier curve. Here x is the parameter, and y = 3 t (1-t)^2 + 3 t^2 (1-t).
  const Curve bezier("c", {{0, 0}, {1.0 / 3, 1}, {2.0 / 3, 1}, {1, 0}}, 0);
  EXPECT_NEAR(bezier.value(0.25), 3 * 0.25 * 0.5625 + 3 * 0.0625 * 0.75, 1e-12);
  const Curve bump("c", kBump, 0);
  EXPECT_NEAR(bump.value(0.3), bump.value(0.7), 1e-12);
}

TEST(Curve, SamplesAreJoinedByStraightLines) {
  const Curve exact("c", kBump, 0), sampled("c", kBump, 5);
  for (const double x : {0.0, 0.25, 0.5, 0.75, 1.0}) EXPECT_EQ(sampled.value(x), exact.value(x));
  EXPECT_NEAR(sampled.value(0.375), 0.5 * (exact.value(0.25) + exact.value(0.5)), 1e-12);
}

TEST(Curve, TheThreeFormatsAreRead) {
  const auto old = read_curves("range: 0.0 1.0\npoints: 4\n0 1\n0.3 1\n0.6 1\n1 1\n", "folder/flat.func");
  ASSERT_EQ(old.size(), 1u);
  EXPECT_EQ(old[0].name(), "flat");
  EXPECT_NEAR(old[0].value(0.4), 1, 1e-12);
  const std::string one =
      "fver 1 1\nname: tall\nsamples: 10\nflip: off\npoints: 4\n0.000000 2 1\n0.3 2 2\n0.6 2\n1.000000 2 1\n";
  EXPECT_EQ(read_curves(one, "x.func").at(0).name(), "tall");
  EXPECT_NEAR(read_curves(one, "x.func").at(0).value(0.5), 2, 1e-12);
  EXPECT_EQ(read_curves("funcgalleryver 1 1\nitems: 2\n" + one + one, "x.fset").size(), 2u);
}

TEST(Curve, MalformedFilesNameTheirLine) {
  const std::pair<const char*, int> rows[] = {
      {"", 0},
      {"something\n", 1},
      {"fver 1 1\nsamples: 3\n", 2},
      {"fver 1 1\nname: a\nsamples: many\n", 3},
      {"fver 1 1\nname: a\nsamples: 3\nflip: off\npoints: 3\n", 5},
      {"fver 1 1\nname: a\nsamples: 3\nflip: off\npoints: 4\n0 0\n1\n", 7},
      {"fver 1 1\nname: a\nsamples: 3\nflip: off\npoints: 4\n0 0\n1 x\n", 7},
      {"range: 0 1\npoints: 4\n0 0\n0 0\n0 0\n", 5},
      {"fver 1 1\nname: a\nsamples: 3\npoints: 4\n0 nan\n", 5},
      {"funcgalleryver 1 1\nitems: 2\n", 2},
  };
  for (const auto& [text, line] : rows) {
    try {
      read_curves(text, "f.func");
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().file, "f.func");
      EXPECT_EQ(error.location().line, line) << text;
    }
  }
}

class CurvesBeside : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  void write_flat(const std::string& name, int height) {
    const std::string y = std::to_string(height);
    write(name + ".func", "fver 1 1\nname: " + name + "\nsamples: 0\nflip: off\npoints: 4\n0 " + y + "\n0.3 " + y +
                              "\n0.6 " + y + "\n1 " + y + "\n");
  }
  std::string derived() {
    write("tree.l", test::grammar("A", "A --> B(func(1,0.5))C(func(2,0.5))"));
    return to_text(test::derived(LSystem::load(folder_ / "tree.l"), 1));
  }

  // Its own for each test: they may run side by side.
  const std::filesystem::path folder_ = std::filesystem::temp_directory_path() /
                                        (std::string("cambium_curves_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(CurvesBeside, TheViewFileNumbersThem) {
  write_flat("a", 10);
  write_flat("b", 20);
  write("tree.v", "angle factor: 12\nfunction: b.func 100\nfunction: a.func\n");
  write("other.v", "function: a.func\n");
  EXPECT_EQ(derived(), "B(20)C(10)");
}

TEST_F(CurvesBeside, WithoutAViewFileTheirNamesDo) {
  write_flat("b", 20);
  write_flat("a", 10);
  EXPECT_EQ(derived(), "B(10)C(20)");
}

TEST_F(CurvesBeside, CurvesHaveNames) {
  write_flat("a", 10);
  write_flat("b", 20);
  write("tree.l", test::grammar("A", "A --> B(func(b,0.5))"));
  EXPECT_EQ(to_text(test::derived(LSystem::load(folder_ / "tree.l"), 1)), "B(20)");
}

TEST_F(CurvesBeside, WhatIsMissingIsAnError) {
  EXPECT_THROW(derived(), InputError);
  write("tree.v", "function: gone.func\n");
  EXPECT_THROW(derived(), InputError);
  write("tree.v", "");
  write_flat("a", 10);
  EXPECT_THROW(derived(), InputError);  // there is no second one
}

TEST_F(CurvesBeside, AModelWithoutFunctionsDoesNotReadThem) {
  write("broken.func", "?");
  write("tree.l", test::grammar("A", "A --> B"));
  EXPECT_EQ(to_text(test::derived(LSystem::load(folder_ / "tree.l"), 1)), "B");
}

}  // namespace
}  // namespace cambium
