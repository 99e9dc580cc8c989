// The fuzzer's corpus, and whatever it has found, once more. Each file gets through without anything but an InputError.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace cambium {
namespace {

TEST(FuzzCorpus, EveryInputIsReadOrRefused) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CAMBIUM_LSYSTEM_CORPUS)) {
    std::ifstream stream(entry.path(), std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    const std::string bytes = text.str();
    SCOPED_TRACE(entry.path());
    EXPECT_EQ(LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()), 0);
    ++count;
  }
  EXPECT_GT(count, 50u);
}

}  // namespace
}  // namespace cambium
