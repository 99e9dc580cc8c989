// Seconds of one piece of work, for what takes too long to be repeated many times.
#pragma once

#include <chrono>
#include <ctime>
#include <utility>

namespace cambium::bench {

inline double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Of all threads of this process, user and system: other programs on the machine do not count.
inline double processor_seconds_now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// What `work` returns, and the seconds it took by the wall clock.
template <class Work>
auto timed(double& seconds, Work&& work) {
  const double begin = seconds_now();
  auto result = std::forward<Work>(work)();
  seconds = seconds_now() - begin;
  return result;
}

}  // namespace cambium::bench
