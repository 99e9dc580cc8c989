// Progress of work that is done in many uneven pieces by many threads.
#pragma once

#include "blobtree/run_options.h"

#include <algorithm>
#include <mutex>
#include <string>

namespace cambium {

/// Calls run.progress one thread at a time, in steps of at least a percent, never backwards.
class ProgressMeter {
 public:
  /// run outlives it.
  ProgressMeter(const RunOptions& run, std::string stage) : run_(run), stage_(std::move(stage)) {}
  ProgressMeter(RunOptions&& run, std::string stage) = delete;

  void add(double fraction) {
    if (!run_.progress) return;
    const std::lock_guard lock(mutex_);
    done_ += fraction;
    if (done_ < told_ + 0.01) return;
    told_ = std::min(done_, 1.0);
    run_.progress(stage_, told_);
  }
  void finish() {
    if (!run_.progress) return;
    const std::lock_guard lock(mutex_);
    told_ = 1;
    run_.progress(stage_, 1.0);
  }

 private:
  const RunOptions& run_;
  std::string stage_;
  std::mutex mutex_;
  double done_ = 0, told_ = 0;
};

}  // namespace cambium
