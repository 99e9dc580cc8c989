// Wall-clock seconds of one piece of work, for what takes too long to be repeated many times.
#pragma once

#include <chrono>
#include <utility>

namespace cambium::bench {

inline double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// What `work` returns, and the seconds it took.
template <class Work>
auto timed(double& seconds, Work&& work) {
  const double begin = seconds_now();
  auto result = std::forward<Work>(work)();
  seconds = seconds_now() - begin;
  return result;
}

}  // namespace cambium::bench
