// What this process holds of the machine's memory (Linux; elsewhere 0).
#pragma once

#include <cstddef>

namespace cambium::bench {

std::size_t resident_bytes();
/// The most that was resident since the peak was last reset, or since the program began where a kernel cannot reset it.
std::size_t peak_resident_bytes();
void reset_peak_resident_bytes();

}  // namespace cambium::bench
