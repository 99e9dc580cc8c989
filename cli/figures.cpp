#include "cli/figures.h"

#include <sys/resource.h>

#include <cmath>

namespace cambium {
namespace {

double in_milliseconds(double seconds) { return std::round(seconds * 1e3) / 1e3; }

std::size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace

void Figures::add_seconds(const std::string& stage, double seconds) {
  seconds_[stage] = in_milliseconds(seconds_.value(stage, 0.0) + seconds);
}

Json Figures::object() const {
  Json result = values_;
  result["seconds"] = seconds_;
  result["seconds"]["total"] = in_milliseconds(std::chrono::duration<double>(Clock::now() - begin_).count());
  result["peak_memory_bytes"] = peak_memory_bytes();
  return result;
}

}  // namespace cambium
