#include "raytrace/cryptomatte.h"

#include <bit>
#include <cstdio>

namespace cambium {
namespace {

std::uint32_t hash_word(std::uint32_t word) { return std::rotl(word * 0xcc9e2d51u, 15) * 0x1b873593u; }

std::uint32_t little_endian(std::string_view bytes) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) word |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
  return word;
}

std::string hexadecimal(std::uint32_t value) {
  char text[9];
  std::snprintf(text, sizeof text, "%08x", static_cast<unsigned>(value));
  return text;
}

}  // namespace

std::uint32_t murmur3(std::string_view text) {
  const auto length = static_cast<std::uint32_t>(text.size());
  std::uint32_t hash = 0;
  for (; text.size() >= 4; text.remove_prefix(4)) {
    hash = std::rotl(hash ^ hash_word(little_endian(text.substr(0, 4))), 13) * 5 + 0xe6546b64u;
  }
  hash ^= hash_word(little_endian(text));
  hash ^= length;
  hash = (hash ^ (hash >> 16)) * 0x85ebca6bu;
  hash = (hash ^ (hash >> 13)) * 0xc2b2ae35u;
  return hash ^ (hash >> 16);
}

float id_from_hash(std::uint32_t hash) {
  const std::uint32_t exponent = std::clamp((hash >> 23) & 255u, 1u, 254u);
  return std::bit_cast<float>((hash & 0x807fffffu) | (exponent << 23));
}

std::string matte_name(std::int32_t branch) {
  if (branch == kLeaves) return "leaves";
  return branch < 0 ? "ground" : "branch_" + std::to_string(branch);
}

std::vector<std::string> matte_channels() {
  std::vector<std::string> channels;
  for (int layer = 0; layer < kMatteRanks / 2; ++layer) {
    char number[3];
    std::snprintf(number, sizeof number, "%02u", static_cast<unsigned>(layer) % 100);
    for (const char channel : {'r', 'g', 'b', 'a'}) channels.push_back(std::string(kMatteLayer) + number + '.' + channel);
  }
  return channels;
}

std::array<float, 2 * kMatteRanks> matte_ranks(const FirstHitSum& hits, int samples) {
  auto shares = hits.shares;
  std::stable_sort(shares.begin(), shares.end(), [](const BranchShare& a, const BranchShare& b) { return a.samples > b.samples; });
  std::array<float, 2 * kMatteRanks> ranks{};
  for (int rank = 0; rank < kMatteRanks && shares[rank].samples > 0; ++rank) {
    ranks[2 * rank] = id_from_hash(murmur3(matte_name(shares[rank].branch)));
    ranks[2 * rank + 1] = float(shares[rank].samples) / float(samples);
  }
  return ranks;
}

std::vector<std::pair<std::string, std::string>> matte_metadata(std::string_view layer, const std::set<std::int32_t>& branches) {
  const std::string prefix = "cryptomatte/" + hexadecimal(murmur3(layer)).substr(0, 7) + "/";
  std::string manifest;
  for (const std::int32_t branch : branches) {
    const std::string name = matte_name(branch);
    const float id = id_from_hash(murmur3(name));
    manifest += (manifest.empty() ? "\"" : ",\"") + name + "\":\"" + hexadecimal(std::bit_cast<std::uint32_t>(id)) + "\"";
  }
  return {{prefix + "name", std::string(layer)},
          {prefix + "hash", "MurmurHash3_32"},
          {prefix + "conversion", "uint32_to_float32"},
          {prefix + "manifest", "{" + manifest + "}"}};
}

}  // namespace cambium
