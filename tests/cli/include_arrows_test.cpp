// The folders' #include lines follow the arrows: lsystem -> skeletons -> blobtree <- polygonize, raytrace; cli on top.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>

namespace cambium {
namespace {

TEST(IncludeArrows, FoldersIncludeOnlyWhatTheyMay) {
  const std::set<std::string> all = {"blobtree", "skeletons", "lsystem", "polygonize", "raytrace", "cli"};
  const std::map<std::string, std::set<std::string>> allowed = {
      {"blobtree", {"blobtree"}},
      {"skeletons", {"skeletons", "blobtree"}},
      {"lsystem", {"lsystem", "skeletons", "blobtree"}},
      {"polygonize", {"polygonize", "blobtree"}},
      {"raytrace", {"raytrace", "blobtree"}},
      {"cli", all},
  };
  const std::regex include_line(R"re(^\s*#\s*include\s*"([a-z]+)/.*)re");
  for (const auto& [folder, targets] : allowed) {
    std::size_t files = 0, ours = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(std::filesystem::path(CAMBIUM_SOURCE) / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp") continue;
      ++files;
      std::ifstream file(entry.path());
      std::smatch match;
      for (std::string line; std::getline(file, line);) {
        if (!std::regex_match(line, match, include_line)) continue;
        ++ours;
        EXPECT_TRUE(targets.contains(match[1])) << entry.path() << " includes " << match[1];
      }
    }
    EXPECT_GT(files, 0u) << folder;
    EXPECT_GT(ours, 0u) << folder;
  }
}

TEST(IncludeArrows, OnlyTheCommandLinePrintsOrExits) {
  const std::regex printing(R"(\b(std::cout|std::cerr|std::clog|printf|puts|std::exit|abort|_Exit)\b\s*(\(|<<))");
  for (const char* folder : {"blobtree", "skeletons", "lsystem", "polygonize", "raytrace"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(std::filesystem::path(CAMBIUM_SOURCE) / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension != ".h" && extension != ".cpp") continue;
      std::ifstream file(entry.path());
      int number = 0;
      for (std::string line; std::getline(file, line);) {
        ++number;
        EXPECT_FALSE(std::regex_search(line, printing)) << entry.path() << ":" << number << ": " << line;
      }
    }
}

}  // namespace
}  // namespace cambium
