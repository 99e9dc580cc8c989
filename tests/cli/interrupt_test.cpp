// Ctrl-C during long work of the real program.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "program.h"
#include "raytrace/image_file.h"
#include "temporary_folder.h"
#include "tiny_inputs.h"

namespace cambium {
namespace {

using std::chrono::milliseconds;

// Much longer than the 200 ms promised, for machines that are busy with other tests.
constexpr milliseconds kPatience{1000};

class Interrupt : public ::testing::Test {
 protected:
  /// Interrupts a command as soon as its temporary file stands beside its output, and a while later.
  void expect_clean_end(std::vector<std::string> arguments, const std::string& output, milliseconds pause,
                        int signal = SIGINT) {
    const std::vector<std::string> before = folder_.names();
    arguments.insert(arguments.end(), {"-o", folder_.path(output)});
    const auto working = [&] { return folder_.names().size() > before.size(); };
    const Ran ran = run_program_and_signal(arguments, working, pause, signal);
    EXPECT_EQ(ran.status, 1) << ran.out << ran.err;
    EXPECT_EQ(ran.out, "");
    EXPECT_LT(ran.since_signal, kPatience);
    EXPECT_EQ(folder_.names(), before);
  }

  TemporaryFolder folder_;
};

TEST_F(Interrupt, EndsALongRenderAndLeavesNothing) {
  const std::string input = folder_.write("tiny.skel.json", kTinySkeleton);
  for (const int pause : {0, 300})
    expect_clean_end({"render", input, "--size", "8000x8000", "--samples", "256", "--aov", "depth"}, "a.png",
                     milliseconds(pause));
}

TEST_F(Interrupt, OfGrowingFramesLeavesWholeOnesAlone) {
  const std::string input = folder_.write("tiny.l", kTinyLSystem);
  const std::vector<std::string> arguments = {"render", input, "-o", folder_.path("a.png"), "--step", "1", "--size", "3000x3000",
                                              "--samples", "256", "--frame", "3"};
  const std::vector<std::string> before = folder_.names();
  const auto working = [&] { return folder_.names().size() > before.size(); };
  const Ran ran = run_program_and_signal(arguments, working, milliseconds(0), SIGINT);
  EXPECT_EQ(ran.status, 1) << ran.err;
  EXPECT_EQ(folder_.names(), before);
}

TEST_F(Interrupt, KeepsTheLastFinishedPassOfARender) {
  const std::string input = folder_.write("tiny.skel.json", kTinySkeleton);
  const std::vector<std::string> before = folder_.names();
  const std::vector<std::string> arguments = {"render", input, "--size", "24x32", "--samples", "1..65535", "--noise", "0", "-o"};
  for (const char* name : {"a.png", "a.exr"}) {
    std::vector<std::string> with_output = arguments;
    with_output.push_back(folder_.path(name));
    const auto working = [&] { return folder_.names().size() > before.size(); };
    const Ran ran = run_program_and_signal(with_output, working, milliseconds(1500), SIGINT);
    EXPECT_EQ(ran.status, 1) << ran.out << ran.err;
    EXPECT_EQ(ran.out, "");
    EXPECT_NE(ran.err.find("holds the last finished pass: up to "), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find(" of 65535 samples a pixel"), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("cambium: interrupted"), std::string::npos) << ran.err;
    const Pixels kept = read_pixels(folder_.path(name));
    EXPECT_EQ(kept.width, 24);
    EXPECT_EQ(kept.height, 32);
    std::filesystem::remove(folder_.path(name));
    EXPECT_EQ(folder_.names(), before);
  }
}

TEST_F(Interrupt, EndsALongMeshAndLeavesNothing) {
  const std::string input = folder_.write("tiny.skel.json", kTinySkeleton);
  for (const int pause : {0, 300}) expect_clean_end({"mesh", input, "--voxel", "0.5mm"}, "a.glb", milliseconds(pause));
}

TEST_F(Interrupt, EndsALongVolumeAndLeavesNothing) {
  const std::string input = folder_.write("tiny.skel.json", kTinySkeleton);
  expect_clean_end({"volume", input, "--voxel", "0.4mm"}, "a.vdb", milliseconds(300), SIGTERM);
}

TEST_F(Interrupt, EndsALongDerivationAndLeavesNothing) {
  const std::string input = folder_.write("long.l", "lsystem: long\nderivation length: 100000\naxiom: A(0)\nA(x) : x < 1e9 --> A(x+1)\nendlsystem\n");
  expect_clean_end({"derive", input, "--set", "skeleton.steps=1000000"}, "a.txt", milliseconds(0));
}

}  // namespace
}  // namespace cambium
