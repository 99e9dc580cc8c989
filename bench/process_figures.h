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

/// What one thread has had of the processors, and how long it waited for one that others used; seconds.
struct ThreadTime {
  double ran = 0, waited = 0;
};
/// Of each thread alive, by its id.
std::map<int, ThreadTime> thread_times();

/// What threads had since `before`: the one that ran most, and all their waiting. Zeros where that is not known.
struct ThreadsSince {
  double busiest_ran = 0, waited = 0;
};
ThreadsSince threads_since(const std::map<int, ThreadTime>& before);

}  // namespace cambium::bench
