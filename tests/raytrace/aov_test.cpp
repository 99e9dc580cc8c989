#include "raytrace/aov.h"

#include "blobtree/input_error.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

TEST(Aov, EveryOneIsAtItsPlaceWithNamesOfItsOwn) {
  std::set<std::string> names, channels;
  std::size_t count = 0;
  for (const AovInfo& info : all_aovs()) {
    EXPECT_EQ(static_cast<std::size_t>(info.aov), &info - all_aovs().data());
    EXPECT_EQ(&info_of(info.aov), &info);
    EXPECT_EQ(aov_named(info.name), info.aov);
    names.insert(info.name);
    channels.insert(info.channels.begin(), info.channels.end());
    count += info.channels.size();
  }
  EXPECT_EQ(names.size(), all_aovs().size());
  EXPECT_EQ(channels.size(), count);
}

TEST(Aov, AnUnknownNameIsRefusedWithThoseThereAre) {
  try {
    aov_named("beauty");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.found(), "'beauty'");
    EXPECT_NE(error.expected().find("cryptomatte"), std::string::npos);
  }
}

}  // namespace
}  // namespace cambium
