// How to run a long job, as opposed to what it makes.
#pragma once

#include <atomic>
#include <functional>
#include <string_view>

namespace cambium {

/// Long functions take one of these, return std::nullopt when cancelled, and give the same result for any thread count.
struct RunOptions {
  int threads = 0;                                   ///< 0: all cores
  const std::atomic<bool>* cancel = nullptr;         ///< polled at least every 50 ms
  std::function<void(std::string_view stage, double fraction)> progress;  ///< may be called from any thread, one at a time

  bool cancelled() const { return cancel && cancel->load(std::memory_order_relaxed); }
};

}  // namespace cambium
