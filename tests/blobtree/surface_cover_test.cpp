// What a surface cover promises: no point of the surface outside its cells, fields that are the whole field inside, the same
// cells for any thread count, and memory that follows the surface.
//
// MissesNothing takes 200 trees with 500 surface points each, for both rules of cell size. With CAMBIUM_EXHAUSTIVE=1 in the
// environment it takes 1,000 trees with 10,000 points each, in some minutes.
#include "blobtree/surface_cover.h"

#include "blobtree/input_error.h"
#include "blobtree/lone_chain.h"
#include "random_blobtrees.h"
#include "strained_blobtrees.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

namespace cambium {
namespace {

// ---- the tests' own way to find cells: boxes under boxes, knowing nothing of grids --------------------------------
class BoxTree {
 public:
  explicit BoxTree(const SurfaceCover& cover) : items_(cover.size()) {
    for (std::size_t i = 0; i < cover.size(); ++i) boxes_.push_back(cover.box(i));
    std::iota(items_.begin(), items_.end(), 0u);
    if (!items_.empty()) build(0, static_cast<std::uint32_t>(items_.size()));
  }

  template <class Visit>
  void for_each_meeting(const Box& box, Visit&& visit) const {
    std::vector<std::uint32_t> stack;
    if (!nodes_.empty()) stack.push_back(0);
    while (!stack.empty()) {
      const std::uint32_t at = stack.back();
      const Group& node = nodes_[at];
      stack.pop_back();
      if (!node.box.intersects(box)) continue;
      if (node.right != 0) {
        stack.push_back(at + 1);
        stack.push_back(node.right);
        continue;
      }
      for (std::uint32_t i = node.begin; i < node.end; ++i)
        if (boxes_[items_[i]].intersects(box)) visit(items_[i]);
    }
  }
  bool holds(const Vec3& p, double slack) const {
    bool found = false;
    for_each_meeting({p - slack, p + slack}, [&](std::uint32_t) { found = true; });
    return found;
  }

 private:
  struct Group {
    Box box;
    std::uint32_t begin = 0, end = 0, right = 0;   ///< right == 0: a leaf; else the left half follows
  };
  void build(std::uint32_t begin, std::uint32_t end) {
    const std::size_t here = nodes_.size();
    nodes_.push_back({{}, begin, end, 0});
    for (std::uint32_t i = begin; i < end; ++i) nodes_[here].box.extend(boxes_[items_[i]]);
    if (end - begin <= 8) return;
    const Vec3 size = nodes_[here].box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto place = [&](std::uint32_t item) { return boxes_[item].center()[axis]; };
    const auto before = [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); };
    std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end, before);
    build(begin, middle);
    nodes_[here].right = static_cast<std::uint32_t>(nodes_.size());
    build(middle, end);
  }

  std::vector<Box> boxes_;
  std::vector<std::uint32_t> items_;
  std::vector<Group> nodes_;
};

// ---- the tests' own way to find the surface: along random lines, on the unpruned field ---------------------------
class Marcher {
 public:
  Marcher(const Field& field, std::uint64_t seed) : field_(field), whole_(field.whole()), draws_(seed) {}

  /// Appends the points where one line meets the surface, to 1e-11 of the line's length.
  void march(std::vector<Vec3>& found) {
    // Half of the lines cross all of the bounds, half only the support of one atom: steps must be short enough for it.
    const Box support = field_.atom_bounds(static_cast<std::uint32_t>(draws_.next() % field_.atom_count()));
    const bool near = draws_.chance(0.5) && support.bounded();
    const Box& box = near ? support : field_.bounds();
    const Vec3 through = draws_.point(support.bounded() ? support : field_.bounds()), direction = draws_.direction();
    double begin = -kInfinity, end = kInfinity;
    for (int k = 0; k < 3; ++k) {
      const double a = (box.lo[k] - through[k]) / direction[k], b = (box.hi[k] - through[k]) / direction[k];
      begin = std::max(begin, std::min(a, b));
      end = std::min(end, std::max(a, b));
    }
    if (!(begin < end) || !std::isfinite(end - begin)) return;
    const double step = (end - begin) / (kSteps - 1);
    const auto at = [&](double t) { return through + t * direction; };
    for (int i = 0; i < kSteps; ++i) {
      const Vec3 p = at(begin + step * i) - whole_.origin();
      x_[i] = static_cast<float>(p.x), y_[i] = static_cast<float>(p.y), z_[i] = static_cast<float>(p.z);
    }
    evaluator_.values(whole_, x_, y_, z_, f_);
    for (int i = 1; i < kSteps; ++i) {
      if ((f_[i - 1] >= kIso) == (f_[i] >= kIso)) continue;
      double a = begin + step * (i - 1), b = begin + step * i;
      double fa = evaluator_.value(whole_, at(a)) - kIso, fb = evaluator_.value(whole_, at(b)) - kIso;
      if ((fa >= 0) == (fb >= 0)) continue;   // a float's doing
      // False position, the kept end's value halved (Illinois), so that both ends close in.
      for (int turn = 0; turn < 100 && std::abs(b - a) > 1e-11 * (end - begin); ++turn) {
        double t = fb == fa ? 0.5 * (a + b) : b - fb * (b - a) / (fb - fa);
        if (turn % 4 == 3 || !(t > std::min(a, b) && t < std::max(a, b))) t = 0.5 * (a + b);
        const double f = evaluator_.value(whole_, at(t)) - kIso;
        if ((f >= 0) != (fb >= 0)) {
          a = b;
          fa = fb;
        } else {
          fa *= 0.5;
        }
        b = t;
        fb = f;
      }
      found.push_back(at(b));
    }
  }

 private:
  static constexpr int kSteps = 64;
  const Field& field_;
  PrunedField whole_;
  Draws draws_;
  Evaluator evaluator_;
  std::array<float, kSteps> x_, y_, z_, f_;
};

CoverOptions few_cells() {
  CoverOptions options;
  options.max_cells = 20000;   // a disc a metre wide and half a millimetre thick would take millions
  return options;
}

CoverOptions constant(double cell) {
  CoverOptions options;
  options.cell = cell;
  return options;
}

double longest_edge(const Box& box) { return std::max({box.size().x, box.size().y, box.size().z}); }

Field strained_field(std::size_t strain, std::uint64_t seed) { return Field(strained_blobtree(strain, seed).tree); }

TEST(SurfaceCover, MissesNothing) {
  const char* const wish = std::getenv("CAMBIUM_EXHAUSTIVE");
  const bool exhaustive = wish && std::string(wish) == "1";
  const std::size_t trees = exhaustive ? 1000 : 200, points = exhaustive ? 10000 : 500;
  std::size_t complete = 0, checked = 0;
  for (std::uint64_t i = 0; complete < trees; ++i) {
    ASSERT_LT(i, 2 * trees) << "too many trees without a surface that lines find";
    const std::size_t strain = i % strains().size();
    SCOPED_TRACE(testing::Message() << strains()[strain] << ", seed " << 5000 + i);
    const Field field = strained_field(strain, 5000 + i);
    if (field.bounds().empty()) continue;
    std::vector<Vec3> surface;
    Marcher marcher(field, i);
    for (std::size_t lines = 0; surface.size() < points && lines < 400 + 20 * surface.size(); ++lines) {
      marcher.march(surface);
    }
    surface.resize(std::min(surface.size(), points));
    complete += surface.size() == points;
    checked += surface.size();
    const double size = longest_edge(field.bounds());
    for (const CoverOptions& options : {few_cells(), constant(size / static_cast<double>(10 + i % 50))}) {
      const auto cover = cover_surface(field, options, {});
      ASSERT_TRUE(cover);
      const BoxTree cells(*cover);
      for (const Vec3& p : surface) {
        ASSERT_TRUE(cells.holds(p, 1e-10 * size))
            << p.x << " " << p.y << " " << p.z << (options.cell ? ", constant cells" : ", cells by radius");
      }
    }
  }
  RecordProperty("surface_points", static_cast<int>(checked));
  EXPECT_GE(checked, trees * points);
}

TEST(SurfaceCover, CellsAreTheSameForAnyThreadCount) {
  const tbb::global_control five(tbb::global_control::max_allowed_parallelism, 5);   // on any machine
  for (const std::size_t strain : {0u, 2u, 4u, 5u, 6u}) {
    const Field field = strained_field(strain, 7);
    for (const CoverOptions& options : {few_cells(), constant(longest_edge(field.bounds()) / 40)}) {
      std::vector<SurfaceCover> covers;
      for (const int threads : {1, 2, 5}) {
        RunOptions run;
        run.threads = threads;
        covers.push_back(cover_surface(field, options, run).value());
      }
      ASSERT_GT(covers[0].size(), 20u) << strains()[strain];
      Evaluator evaluator;
      Draws draws(strain);
      for (std::size_t k = 1; k < covers.size(); ++k) {
        ASSERT_EQ(covers[k].size(), covers[0].size());
        EXPECT_EQ(covers[k].memory_bytes(), covers[0].memory_bytes());
        EXPECT_EQ(covers[k].tape_count(), covers[0].tape_count());
        for (std::size_t i = 0; i < covers[0].size(); ++i) {
          const Box box = covers[0].box(i), other = covers[k].box(i);
          ASSERT_TRUE(box.lo == other.lo && box.hi == other.hi);
          const PrunedField a = covers[0].field(i), b = covers[k].field(i);
          const Vec3 p = draws.point(box);
          ASSERT_EQ(evaluator.value(a, p), evaluator.value(b, p));
          ASSERT_EQ(a.atom_count(), b.atom_count());
          ASSERT_EQ(a.origin(), b.origin());
        }
      }
    }
  }
}

TEST(SurfaceCover, CellsAreDisjoint) {
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const Field field = strained_field(seed % strains().size(), 300 + seed);
    if (field.bounds().empty()) continue;
    for (const CoverOptions& options : {few_cells(), constant(longest_edge(field.bounds()) / 30)}) {
      const SurfaceCover cover = cover_surface(field, options, {}).value();
      const BoxTree cells(cover);
      for (std::size_t i = 0; i < cover.size(); ++i) {
        const Box box = cover.box(i);
        ASSERT_FALSE(box.empty());
        cells.for_each_meeting(box, [&](std::uint32_t j) {
          const Vec3 shared = Box::intersection(box, cover.box(j)).size();
          ASSERT_TRUE(i == j || std::min({shared.x, shared.y, shared.z}) == 0) << "cells " << i << " and " << j;
        });
      }
    }
  }
}

TEST(SurfaceCover, FieldOfACellIsTheWholeInside) {
  Evaluator evaluator;
  std::size_t checked = 0, nonzero = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Field field = strained_field(seed % strains().size(), 500 + seed);
    if (field.bounds().empty()) continue;
    const PrunedField whole = field.whole();
    Draws draws(seed);
    for (const CoverOptions& options : {few_cells(), constant(longest_edge(field.bounds()) / 25)}) {
      const SurfaceCover cover = cover_surface(field, options, {}).value();
      for (std::size_t n = 0; n < std::min<std::size_t>(cover.size(), 200); ++n) {
        const std::size_t i = draws.next() % cover.size();
        const PrunedField pruned = cover.field(i);
        const Box box = cover.box(i);
        ASSERT_TRUE(pruned.box().lo == box.lo && pruned.box().hi == box.hi);
        for (int k = 0; k < 6; ++k) {
          Vec3 p = draws.point(box);
          if (k == 4) p = box.lo;
          if (k == 5) p = {box.hi.x, box.lo.y, box.hi.z};
          const double exact = evaluator.value(whole, p);
          ASSERT_EQ(evaluator.value(pruned, p), exact) << strains()[seed % strains().size()] << ", seed " << 500 + seed;
          ++checked;
          nonzero += exact != 0;
        }
      }
    }
  }
  EXPECT_GT(checked, 20000u);
  EXPECT_GT(nonzero, checked / 2);
}

TEST(SurfaceCover, FindsTheCellWhoseCubeHoldsAPoint) {
  Evaluator evaluator;
  std::size_t found = 0, missed = 0, outside_its_box = 0;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const Field field = strained_field(seed % strains().size(), 700 + seed);
    if (field.bounds().empty()) continue;
    const PrunedField whole = field.whole();
    for (const CoverOptions& options : {few_cells(), constant(longest_edge(field.bounds()) / 30)}) {
      const SurfaceCover cover = cover_surface(field, options, {}).value();
      Draws draws(seed);
      for (std::size_t i = 0; i < cover.size(); ++i) {
        const Box cube = cover.cube(i), box = cover.box(i);
        ASSERT_TRUE(cube.contains(box.lo) && cube.contains(box.hi));
        ASSERT_EQ(cover.find(cube.lo), i);
        CellPlace last = cover.place(i);
        for (std::uint32_t& along : last) along += (1u << cover.level(i)) - 1;
        ASSERT_EQ(cover.find_place(cover.place(i)), i);
        ASSERT_EQ(cover.find_place(last), i);
        const Vec3 p = draws.point(cube);
        ASSERT_EQ(cover.find(p), i);
        if (!box.contains(p)) {
          ++outside_its_box;
          ASSERT_EQ(evaluator.value(whole, p), 0);
        }
        const auto above = cover.find({cube.lo.x, cube.lo.y, cube.hi.z});   // a neighbour's low face
        if (above) { ASSERT_TRUE(*above != i && cover.cube(*above).contains({cube.lo.x, cube.lo.y, cube.hi.z})); }
        ++found;
      }
      for (int k = 0; k < 500; ++k) {
        const Vec3 p = draws.point(field.bounds());
        if (const auto cell = cover.find(p)) {
          ASSERT_TRUE(cover.cube(*cell).contains(p));
        } else {
          ++missed;
          for (std::size_t i = 0; i < cover.size(); ++i) ASSERT_FALSE(cover.box(i).contains(p));
        }
      }
      EXPECT_FALSE(cover.find(field.bounds().hi + 1e3));
      EXPECT_FALSE(cover.find_place({0xffffffffu, 0, 0}));
    }
  }
  EXPECT_GT(found, 20000u);
  EXPECT_GT(missed, 1000u);
  EXPECT_GT(outside_its_box, 100u);
  EXPECT_FALSE(SurfaceCover().find(Vec3(0)));
}

// ---- sizes of cells -----------------------------------------------------------------------------------------------
Field field_of(Node node) {
  BlobTreeBuilder b;
  const NodeId root = b.add(std::move(node));
  return Field(b.build(root));
}

Field trunk_and_twig() {
  BlobTreeBuilder b;
  const NodeId trunk = b.add(Chain{{{{0, 0, 0}, 0.3}, {{0, 0, 2}, 0.25}}, 1});
  const NodeId twig = b.add(Chain{{{{3, 0, 1}, 0.01}, {{3, 0.4, 1.4}, 0.008}}, 1});
  return Field(b.build(b.add(Sum{{trunk, twig}})));
}

TEST(SurfaceCover, ConstantCellsArePartsOfCubesOfThatSize) {
  for (const double cell : {0.11, 0.25}) {
    const SurfaceCover cover = cover_surface(trunk_and_twig(), constant(cell), {}).value();
    ASSERT_GT(cover.size(), 50u);
    for (std::size_t i = 0; i < cover.size(); ++i) {
      const Box box = cover.box(i);
      const Vec3 cube = glm::floor(box.center() / cell);   // cubes are anchored at the origin
      for (int k = 0; k < 3; ++k) {
        ASSERT_GE(box.lo[k], cell * cube[k]);
        ASSERT_LE(box.hi[k], cell * (cube[k] + 1));
      }
    }
  }
}

TEST(SurfaceCover, CellsFollowTheRadius) {
  CoverOptions options;
  options.cell_radii = 1.5;
  options.sparse_radii = 3;
  options.sparse_atoms = 1;
  const SurfaceCover cover = cover_surface(trunk_and_twig(), options, {}).value();
  double largest = 0, smallest = kInfinity;
  for (std::size_t i = 0; i < cover.size(); ++i) {
    const PrunedField field = cover.field(i);
    const double edge = longest_edge(cover.box(i));
    ASSERT_LE(edge, field.smallest_radius() * (field.atom_count() <= 1 ? 3 : 1.5) * (1 + 1e-12));
    largest = std::max(largest, edge);
    smallest = std::min(smallest, field.smallest_radius());
  }
  EXPECT_GT(largest, 0.25 / 2);      // half the rule at worst, as cells are halved
  EXPECT_LT(smallest, 0.0101);
  // Cells of the twig's size over the trunk as well would be a thousand times as many.
  EXPECT_LT(cover.size(), 2000u);
}

TEST(SurfaceCover, CellsMayBeSmallerWhereChainsMeetOthers) {
  BlobTreeBuilder b;
  const NodeId twig = b.add(Chain{{{{0, 0, 0}, 0.01}, {{0, 0, 0.5}, 0.01}}});
  const NodeId shoot = b.add(Chain{{{{0, 0, 0.25}, 0.01}, {{0.3, 0, 0.4}, 0.01}}});
  const Field field(b.build(b.add(Sum{{twig, shoot}})));
  CoverOptions options;
  const SurfaceCover plain = *cover_surface(field, options, {});
  options.shared_radii = 0.8;
  const SurfaceCover finer = *cover_surface(field, options, {});
  const auto largest = [](const SurfaceCover& cover, bool shared) {
    double edge = 0;
    for (std::size_t i = 0; i < cover.size(); ++i) {
      if (LoneChain::of(cover.cube_field(i)).has_value() != shared) edge = std::max(edge, cover.cube(i).size().x);
    }
    return edge;
  };
  EXPECT_GT(largest(plain, true), 0.008);
  EXPECT_LE(largest(finer, true), 0.008);
  EXPECT_EQ(largest(finer, false), largest(plain, false));
}

TEST(SurfaceCover, MemoryFollowsTheSurfaceAndNotTheVolume) {
  const Field ball = field_of(Sphere{{0.013, 0.02, 0.031}, 1, 1});
  double cells = 0, bytes = 0;
  for (const double cell : {0.1, 0.05, 0.025, 0.0125}) {
    const SurfaceCover cover = cover_surface(ball, constant(cell), {}).value();
    // About 3/2 cells for each cell^2 of a surface that lies every way; those of an interval that is not exact are more.
    EXPECT_LT(static_cast<double>(cover.size()), 4 * 12.57 / (cell * cell));
    if (cells > 0) {
      EXPECT_NEAR(static_cast<double>(cover.size()) / cells, 4, 0.6);
      EXPECT_NEAR(static_cast<double>(cover.memory_bytes()) / bytes, 4, 1);
    }
    cells = static_cast<double>(cover.size());
    bytes = static_cast<double>(cover.memory_bytes());
  }
  EXPECT_LT(bytes / cells, 64);
}

TEST(SurfaceCover, AStraightThinTwigNeedsFewCells) {
  const SurfaceCover cover = cover_surface(field_of(Chain{{{{0, 0, 0}, 0.001}, {{0.3, 0.2, 0.1}, 0.001}}, 1}), {}, {}).value();
  EXPECT_LT(cover.size(), 400u);
  EXPECT_GT(cover.size(), 10u);
}

TEST(SurfaceCover, NeighboursShareTapes) {
  const SurfaceCover cover = cover_surface(trunk_and_twig(), constant(0.02), {}).value();
  EXPECT_GT(cover.size(), 10000u);
  EXPECT_LT(cover.tape_count(), cover.size() / 20);
}

TEST(SurfaceCover, RaisesItsLengthsRatherThanHoldTooManyCells) {
  const Field field = trunk_and_twig();
  CoverOptions options;
  const std::size_t wanted = cover_surface(field, options, {}).value().size();
  options.max_cells = wanted / 3;
  const SurfaceCover cover = cover_surface(field, options, {}).value();
  EXPECT_LE(cover.size(), wanted / 3);
  EXPECT_GT(cover.size(), 0u);
  const BoxTree cells(cover);
  std::vector<Vec3> surface;
  Marcher marcher(field, 3);
  while (surface.size() < 2000) marcher.march(surface);
  for (const Vec3& p : surface) ASSERT_TRUE(cells.holds(p, 1e-9));
}

TEST(SurfaceCover, SoonRaisesItsLengthsEnoughWhereThereAreThousandsOfTimesTooManyCells) {
  const Field field = trunk_and_twig();
  CoverOptions fine;
  fine.cell_radii = fine.sparse_radii = 0.1;
  const std::size_t wanted = cover_surface(field, fine, {}).value().size();
  fine.max_cells = wanted / 2000;
  const SurfaceCover cover = cover_surface(field, fine, {}).value();
  EXPECT_LE(cover.size(), fine.max_cells);
  EXPECT_GT(cover.size(), fine.max_cells / 100);
}

TEST(SurfaceCover, RaisesTheSagittaTooRatherThanHoldTooManyCells) {
  CoverOptions options;
  options.sagitta = 1e-4;
  const std::size_t wanted = cover_surface(trunk_and_twig(), options, {}).value().size();
  options.max_cells = wanted / 20;   // far fewer than the radii ask for
  const SurfaceCover cover = cover_surface(trunk_and_twig(), options, {}).value();
  EXPECT_LE(cover.size(), wanted / 20);
  EXPECT_GT(cover.size(), 0u);
}

TEST(SurfaceCover, RefusesANumberOfCellsThatEvenTheCoarsestExceed) {
  CoverOptions options;
  options.max_cells = 0;
  EXPECT_THROW(cover_surface(trunk_and_twig(), options, {}), InputError);
}

TEST(SurfaceCover, RefusesSizesThatCannotBe) {
  const Field field = trunk_and_twig();
  for (const double cell : {0.0, -1.0, std::nan(""), kInfinity, 1e-12})
    EXPECT_THROW(cover_surface(field, constant(cell), {}), InputError) << cell;
  CoverOptions options = constant(0.01);
  options.max_cells = 100;
  EXPECT_THROW(cover_surface(field, options, {}), InputError);
  for (const double radii : {0.0, -1.0, std::nan(""), kInfinity}) {
    CoverOptions following;
    following.cell_radii = radii;
    EXPECT_THROW(cover_surface(field, following, {}), InputError) << radii;
  }
  for (const double shared : {0.0, -1.0, std::nan("")}) {
    CoverOptions following;
    following.shared_radii = shared;
    EXPECT_THROW(cover_surface(field, following, {}), InputError) << shared;
  }
  for (const double sagitta : {0.0, -1.0, std::nan("")}) {
    CoverOptions following;
    following.sagitta = sagitta;
    EXPECT_THROW(cover_surface(field, following, {}), InputError) << sagitta;
  }
}

TEST(SurfaceCover, OfAFieldWithoutSurfaceIsEmpty) {
  BlobTreeBuilder b;
  const NodeId apart = b.add(Intersection{{b.add(Sphere{{0, 0, 0}, 0.1, 1}), b.add(Sphere{{5, 0, 0}, 0.1, 1})}});
  const Sphere faint{{0, 0, 0}, 1, 0.3}, dent{{0, 0, 0}, 1, -1};
  for (const Field& field : {Field(b.build(apart)), field_of(faint), field_of(dent)}) {
    for (const CoverOptions& options : {CoverOptions{}, constant(0.1)}) {
      const SurfaceCover cover = cover_surface(field, options, {}).value();
      EXPECT_TRUE(cover.empty());
      EXPECT_EQ(cover.size(), 0u);
    }
  }
}

TEST(SurfaceCover, CubeFieldsAreTheWholeFieldInAllOfTheirCubes) {
  Evaluator evaluator;
  std::size_t asked = 0, outside_the_box = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const Field field(seed % 2 ? random_blobtree(seed, 3) : strained_blobtree(seed / 2 % strains().size(), seed).tree);
    if (field.bounds().empty()) continue;
    const SurfaceCover cover = cover_surface(field, constant(longest_edge(field.bounds()) / 9), {}).value();
    Draws draws(seed);
    for (std::size_t i = 0; i < cover.size(); ++i) {
      const PrunedField of_cube = cover.cube_field(i);
      const Box cube = cover.cube(i);
      EXPECT_EQ(of_cube.box().lo, cube.lo);
      EXPECT_EQ(of_cube.box().hi, cube.hi);
      for (int k = 0; k < 12; ++k) {   // its corners, and four points inside
        const Vec3 corner(k & 1 ? cube.hi.x : cube.lo.x, k & 2 ? cube.hi.y : cube.lo.y, k & 4 ? cube.hi.z : cube.lo.z);
        const Vec3 p = k < 8 ? corner : draws.point(cube);
        ASSERT_EQ(evaluator.value(of_cube, p), field.value(p)) << "cell " << i;
        ++asked;
        outside_the_box += !cover.box(i).contains(p);
      }
    }
  }
  EXPECT_GT(asked, 10000u);
  EXPECT_GT(outside_the_box, 100u) << "the case this is for";
}

TEST(SurfaceCover, CellsAreAUnitTimesAPowerOfTwo) {
  for (const double unit : {0.003, 0.0071, 0.05}) {
    CoverOptions options;
    options.unit = unit;
    const SurfaceCover cover = cover_surface(trunk_and_twig(), options, {}).value();
    ASSERT_GT(cover.size(), 10u);
    EXPECT_EQ(cover.grid().cell, unit);
    int levels = 0;
    for (std::size_t i = 0; i < cover.size(); ++i) {
      EXPECT_NEAR(longest_edge(cover.cube(i)) / std::ldexp(unit, cover.level(i)), 1, 1e-9);
      levels |= 1 << cover.level(i);
    }
    EXPECT_GT(levels & (levels - 1), 0) << "of one size only";
  }
  CoverOptions bad;
  for (const double unit : {0.0, -1.0, std::nan(""), kInfinity, 1e-12}) {
    bad.unit = unit;
    EXPECT_THROW(cover_surface(trunk_and_twig(), bad, {}), InputError) << unit;
  }
}

TEST(SurfaceCover, ASagittaLimitsCellsByTheRootOfTheirRadius) {
  CoverOptions options;
  options.unit = 0.0005;
  options.cell_radii = options.sparse_radii = 100;
  options.sagitta = 0.02;
  const SurfaceCover cover = cover_surface(trunk_and_twig(), options, {}).value();
  double trunk = 0, twig = 0;
  for (std::size_t i = 0; i < cover.size(); ++i) {
    const double edge = longest_edge(cover.cube(i)), radius = cover.field(i).smallest_radius();
    ASSERT_LE(edge, std::sqrt(0.02 * radius) * (1 + 1e-12));
    (radius > 0.1 ? trunk : twig) = std::max(radius > 0.1 ? trunk : twig, edge);
  }
  // Cells are halved, so they are more than half of what they may be.
  EXPECT_GT(trunk, std::sqrt(0.02 * 0.25) / 2);
  EXPECT_GT(twig, std::sqrt(0.02 * 0.008) / 2);
  options.cell_radii = options.sparse_radii = 0.5;   // the shorter of both counts
  const SurfaceCover finer = cover_surface(trunk_and_twig(), options, {}).value();
  for (std::size_t i = 0; i < finer.size(); ++i)
    ASSERT_LE(longest_edge(finer.cube(i)), 0.5 * finer.field(i).smallest_radius() * (1 + 1e-12));
}

TEST(SurfaceCover, StopsWhenCancelled) {
  const Field field = trunk_and_twig();
  std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(cover_surface(field, {}, run));
  cancel = false;
  bool told = false;
  run.progress = [&](std::string_view, double) {
    told = true;
    cancel = true;
  };
  EXPECT_FALSE(cover_surface(field, constant(0.004), run));
  EXPECT_TRUE(told);
}

}  // namespace
}  // namespace cambium
