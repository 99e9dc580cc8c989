#include "skeletons/graph/svg_path.h"

#include "skeletons/graph/solids.h"
#include "tests/skeletons/malformed.h"

#include <gtest/gtest.h>

#include <random>

namespace cambium {
namespace {

using Stroke = std::vector<glm::dvec2>;

std::string drawing(const std::string& data, const std::string& more = "") {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\"><path " + more + " d=\"" + data + "\"/></svg>";
}

Stroke read(const std::string& data, const SvgStrokeOptions& options = {}) { return read_svg_stroke(drawing(data), "s.svg", options); }

void expect_near(const Stroke& found, const Stroke& wanted, double within = 1e-12) {
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_LT(glm::length(found[i] - wanted[i]), within) << "point " << i;
}

TEST(SvgPath, LinesOfEveryKindGoUpFromTheLowestPointInMetres) {
  const Stroke wanted = {{0, 0}, {1, 1}, {1, 2}, {0.5, 2}, {0.5, 3}};
  for (const char* data : {"M10,30 L20 20 V10 H15 L15,0", "m10 30l10-10v-10h-5v-10", "M 10 30 20 20 20 10 15 10 15 0", "m10,30,10-10,0-10-5 0 0-10",
                           "M1e1 .3e2L2e1 20 20 10 +15 10 15-0", "\n M10\t30 20 20 20 10 15 10 15 0 M0 0 L99 99"})
    expect_near(read(data, {.height = 3}), wanted);
}

TEST(SvgPath, TheAxisIsTheLeftmostPointOrTheLineGivenAndAStrokeLeftOfItIsMirrored) {
  expect_near(read("M 3 4 L 5 2 L 4 0"), {{0, 0}, {0.5, 0.5}, {0.25, 1}});
  expect_near(read("M 3 4 L 5 2 L 4 0", {.axis = 1, .height = 4}), {{2, 0}, {4, 2}, {3, 4}});
  expect_near(read("M 3 4 L 5 2 L 4 0", {.axis = 6, .height = 4}), {{3, 0}, {1, 2}, {2, 4}});
}

TEST(SvgPath, AClosedPathEndsWhereItBegan) {
  const Stroke stroke = read("M1 0 L2 0 L2 1 L1 1 z", {.axis = 0});
  ASSERT_EQ(stroke.size(), 5u);
  EXPECT_EQ(stroke.front(), stroke.back());
}

TEST(SvgPath, CurvesAreFollowedToTheTolerance) {
  // All of them draw the same half of a circle.
  const double k = 4.0 / 3 * std::tan(std::numbers::pi / 8);
  const auto n = [](double v) { return std::to_string(v); };
  const std::string cubic = "M0 10C" + n(10 * k / 2) + ",10 5," + n(5 + 5 * k / 2 + 0) + " 5 5";
  const std::string arcs[] = {"M0 10 A5 5 0 0 0 0 0", "m0 10a5 5 0 1 0 0-10", "M0 10a5,5,0,000-10", "M0 10 A 1 1 0 0 0 0 0", "M0 10 A5 5 77 0 0 0 0",
                              "M0 10 A5 5 0 0 0 5 5 A5 5 0 0 0 0 0"};
  for (const double tolerance : {0.01, 1e-3, 1e-5})
    for (const std::string& data : arcs) {
      const Stroke stroke = read(data, {.height = 2, .tolerance = tolerance});
      for (std::size_t i = 1; i < stroke.size(); ++i)
        for (const double t : {0.0, 0.5, 1.0})
          EXPECT_NEAR(glm::length(glm::mix(stroke[i - 1], stroke[i], t) - glm::dvec2{0, 1}), 1, 2 * tolerance + 1e-6) << data;
      EXPECT_LT(static_cast<double>(stroke.size()), 6 / std::sqrt(tolerance)) << data;
      EXPECT_LT(glm::length(stroke.back() - glm::dvec2{0, 2}), 1e-9) << data;
    }
  EXPECT_GT(read(cubic, {.tolerance = 1e-4}).size(), 10u);
}

TEST(SvgPath, AnArcThatIsLongerGoesTheOtherWayRound) {
  // A quarter and three quarters of the same two circles.
  const Stroke small = read("M0 10 A10 10 0 0 1 10 0", {.axis = 0, .height = 10}), large = read("M0 10 A10 10 0 1 1 10 20", {.axis = -20, .height = 20});
  for (const auto& p : small) EXPECT_NEAR(glm::length(p - glm::dvec2{10, 0}), 10, 1e-6);
  for (const auto& p : large) EXPECT_NEAR(glm::length(p - glm::dvec2{30, 10}), 10, 1e-6);
}

TEST(SvgPath, SmoothCurvesGoOnAsTheOnesBeforeThem) {
  const SvgStrokeOptions fine{.axis = 0, .height = 9, .tolerance = 1e-4};
  expect_near(read("M1 9 C2 9 3 8 3 6 S2 2 1 0", fine), read("M1 9 C2 9 3 8 3 6 C3 4 2 2 1 0", fine), 1e-9);
  expect_near(read("m1 9c1 0 2-1 2-3s-1-4-2-6", fine), read("M1 9 C2 9 3 8 3 6 S2 2 1 0", fine), 1e-9);
  expect_near(read("M1 9 Q3 9 3 6 T1 0", fine), read("M1 9 Q3 9 3 6 Q3 3 1 0", fine), 1e-9);
  expect_near(read("m1 9q2 0 2-3t-2-6", fine), read("M1 9 Q3 9 3 6 T1 0", fine), 1e-9);
  expect_near(read("M1 9 L3 6 S2 2 1 0", fine), read("M1 9 L3 6 C3 6 2 2 1 0", fine), 1e-9);
  for (const auto& p : read("M1 9 L3 0 T1 9", fine)) EXPECT_NEAR(p.x, 1 + p.y * 2 / 9, 1e-9) << "a line has no handle to go on from";
}

TEST(SvgPath, OfADrawingTheFirstPathThatIsDrawnOrTheOneNamed) {
  const std::string text =
      "<?xml version='1.0'?>\n<!DOCTYPE svg [ <!ENTITY a '>'> ]>\n<!-- <path d='M0 0 L9 9'/> -->\n<svg:svg><style><![CDATA[ a < b ]]></style>\n"
      "<defs><path id='hidden' d='M0 3 L3 0'/></defs><path id='empty'/>\n<g><g transform='translate(5)'><path class=\"a>b\" id='first' d='M0 2 L2 0'\n"
      "/></g></g><svg:path id='second' d='M0 4 L1 0'></svg:path></svg:svg>";
  expect_near(read_svg_stroke(text, "s.svg", {}), {{0, 0}, {1, 1}});
  expect_near(read_svg_stroke(text, "s.svg", {.axis = 5}), {{0, 0}, {1, 1}});
  expect_near(read_svg_stroke(text, "s.svg", {.id = "second"}), {{0, 0}, {0.25, 1}});
  expect_near(read_svg_stroke(text, "s.svg", {.id = "hidden", .axis = 0}), {{0, 0}, {1, 1}});
}

TEST(SvgPath, TransformsOfThePathAndOfWhatIsAroundItHold) {
  const std::pair<const char*, Stroke> table[] = {
      {"translate(1 9)", {{1, 0}, {2, 2}}},       {"scale(2)", {{0, 0}, {1, 2}}},
      {"scale(2, 1)", {{0, 0}, {2, 2}}},          {"matrix(1 0 0 1 3 4)", {{3, 0}, {4, 2}}},
      {"rotate(180) scale(-1)", {{0, 0}, {1, 2}}}, {"rotate(180, 2, 0), translate(0 0)", {{4, 2}, {3, 0}}},
      {"skewX(45)", {{2, 0}, {1, 2}}},            {"translate(1)translate(2)", {{3, 0}, {4, 2}}}};
  for (const auto& [transform, wanted] : table) {
    SCOPED_TRACE(transform);
    const std::string attribute = "transform='" + std::string(transform) + "'";
    const SvgStrokeOptions options{.axis = 0, .height = 2};
    expect_near(read_svg_stroke(drawing("M0 2L1 0", attribute), "s.svg", options), wanted, 1e-9);
    expect_near(read_svg_stroke("<g " + attribute + ">" + drawing("M0 2L1 0") + "</g>", "s.svg", options), wanted, 1e-9);
  }
}

TEST(SvgPath, RefusesMalformedDrawingsNamingLineAndColumn) {
  const Malformed table[] = {
      {"", 0, 0, "no <path>"},
      {"hello", 0, 0, "no <path>"},
      {"<svg></svg>", 0, 0, "no <path>"},
      {"<svg>\n<g>", 2, 4, "</g>"},
      {"<svg>\n</g>", 2, 1, "</svg>"},
      {"\n</g>", 2, 1, "none is open"},
      {"<svg>\n  <!-- <path d='M0 0L1 1'/>", 2, 7, "-->"},
      {"<svg><![CDATA[ ", 1, 15, "]]>"},
      {"<?xml ", 1, 3, "?>"},
      {"<!DOCTYPE svg", 1, 1, "'>'"},
      {"< svg>", 1, 1, "an element's name"},
      {"<svg a></svg>", 1, 7, "'='"},
      {"<svg a=b></svg>", 1, 8, "quotes"},
      {"<svg a='b></svg>", 1, 9, "somewhere behind"},
      {"<svg 'b'></svg>", 1, 6, "an attribute"},
      {"<path", 1, 6, "an attribute"},
      {"<path d='L1 1'/>", 1, 10, "begins with M"},
      {"<path d=''/>", 1, 10, "begins with M"},
      {"<path d='M1'/>", 1, 12, "a number"},
      {"<path d='M1 x'/>", 1, 13, "a number"},
      {"<path d='M1 nan'/>", 1, 13, "a number"},
      {"<path d='M1 -inf'/>", 1, 13, "a number"},
      {"<path d='M1 +-2'/>", 1, 13, "a number"},
      {"<path d='M1 1e999'/>", 1, 13, "a number"},
      {"<path d='M1 1e13'/>", 1, 13, "1e12"},
      {"<path d='M0 0L1\n1 L 2'/>", 2, 6, "a number"},
      {"<path d='M0 0L1\n1 B 2 2'/>", 2, 3, "commands"},
      {"<path d='M0 0L1 1&#10;'/>", 1, 18, "commands"},
      {"<path d='M0 0 A1 1 0 2 0 1 1'/>", 1, 22, "0 or 1"},
      {"<path d='M0 0 A1 1 0 0'/>", 1, 23, "0 or 1"},
      {"<path d='M0 0'/>", 1, 10, "without a height"},
      {"<path d='M0 0H9'/>", 1, 10, "without a height"},
      {"<path transform='turn(3)' d='M0 0L1 1'/>", 1, 18, "matrix"},
      {"<path transform='scale(3' d='M0 0L1 1'/>", 1, 25, "a number"},
      {"<path transform='scale 3' d='M0 0L1 1'/>", 1, 18, "a transform such as"},
      {"<path transform='matrix(1 2 3 4 5 6 7)' d='M0 0L1 1'/>", 1, 37, "')'"},
      {"<path transform='rotate(1 2)' d='M0 0L1 1'/>", 1, 18, "matrix"},
      {"<path transform='scale(1, 0)' d='M0 0L1 1'/>", 1, 34, "without a height"},
  };
  for (const Malformed& bad : table) expect_refused(bad, [](const char* text, const char* file) { return read_svg_stroke(text, file, {}); });
  const auto named = [](const char* text, const char* file) { return read_svg_stroke(text, file, {.id = "crown"}); };
  expect_refused({"<path id='other' d='M0 0L1 1'/>", 0, 0, "'crown'"}, named);
  expect_refused({"<svg><path id='crown'/></svg>", 1, 6, "with data"}, named);
  const auto across = [](const char* text, const char* file) { return read_svg_stroke(text, file, {.axis = 1}); };
  expect_refused({"<path d='M1 2L4 1L0 0'/>", 1, 10, "crosses its axis x = 1"}, across);
}

TEST(SvgPath, RefusesWhatIsTooMuchAndOptionsThatAreNone) {
  std::string deep, far = "M0 0";
  for (int i = 0; i < 300; ++i) deep += "<g>";
  for (int i = 0; i < 70000; ++i) far += "L" + std::to_string(i % 7) + " " + std::to_string(i);
  EXPECT_THROW(read_svg_stroke(deep, "s.svg", {}), InputError);
  EXPECT_THROW(read(far), InputError);
  EXPECT_THROW(read("M0 0 C9 0 9 9 0 9", {.tolerance = 1e-12}), InputError);
  for (const SvgStrokeOptions& bad : {SvgStrokeOptions{.height = 0}, SvgStrokeOptions{.tolerance = -1}, SvgStrokeOptions{.axis = kInfinity}})
    EXPECT_THROW(read("M0 0L1 1", bad), InputError);
}

TEST(SvgPath, NoiseIsReadOrRefusedButDoesNoHarm) {
  const std::string good = "<svg><g transform='rotate(30)'><path d='M0 9 C1 9 2 8 2 6 S4 3 5 1 q1 2 3-9 t1 1 A5 5 3 0 1 9 9 V1 h-2 z'/></g></svg>";
  std::mt19937 random(7);
  int refused = 0, valid = 0;
  for (int i = 0; i < 5000; ++i) {
    std::string text = good;
    for (int k = 0; k <= i % 2; ++k) text[random() % text.size()] = "0123456789-+. eEMLCZAq<>/'\"!?=()"[random() % 32];
    try {
      for (const glm::dvec2& p : read_svg_stroke(text, "s.svg", {})) ASSERT_TRUE(p.x >= 0 && p.y >= -1e-9 && p.y <= 1 + 1e-9) << text;
      ++valid;
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 500);
  EXPECT_GT(valid, 500);
}

}  // namespace
}  // namespace cambium
