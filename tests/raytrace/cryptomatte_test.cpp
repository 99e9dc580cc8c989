#include "raytrace/cryptomatte.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>

namespace cambium {
namespace {

// The values that Psyop's own tests hold.
TEST(Cryptomatte, IdsAreThoseOfTheReferenceImplementation) {
  EXPECT_FLOAT_EQ(id_from_hash(murmur3("hello")), 6.0705627102400005616e-17f);
  EXPECT_FLOAT_EQ(id_from_hash(murmur3("cube")), -4.08461912519e+15f);
  EXPECT_FLOAT_EQ(id_from_hash(murmur3("sphere")), 2.79018604383e+15f);
  EXPECT_FLOAT_EQ(id_from_hash(murmur3("plane")), 3.66557617593e-11f);
  EXPECT_FLOAT_EQ(id_from_hash(murmur3("m\xc3\xa4" "dchen")), 6.2361298211599995797e+25f);
}

TEST(Cryptomatte, IdsAreNormalNumbers) {
  for (const std::uint32_t hash : {0u, 0x7f800000u, 0x7fc00001u, 0xffffffffu, 0x80000000u, 0x00000001u}) {
    EXPECT_TRUE(std::isnormal(id_from_hash(hash))) << hash;
  }
}

TEST(Cryptomatte, RanksFallAndAddUpToWhatIsHit) {
  FirstHitSum sum;
  CameraSample sample;
  for (int branch : {4, -1, 4, 2, 4, 2}) {
    sample.depth = 1;
    sample.branch = branch;
    sum.add(sample);
  }
  const auto ranks = matte_ranks(sum, 8);
  EXPECT_EQ(ranks[0], id_from_hash(murmur3("branch_4")));
  EXPECT_EQ(ranks[1], 3 / 8.0f);
  EXPECT_EQ(ranks[2], id_from_hash(murmur3("branch_2")));
  EXPECT_EQ(ranks[3], 2 / 8.0f);
  EXPECT_EQ(ranks[4], id_from_hash(murmur3("ground")));
  EXPECT_EQ(matte_name(kLeaves), "leaves");
  EXPECT_EQ(ranks[5], 1 / 8.0f);
  for (std::size_t i = 6; i < ranks.size(); ++i) EXPECT_EQ(ranks[i], 0);
}

TEST(Cryptomatte, ATwigBundleOfTwelveInOnePixelIsCountedWhole) {
  FirstHitSum sum;
  CameraSample sample;
  sample.depth = 1;
  for (int i = 0; i < 24; ++i) {
    sample.branch = i % 12;
    sum.add(sample);
  }
  const auto ranks = matte_ranks(sum, 24);
  float covered = 0;
  for (int rank = 0; rank < kMatteRanks; ++rank) covered += ranks[2 * rank + 1];
  EXPECT_FLOAT_EQ(covered, 1);
}

TEST(Cryptomatte, TwoRanksGoToALayer) {
  const auto channels = matte_channels();
  ASSERT_EQ(channels.size(), 24u);
  EXPECT_EQ(channels.front(), "CryptoBranch00.r");
  EXPECT_EQ(channels[5], "CryptoBranch01.g");
  EXPECT_EQ(channels.back(), "CryptoBranch05.a");
}

TEST(Cryptomatte, MetadataNamesTheLayerAndItsBranches) {
  const auto pairs = matte_metadata("CryptoBranch", {-1, 12});
  const std::map<std::string, std::string> found(pairs.begin(), pairs.end());
  char key[9];
  std::snprintf(key, sizeof key, "%08x", static_cast<unsigned>(murmur3("CryptoBranch")));
  const std::string prefix = "cryptomatte/" + std::string(key, 7) + "/";
  EXPECT_EQ(found.at(prefix + "name"), "CryptoBranch");
  EXPECT_EQ(found.at(prefix + "hash"), "MurmurHash3_32");
  EXPECT_EQ(found.at(prefix + "conversion"), "uint32_to_float32");
  char ids[2][9];
  int i = 0;
  for (const char* name : {"ground", "branch_12"}) {
    std::snprintf(ids[i++], 9, "%08x", static_cast<unsigned>(std::bit_cast<std::uint32_t>(id_from_hash(murmur3(name)))));
  }
  EXPECT_EQ(found.at(prefix + "manifest"),
            "{\"ground\":\"" + std::string(ids[0]) + "\",\"branch_12\":\"" + std::string(ids[1]) + "\"}");
}

}  // namespace
}  // namespace cambium
