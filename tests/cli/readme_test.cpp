// The README's C++ example is examples/library_example.cpp, which the package test compiles, links and runs.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace cambium {
namespace {

std::string text_of(const char* name) {
  std::ifstream file(std::filesystem::path(CAMBIUM_SOURCE) / name);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Readme, ExampleIsTheOneThatIsCompiled) {
  const std::string readme = text_of("README.md"), example = text_of("examples/library_example.cpp");
  ASSERT_FALSE(example.empty());
  const std::string fence = "```cpp\n";
  const auto begin = readme.find(fence);
  ASSERT_NE(begin, std::string::npos);
  const auto end = readme.find("```", begin + fence.size());
  EXPECT_EQ(readme.substr(begin + fence.size(), end - begin - fence.size()), example);
}

}  // namespace
}  // namespace cambium
