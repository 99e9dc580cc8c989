// Bad input of every kind to the real program: exit 2, one line that names the place, no file left behind.
#include <gtest/gtest.h>

#include <algorithm>

#include "program.h"
#include "temporary_folder.h"
#include "tiny_inputs.h"

namespace cambium {
namespace {

class BadInput : public ::testing::Test {
 protected:
  BadInput() {
    folder_.write("tiny.l", kTinyLSystem);
    folder_.write("tiny.skel.json", kTinySkeleton);
    folder_.write("tiny.swc", kTinySwc);
    folder_.write("tiny.blob.json", kTinyBlobTree);
    folder_.write("p.csv", "0,0,0\n");
  }

  std::string at(const std::string& name) const { return folder_.path(name); }

  /// Expects exit 2, nothing on stdout, one line on stderr that starts with `begin` and has "found" and "expected" in it,
  /// and no new file.
  void expect_refused(const std::vector<std::string>& arguments, const std::string& begin) {
    const std::vector<std::string> before = folder_.names();
    const Ran ran = run_program(arguments);
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.out, "");
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    EXPECT_TRUE(ran.err.starts_with(begin)) << ran.err << "does not start with " << begin;
    EXPECT_NE(ran.err.find(": found "), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find(", expected "), std::string::npos) << ran.err;
    EXPECT_EQ(folder_.names(), before);
  }

  TemporaryFolder folder_;
};

struct BadFile {
  const char* name;
  const char* text;
  const char* place;  // ":line:column" or a part of it; the line must start with the path and this
};

TEST_F(BadInput, FilesAreRefusedAtTheirPlace) {
  const BadFile table[] = {
      // Recipes.
      {"a.tree.toml", "[skeleton\n", ":1:"},
      {"a.tree.toml", "[skeleton]\nlsystem = \"tiny.l\"\nflavour = 3\n", ":3:1: found unknown key 'skeleton.flavour'"},
      {"a.tree.toml", "[skeleton]\nlsystem = \"none.l\"\n", ":2:11: found no file"},
      {"a.tree.toml", "[skeleton]\nfile = \"none.swc\"\n", ":2:8: found no file"},
      {"a.tree.toml", "[skeleton]\ngraph = \"none\"\n", ":2:9: "},
      {"a.tree.toml", "[surface]\nlip = 1\n", ": found no skeleton"},
      {"a.tree.toml", "", ": found no skeleton"},
      {"a.tree.toml", "[skeleton]\nfile = \"tiny.swc\"\n[surface]\nlip = nan\n", ":4:7: "},
      {"a.tree.toml", "[skeleton]\nfile = \"tiny.swc\"\n[mesh]\nvoxel = -1\n", ":4:9: "},
      {"a.tree.toml", "[skeleton]\nfile = \"tiny.swc\"\n[render]\nsize = \"0x0\"\n", ":4:8: "},
      {"a.tree.toml", "[skeleton]\nfile = \"tiny.swc\"\n[[prune]]\nbranch = 77\n", ":3:1: "},
      {"a.tree.toml", "[skeleton]\nfile = \"tiny.swc\"\n[[prune]]\nbranch = 1\n[[scar]]\nbranch = 77\n", ":5:1: "},
      {"a.tree.toml", "[skeleton]\nfile = \"tiny.swc\"\n[bark]\ntexture = \"none.png\"\n", ":4:11: found no file"},
      // L-systems.
      {"a.l", "", ""},
      {"a.l", "lsystem: x\nderivation length: 2\naxiom: F(\n", ":"},
      {"a.l", "lsystem: x\nderivation length: 2\naxiom: F\nF --> F(1/0)\nendlsystem\n", ":4:"},
      {"a.l", "lsystem: x\nderivation length: 2\naxiom: F]\nF --> F\nendlsystem\n", ":3:"},
      {"a.l", "lsystem: x\nderivation length: x\naxiom: F\n", ":2:"},
      // Skeletons.
      {"a.skel.json", "{", ":1:"},
      {"a.skel.json", R"({"format":"cambium-skeleton","version":1,"nodes":[]})", ":1:"},
      {"a.skel.json", R"({"format":"other","version":1,"nodes":[]})", ":1:"},
      {"a.skel.json",
       "{\"format\":\"cambium-skeleton\",\"version\":1,\"nodes\":[\n{\"position\":[0,0,0],\"radius\":0,\"parent\":-1},\n{"
       "\"position\":[0,0,1],\"radius\":1,\"parent\":0}]}",
       ":2:"},
      {"a.skel.json",
       "{\"format\":\"cambium-skeleton\",\"version\":1,\"nodes\":[\n{\"position\":[0,0,0],\"radius\":1,\"parent\":-1},\n{"
       "\"position\":[0,0,1],\"radius\":1,\"parent\":7}]}",
       ":3:"},
      {"a.skel.json",
       "{\"format\":\"cambium-skeleton\",\"version\":1,\"nodes\":[\n{\"position\":[0,0,0],\"radius\":1,\"parent\":1},\n{"
       "\"position\":[0,0,1],\"radius\":1,\"parent\":0}]}",
       ":"},
      {"a.skel.json",
       "{\"format\":\"cambium-skeleton\",\"version\":1,\"nodes\":[\n{\"position\":[0,0,NaN],\"radius\":1,\"parent\":-1}]}",
       ":2:"},
      {"a.skel.json",
       "{\"format\":\"cambium-skeleton\",\"version\":1,\"nodes\":[\n{\"position\":[0,0,0],\"radius\":1,\"parent\":-1,\"x\":"
       "1}]}",
       ":2:"},
      {"a.swc", "", ""},
      {"a.swc", "1 1 0 0 0 0.1 -1\n2 1 0 0 1 -0.1 1\n", ":2:"},
      {"a.swc", "1 1 0 0 0 0.1 -1\n2 1 0 0 1 0.1 9\n", ":2:"},
      {"a.swc", "1 1 0 0 0 0.1 2\n2 1 0 0 1 0.1 1\n", ":"},
      {"a.swc", "1 1 0 0 nan 0.1 -1\n", ":1:"},
      {"a.swc", "1 1 0 0 0\n", ":1:"},
      {"a.csv", "", ""},
      {"a.csv", "a,b,c\n1,2,3\n", ":1:"},
      {"a.csv", "startX,startY,startZ,endX,endY,endZ,radius,ID,parentID\n0,0,0,0,0,1,x,0,-1\n", ":2:"},
      {"a.csv", "startX,startY,startZ,endX,endY,endZ,radius,ID,parentID\n0,0,0,0,0,1,0.1,0,5\n", ":2:"},
      // BlobTrees.
      {"a.blob.json", "[]", ":1:"},
      {"a.blob.json", "{\"format\":\"cambium-blobtree\",\"version\":1,\"root\":\n{\"op\":\"ball\"}}", ":2:"},
      {"a.blob.json",
       "{\"format\":\"cambium-blobtree\",\"version\":1,\"root\":\n{\"op\":\"sphere\",\"center\":[0,0,0],\"radius\":0}}",
       ":2:"},
      {"a.blob.json",
       "{\"format\":\"cambium-blobtree\",\"version\":1,\"root\":\n{\"op\":\"sphere\",\"center\":[0,0,0],\"radius\":1,"
       "\"colour\":2}}",
       ":2:"},
      {"a.blob.json", "{\"format\":\"cambium-blobtree\",\"version\":1,\"root\":\n{\"op\":\"sum\",\"children\":[]}}", ":2:"},
      {"a.blob.json",
       "{\"format\":\"cambium-blobtree\",\"version\":1,\"root\":\n{\"op\":\"half_space\",\"point\":[0,0,0],\"normal\":[0,0,"
       "1],\"width\":1}}",
       ""},
  };
  for (const BadFile& bad : table) {
    SCOPED_TRACE(std::string(bad.name) + ": " + bad.text);
    const std::string path = folder_.write(bad.name, bad.text);
    expect_refused({"mesh", path, "-o", at("out.obj"), "--voxel", "20cm"}, path + bad.place);
  }
}

TEST_F(BadInput, PointsAreRefusedAtTheirPlace) {
  for (const auto& [text, place] :
       {std::pair("1,2\n", ":1:4: "), std::pair("x,y,z\n1,nan,3\n", ":2:3: "), std::pair("1,2,3,4\n", ":1:7: ")}) {
    const std::string path = folder_.write("bad.csv", text);
    expect_refused({"eval", at("tiny.blob.json"), "--points", path, "-o", at("f.csv")}, path + place);
  }
  expect_refused({"eval", at("tiny.blob.json"), "--points", at("none.csv"), "-o", at("f.csv")},
                 at("none.csv") + ": found no file");
}

TEST_F(BadInput, InputsThatAreNotThereAreNamed) {
  std::filesystem::create_directory(at("folder.swc"));
  folder_.write("tiny.xyz", "");
  expect_refused({"info", at("none.l")}, at("none.l") + ": found no file");
  expect_refused({"info", at("folder.swc")}, at("folder.swc") + ": found a directory");
  expect_refused({"info", at("tiny.xyz")}, at("tiny.xyz") + ": found an unknown extension");
}

TEST_F(BadInput, InputsOfTheWrongClassAreNamed) {
  expect_refused({"derive", at("tiny.swc")}, at("tiny.swc") + ": found no L-system");
  expect_refused({"grow", at("tiny.blob.json"), "-o", at("a.swc")}, at("tiny.blob.json") + ": found a BlobTree");
}

TEST_F(BadInput, OutputsThatCannotBeWrittenAreNamedBeforeTheWork) {
  std::filesystem::create_directory(at("folder.obj"));
  const std::string input = at("tiny.blob.json");
  expect_refused({"mesh", input, "-o", at("none/a.obj"), "--voxel", "0.1mm"},
                 at("none/a.obj") + ": found an output that cannot be written");
  expect_refused({"mesh", input, "-o", at("folder.obj"), "--voxel", "0.1mm"}, at("folder.obj") + ": ");
  expect_refused({"mesh", input, "-o", at("a.stl2")}, at("a.stl2") + ": found an unknown extension");
  expect_refused({"render", input, "-o", at("a.jpeg")}, at("a.jpeg") + ": ");
  expect_refused({"volume", input, "-o", at("a.obj")}, at("a.obj") + ": ");
  expect_refused({"grow", at("tiny.l"), "-o", at("a.csv")}, at("a.csv") + ": ");
  expect_refused({"surface", at("tiny.l"), "-o", at("a.json")}, at("a.json") + ": ");
}

TEST_F(BadInput, OptionsAreNamed) {
  const std::string input = at("tiny.blob.json");
  expect_refused({"render", input, "-o", at("a.png"), "--size", "0x0"}, "--size: found '0x0'");
  expect_refused({"render", input, "-o", at("a.png"), "--size", "10"}, "--size: ");
  expect_refused({"render", input, "-o", at("a.png"), "--samples", "0"}, "--samples: ");
  for (const char* samples : {"0..4", "8..4", "1..", "..4", "1...4", "65536", "four"})
    expect_refused({"render", input, "-o", at("a.png"), "--samples", samples}, std::string("--samples: found '") + samples + "'");
  expect_refused({"render", input, "-o", at("a.png"), "--noise", "2"}, "--noise: found 2,");
  expect_refused({"render", input, "-o", at("a.png"), "--bounces", "-1"}, "--bounces: found -1,");
  for (const char* crop : {"0,0,8", "0,0,8,8,8", "a,0,8,8", "0,-1,8,8", ","})
    expect_refused({"render", input, "-o", at("a.png"), "--crop", crop}, std::string("--crop: found '") + crop + "'");
  for (const char* crop : {"0,0,769,8", "8,8,8,9", "9,8,8,9"})
    expect_refused({"render", input, "-o", at("a.png"), "--crop", crop}, std::string("--crop: found the crop ") + crop + ",");
  expect_refused({"render", input, "-o", at("a.png"), "--bits", "12"}, "cambium: ");
  expect_refused({"render", input, "-o", at("a.png"), "--aov", "depth,beauty"}, "--aov: found 'beauty'");
  expect_refused({"render", input, "-o", at("a.jpg"), "--bits", "16"}, "--bits: found 16 bits of a .jpg");
  expect_refused({"render", input, "-o", at("a.jpg"), "--set", "render.background=transparent"}, at("a.jpg") + ": found a .jpg of a");
  expect_refused({"render", input, "-o", at("a.png"), "--frame", "2"}, "--frame: found frame 2 without a turntable");
  expect_refused({"render", input, "-o", at("a.png"), "--turntable", "3", "--frame", "4"}, "--frame: found frame 4, expected 1 to 3");
  expect_refused({"grow", at("tiny.l"), "-o", at("a.swc"), "--step", "0"}, "--step: found 0, expected a number");
  expect_refused({"grow", at("tiny.l"), "-o", at("a.swc"), "--step", "-1"}, "--step: found -1, expected a number");
  expect_refused({"grow", at("tiny.l"), "-o", at("a.swc"), "--step", "nan"}, "--step: found nan, expected a number");
  expect_refused({"grow", at("tiny.l"), "-o", at("a.swc"), "--step", "1e-5"}, "--step: found ");
  expect_refused({"grow", at("tiny.l"), "-o", at("a.swc"), "--frame", "2"}, "cambium: ");
  expect_refused({"grow", at("tiny.l"), "-o", at("a.swc"), "--step", "1", "--frame", "4"}, "--frame: found frame 4, expected 1 to 3");
  expect_refused({"grow", at("tiny.l"), "-o", at("a.png"), "--step", "1"}, at("a.0001.png") + ": found ");
  expect_refused({"grow", at("tiny.swc"), "-o", at("a.swc"), "--step", "1"}, at("tiny.swc") + ": found no L-system");
  expect_refused({"mesh", at("tiny.blob.json"), "-o", at("a.ply"), "--step", "1"}, at("tiny.blob.json") + ": found no L-system");
  expect_refused({"render", at("tiny.l"), "-o", at("a.png"), "--step", "1", "--turntable", "3"}, "--turntable: ");
  expect_refused({"render", at("tiny.l"), "-o", at("a.png"), "--step", "1", "--close-up", "0"}, "--close-up: ");
  expect_refused({"render", input, "-o", at("a.png"), "--close-up", "7"}, "--close-up: found branch 7");
  expect_refused({"mesh", input, "-o", at("a.obj"), "--voxel", "0"}, "--voxel: ");
  expect_refused({"mesh", input, "-o", at("a.obj"), "--voxel", "-2mm"}, "--voxel: ");
  expect_refused({"mesh", input, "-o", at("a.obj"), "--tolerance", "nan"}, "--tolerance: ");
  expect_refused({"mesh", input, "-o", at("a.obj"), "--up", "x"}, "--up: ");
  for (const char* count : {"0", "-5", "5x", "1.5", "many"})
    expect_refused({"mesh", input, "-o", at("a.obj"), "--max-triangles", count}, "--max-triangles: ");
  for (const char* levels : {"0", "5k,5k", "5k,6k", "5k,", ",5k", "5k,two", "5k 2k"})
    expect_refused({"mesh", input, "-o", at("a.obj"), "--lod", levels}, "--lod: ");
  for (const char* sides : {"3", "65", "six", "-6"})
    expect_refused({"mesh", input, "-o", at("a.obj"), "--min-sides", sides}, "cambium: found bad usage");
  expect_refused({"mesh", input, "-o", at("a.obj"), "--preview=soon"}, "cambium: found bad usage");
  expect_refused({"mesh", input, "-o", at("a.obj"), "--lod"}, "cambium: found bad usage");
  expect_refused({"mesh", input, "-o", at("a.obj"), "--verify=maybe"}, "cambium: found bad usage");
  expect_refused({"mesh", input, "-o", at("a.obj"), "--voxel", "1cm", "--tolerance", "1cm"}, "cambium: found bad usage");
  expect_refused({"volume", input, "-o", at("a.vdb"), "--voxel", "5 furlongs"}, "--voxel: ");
  expect_refused({"volume", input, "-o", at("a.vdb"), "--kind", "dense"}, "--kind: ");
  expect_refused({"info", input, "--set", "surface.lipp=2"}, "--set surface.lipp=2: found unknown key 'surface.lipp'");
  expect_refused({"info", input, "--set", "surface.lip"}, "--set surface.lip: found no '='");
  expect_refused({"info", input, "--threads", "-1"}, "cambium: found bad usage");
  expect_refused({"info", input, "--threads", "two"}, "cambium: found bad usage");
  expect_refused({"info", input, "--seed", "-1"}, "cambium: found bad usage");
  expect_refused({"info", input, "--frobnicate"}, "cambium: found bad usage");
  expect_refused({"info"}, "cambium: found bad usage");
  expect_refused({"mesh", input}, "cambium: found bad usage");
  expect_refused({"plant", input}, "cambium: found bad usage");
  expect_refused({}, "cambium: found bad usage");
}

TEST_F(BadInput, AFullDiskIsNoFaultOfTheInput) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const Ran ran = run_program({"derive", at("tiny.l"), "-o", "/dev/full"});
  EXPECT_EQ(ran.status, 1);
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
}

}  // namespace
}  // namespace cambium
