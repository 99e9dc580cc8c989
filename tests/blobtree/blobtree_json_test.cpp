#include "blobtree/blobtree_json.h"

#include "blobtree/degrees.h"
#include "blobtree/field.h"
#include "blobtree/input_error.h"
#include "conformance_cases.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <numbers>

namespace cambium {
namespace {

BlobTree parse(const std::string& node) {
  return parse_blobtree("{\"format\":\"cambium-blobtree\",\"version\":1,\"root\":\n" + node + "}", "x.blob.json");
}

TEST(BlobTreeJson, ReadingWhatWasWrittenGivesTheSameFieldBitForBit) {
  for (const ConformanceCase& c : conformance_cases()) {
    SCOPED_TRACE(c.name);
    const std::string text = to_json(c.tree);
    const BlobTree again = parse_blobtree(text, "x");
    ASSERT_EQ(to_json(again), text);
    const Field field(c.tree), same(again);
    Draws draws(5);
    for (int i = 0; i < 20; ++i) {
      const Vec3 p = draws.point(field.bounds().empty() ? Box{Vec3(-1), Vec3(1)} : field.bounds());
      ASSERT_EQ(field.value(p), same.value(p));
    }
  }
}

TEST(BlobTreeJson, AnglesComeBackToTheLastBit) {
  Draws draws(1);
  for (int i = 0; i < 2000; ++i) {
    const double angle = draws.in(-6.28, 6.28);
    BlobTreeBuilder b;
    const BlobTree tree = b.build(b.add(Bend{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, angle, b.add(Sphere{{0, 0, 0}, 1, 1})}));
    const BlobTree again = parse_blobtree(to_json(tree), "");
    ASSERT_EQ(std::get<Bend>(again.node(again.root())).angle, angle);
  }
  EXPECT_EQ(radians_from_degrees(90), std::numbers::pi / 2);
  EXPECT_EQ(radians_from_degrees(180), std::numbers::pi);
}

TEST(BlobTreeJson, KeepsNamesAndEscapesThem) {
  BlobTreeBuilder b;
  const NodeId id = b.add(Sphere{{0, 0, 0}, 1, 1});
  b.set_name(id, "a \"quoted\"\\ \n\xC3\xA9 name");
  const BlobTree again = parse_blobtree(to_json(b.build(id)), "");
  EXPECT_EQ(again.name(again.root()), "a \"quoted\"\\ \n\xC3\xA9 name");
}

TEST(BlobTreeJson, BytesThatAreNotTextBecomeReplacementCharacters) {
  BlobTreeBuilder b;
  const NodeId id = b.add(Sphere{{0, 0, 0}, 1, 1});
  b.set_name(id, "x\xFF\xED\xA0\x80\xC3");
  EXPECT_NO_THROW(parse_blobtree(to_json(b.build(id)), ""));
}

struct Bad {
  const char* node;
  int line, column;
  const char* found;
};

TEST(BlobTreeJson, NamesThePlaceOfEveryMistake) {
  const Bad table[] = {
      {R"({"op":"sphere","center":[0,0,0],"radius":-1})", 2, 42, "`radius` -1"},
      {R"({"op":"sphere","center":[0,0],"radius":1})", 2, 25, "an array of 2"},
      {R"({"op":"sphere","center":[0,0,"x"],"radius":1})", 2, 30, "the string `x`"},
      {R"({"op":"sphere","radius":1})", 2, 1, "no key `center`"},
      {R"({"op":"sphere","center":[0,0,0],"radius":1,"colour":2})", 2, 44, "the unknown key `colour`"},
      {R"({"op":"blob"})", 2, 7, "the unknown op `blob`"},
      {R"({"op":1})", 2, 7, "the number 1"},
      {R"({})", 2, 1, "no key `op`"},
      {R"(7)", 2, 1, "the number 7"},
      {R"({"op":"flare"})", 2, 1, "no key `nodes`"},
      {R"({"op":"flare","nodes":[[0,0,0,1]],"bark":{}})", 2, 35, "`bark`, which this version does not support"},
      {R"({"op":"flare","nodes":[[0,0,0,1]],"base":[0,0,0],"axis":[0,0,1],"height":1,"spread":0,"sharpness":2,"prongs":[{"angle_degrees":0}]})",
       2, 99, "`sharpness` 2"},
      {R"({"op":"flare","nodes":[[0,0,0,1]],"base":[0,0,0],"axis":[0,0,1],"height":1,"spread":0,"sharpness":0,"prongs":[{"angle_degrees":30},
          {"angle_degrees":390}]})", 3, 28, "`prongs[1].angle_degrees` 390"},
      {R"({"op":"flare","nodes":[[0,0,0,1]],"base":[0,0,0],"axis":[0,0,1],"height":1,"spread":0,"sharpness":0,"prongs":[{"angle_degrees":0}],"section":"star"})",
       2, 142, "the string `star`"},
      {R"({"op":"chain","nodes":[[0,0,0,1]],"bark":{}})", 2, 35, "`bark`, which this version does not support"},
      {R"({"op":"chain","nodes":[[0,0,0,1],
          [0,0,1]]})", 3, 11, "an array of 3"},
      {R"({"op":"chain","nodes":[[0,0,0,1],
          [0,0,1,0]]})", 3, 11, "`nodes[1]` [0, 0, 1, 0]"},
      {R"({"op":"chain","nodes":[]})", 2, 23, "`nodes` none"},
      {R"({"op":"sum","children":[]})", 2, 24, "`children` none"},
      {R"({"op":"sum","children":{}})", 2, 24, "an object"},
      {R"({"op":"sum","children":[
          {"op":"sphere","center":[0,0,0],"radius":0}]})", 3, 52, "`radius` 0"},
      {R"({"op":"contact","width":0.6,"children":[{"op":"sphere","center":[0,0,0],"radius":1}]})", 2, 25, "`width` 0.6"},
      {R"({"op":"taper","point":[0,0,0],"axis":[0,0,1],"from":[0,0],"to":[1,1],"child":{"op":"sphere","center":[0,0,0],"radius":1}})",
       2, 56, "`from[1]` 0"},
      {R"({"op":"transform","matrix":[1,0,0,0],"child":{"op":"sphere","center":[0,0,0],"radius":1}})", 2, 28, "an array of 4"},
      {R"({"op":"fork","axis":{"op":"sphere","center":[0,0,0],"radius":1},"laterals":[{"child":{"op":"sphere","center":[0,0,0],"radius":1},"point":[0,0,0],"direction":[0,0,0],"softness":1,"reach":1}]})",
       2, 158, "`laterals[0].direction` [0, 0, 0]"},
      {R"({"op":"sphere","name":3,"center":[0,0,0],"radius":1})", 2, 23, "the number 3"},
  };
  for (const Bad& row : table) {
    try {
      parse(row.node);
      ADD_FAILURE() << "accepted " << row.node;
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().file, "x.blob.json");
      EXPECT_EQ(error.location().line, row.line) << row.node << "\n" << error.what();
      EXPECT_EQ(error.location().column, row.column) << row.node << "\n" << error.what();
      EXPECT_EQ(error.found(), row.found) << row.node;
    }
  }
  EXPECT_THROW(parse_blobtree(R"({"format":"x","version":1,"root":{}})", ""), InputError);
  EXPECT_THROW(parse_blobtree(R"({"format":"cambium-blobtree","version":2,"root":{}})", ""), InputError);
  EXPECT_THROW(parse_blobtree(R"({"format":"cambium-blobtree","version":1})", ""), InputError);
}

// Whatever the bytes, the answer is a tree or an InputError.
TEST(BlobTreeJson, DamagedFilesGiveInputErrors) {
  const std::string alphabet = "{}[],:\"0123456789.eE+-\\ntrufalsechildop \n\xC3\xA9\xFF";
  std::size_t accepted = 0, refused = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    Draws draws(seed);
    std::string text = to_json(conformance_cases()[seed % conformance_cases().size()].tree);
    if (text.size() > 6000) continue;
    for (int i = 0, n = 1 + draws.below(4); i < n; ++i) {
      const auto at = static_cast<std::size_t>(draws.below(static_cast<int>(text.size())));
      const auto length = static_cast<std::size_t>(draws.below(30));
      switch (draws.below(4)) {
        case 0: text[at] = alphabet[static_cast<std::size_t>(draws.below(static_cast<int>(alphabet.size())))]; break;
        case 1: text.erase(at, length); break;
        case 2: text.insert(at, text.substr(static_cast<std::size_t>(draws.below(static_cast<int>(text.size()))), length)); break;
        default: text.insert(at, 1, static_cast<char>(draws.below(256))); break;
      }
      if (text.empty()) text = " ";
    }
    try {
      parse_blobtree(text, "fuzz");
      ++accepted;
    } catch (const InputError& error) {
      ASSERT_GT(error.location().line, 0) << "seed " << seed << ": " << error.what();
      ++refused;
    }
  }
  EXPECT_GT(accepted, 100u);
  EXPECT_GT(refused, 500u);
}

TEST(BlobTreeJson, DeepNestsReadAndWrite) {
  BlobTreeBuilder b;
  NodeId top = b.add(Sphere{{0, 0, 0}, 1, 1});
  for (int i = 0; i < 300000; ++i) top = b.add(Sum{{top}});
  const std::string text = to_json(b.build(top));
  EXPECT_EQ(parse_blobtree(text, "").size(), 300001u);
}

TEST(WriteBlobTree, WritesWholeFilesOrNone) {
  const auto directory = std::filesystem::path(testing::TempDir()) / "cambium_blobtree_json_test";
  std::filesystem::create_directories(directory);
  BlobTreeBuilder b;
  const BlobTree tree = b.build(b.add(Sphere{{0, 0, 0}, 1, 1}));
  write_blobtree(tree, directory / "a.blob.json");
  EXPECT_EQ(to_json(read_blobtree(directory / "a.blob.json")), to_json(tree));
  try {
    write_blobtree(tree, directory / "missing" / "a.blob.json");
    ADD_FAILURE();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("missing"), std::string::npos);
  }
  if (std::filesystem::exists("/dev/full")) {
    EXPECT_THROW(write_blobtree(tree, "/dev/full"), std::runtime_error);
  }
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(directory)) ++files;
  EXPECT_EQ(files, 1u);
  std::filesystem::remove_all(directory);
}

}  // namespace
}  // namespace cambium
