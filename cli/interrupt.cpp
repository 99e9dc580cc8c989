#include "cli/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>

#include "cli/output_file.h"

namespace cambium {
namespace {

// A signal handler can reach nothing but globals.
std::atomic<bool> interrupted{false};
std::atomic<bool> finishing{false};
int wake_pipe[2] = {-1, -1};

constexpr std::chrono::milliseconds kGrace{120};  // with polls every 50 ms and an exit this keeps Ctrl-C below 200 ms

void on_signal(int) {
  const int saved_errno = errno;
  interrupted.store(true, std::memory_order_relaxed);
  const char byte = 0;
  [[maybe_unused]] const auto written = ::write(wake_pipe[1], &byte, 1);
  errno = saved_errno;
}

void wait_for_signal() {
  char byte = 0;
  while (::read(wake_pipe[0], &byte, 1) != 1) {
  }
}

void wait_and_end() {
  wait_for_signal();
  std::this_thread::sleep_for(kGrace);
  if (finishing.load()) wait_for_signal();
  OutputFile::remove_unfinished_and_exit(1);
}

}  // namespace

const std::atomic<bool>& catch_interrupts() {
  if (::pipe(wake_pipe) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  std::thread(wait_and_end).detach();
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
  return interrupted;
}

void take_time_to_finish() { finishing.store(true); }

}  // namespace cambium
