// Cryptomatte: which branch covers how much of each pixel, for picking branches in compositing.
// Friedman and Jones 2015; specification 1.2.0 (Psyop 2018).
#pragma once

#include "raytrace/pixel_sum.h"

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cambium {

/// MurmurHash3_x86_32 with seed 0 (Appleby, public domain).
std::uint32_t murmur3(std::string_view text);

/// The hash with its exponent kept from 0 and 255, so that it is neither denormal, infinite nor NaN ("uint32_to_float32").
float id_from_hash(std::uint32_t hash);

/// "branch_12"; "ground" for -1, "leaves" for kLeaves.
std::string matte_name(std::int32_t branch);

constexpr const char* kMatteLayer = "CryptoBranch";
constexpr int kMatteRanks = FirstHitSum::kShares;   ///< always all of them, so that crops and frames have the same layers
/// "CryptoBranch00.r" to "CryptoBranch05.a": two ranks to a layer.
std::vector<std::string> matte_channels();

/// Ranks of one pixel, largest coverage first: id and coverage by turns, 0 where there are no more. What no branch covers (the
/// sky) has no rank: the coverages add up to the share of samples that hit something, at most 1.
std::array<float, 2 * kMatteRanks> matte_ranks(const FirstHitSum& hits, int samples);

/// Attributes of the file for the layers `layer`00, `layer`01 and so on: names with their texts.
std::vector<std::pair<std::string, std::string>> matte_metadata(std::string_view layer, const std::set<std::int32_t>& branches);

}  // namespace cambium
