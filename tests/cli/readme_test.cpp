// The README's C++ examples are those of examples/, which the package test compiles, links and runs.
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

TEST(Readme, ExamplesAreThoseThatAreCompiled) {
  const std::string readme = text_of("README.md"), fence = "```cpp\n";
  std::size_t at = 0;
  for (const char* file : {"examples/library_example.cpp", "examples/field_example.cpp"}) {
    const std::string example = text_of(file);
    ASSERT_FALSE(example.empty());
    const auto begin = readme.find(fence, at);
    ASSERT_NE(begin, std::string::npos) << file;
    at = readme.find("```", begin + fence.size());
    EXPECT_EQ(readme.substr(begin + fence.size(), at - begin - fence.size()), example);
  }
}

}  // namespace
}  // namespace cambium
