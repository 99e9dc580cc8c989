#include "bench/process_memory.h"

#include <fstream>
#include <string>

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
void reset_peak_resident_bytes() { std::ofstream("/proc/self/clear_refs") << "5\n"; }

}  // namespace cambium::bench
