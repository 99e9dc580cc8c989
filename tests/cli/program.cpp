#include "program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>
#include <thread>

#include "temporary_folder.h"

namespace cambium {
namespace {

using Clock = std::chrono::steady_clock;

pid_t start(const std::vector<std::string>& arguments, const std::string& out, const std::string& err) {
  const char* program = CAMBIUM_PROGRAM;
  std::vector<char*> argv = {const_cast<char*>(program)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child > 0) return child;
  const int out_file = ::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int err_file = ::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  ::dup2(out_file, STDOUT_FILENO);
  ::dup2(err_file, STDERR_FILENO);
  ::execv(program, argv.data());
  ::_exit(127);
}

int exit_status(int wait_status) { return WIFEXITED(wait_status) ? WEXITSTATUS(wait_status) : -1; }

}  // namespace

Ran run_program(const std::vector<std::string>& arguments) {
  TemporaryFolder streams;
  const pid_t child = start(arguments, streams.path("out"), streams.path("err"));
  int wait_status = 0;
  ::waitpid(child, &wait_status, 0);
  return {exit_status(wait_status), streams.read("out"), streams.read("err"), {}};
}

Ran run_program_and_signal(const std::vector<std::string>& arguments, const std::function<bool()>& ready,
                           std::chrono::milliseconds pause, int signal) {
  TemporaryFolder streams;
  const pid_t child = start(arguments, streams.path("out"), streams.path("err"));
  int wait_status = 0;
  bool ended = false;
  while (!ready() && !ended) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    ended = ::waitpid(child, &wait_status, WNOHANG) == child;
  }
  Clock::time_point sent = Clock::now();
  if (!ended) {
    std::this_thread::sleep_for(pause);
    sent = Clock::now();
    ::kill(child, signal);
    ::waitpid(child, &wait_status, 0);
  }
  const auto since = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - sent);
  return {exit_status(wait_status), streams.read("out"), streams.read("err"), since};
}

}  // namespace cambium
