// Runs the real program as a user would.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace cambium {

struct Ran {
  int status = -1;  ///< exit status; -1 if a signal ended it
  std::string out, err;
  std::chrono::milliseconds since_signal{0};  ///< from the signal to the end
};

/// Runs `cambium arguments...` to its end.
Ran run_program(const std::vector<std::string>& arguments);

/// Starts it, waits until `ready` is true (polled) or it has ended, and a further `pause`, sends `signal`, waits for the
/// end.
Ran run_program_and_signal(const std::vector<std::string>& arguments, const std::function<bool()>& ready,
                           std::chrono::milliseconds pause, int signal);

}  // namespace cambium
