#include "bench/process_figures.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace cambium::bench {
namespace {

/// A line such as "VmRSS:   1234 kB".
std::size_t status_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == key) {
      std::size_t kilobytes = 0;
      status >> kilobytes;
      return kilobytes * 1024;
    }
  return 0;
}

}  // namespace

std::size_t resident_bytes() { return status_bytes("VmRSS:"); }
std::size_t peak_resident_bytes() { return status_bytes("VmHWM:"); }

void reset_peak_resident_bytes() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
  std::ofstream("/proc/self/clear_refs") << "5\n";
}

std::map<int, double> thread_seconds() {
  std::map<int, double> seconds;
  std::error_code none;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", none)) {
    std::ifstream schedule(task.path() / "schedstat");
    double nanoseconds = 0;
    if (schedule >> nanoseconds) seconds[std::atoi(task.path().filename().c_str())] = nanoseconds * 1e-9;
  }
  return seconds;
}

double busiest_thread_seconds(const std::map<int, double>& before) {
  double most = 0;
  for (const auto& [thread, seconds] : thread_seconds()) {
    const auto known = before.find(thread);
    most = std::max(most, seconds - (known == before.end() ? 0 : known->second));
  }
  return most;
}

}  // namespace cambium::bench
