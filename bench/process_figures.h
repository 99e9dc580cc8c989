// What the operating system says of this process (Linux; elsewhere nothing).
#pragma once

#include <cstddef>
#include <map>

namespace cambium::bench {

std::size_t resident_bytes();
/// The most that was resident since the peak was last reset, or since the program began where a kernel cannot reset it.
std::size_t peak_resident_bytes();
/// Gives freed memory back first, so that what is used again counts again.
void reset_peak_resident_bytes();

/// Processor seconds that each thread alive has had, by its id.
std::map<int, double> thread_seconds();
/// The most that any thread has had since `before`; 0 where that is not known.
double busiest_thread_seconds(const std::map<int, double>& before);

}  // namespace cambium::bench
