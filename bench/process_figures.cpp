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

std::map<int, ThreadTime> thread_times() {
  std::map<int, ThreadTime> times;
  std::error_code none;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task", none)) {
    std::ifstream schedule(task.path() / "schedstat");
    double ran = 0, waited = 0;  // nanoseconds
    if (schedule >> ran >> waited) times[std::atoi(task.path().filename().c_str())] = {ran * 1e-9, waited * 1e-9};
  }
  return times;
}

ThreadsSince threads_since(const std::map<int, ThreadTime>& before) {
  ThreadsSince since;
  for (const auto& [thread, time] : thread_times()) {
    const auto known = before.find(thread);
    const ThreadTime then = known == before.end() ? ThreadTime{} : known->second;
    since.busiest_ran = std::max(since.busiest_ran, time.ran - then.ran);
    since.waited += time.waited - then.waited;
  }
  return since;
}

}  // namespace cambium::bench
