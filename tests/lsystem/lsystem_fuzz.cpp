// libFuzzer's entry: any bytes as an L-system of any dialect, parsed, derived, explained and drawn, and as each of the files that may
// stand beside one. What it throws but an InputError is a finding.
// Also part of the tests, which replay corpus/.
#include "lsystem/contour_file.h"
#include "lsystem/curve.h"
#include "lsystem/growth.h"
#include "lsystem/lsystem.h"
#include "lsystem/patch_surface.h"
#include "lsystem/view_file.h"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <thread>

namespace cambium {
namespace {

using Clock = std::chrono::steady_clock;

// Cancels what takes longer than a fraction of a second, so that a slow input costs little and one that cannot be cancelled is found.
class Deadline {
 public:
  Deadline() {
    std::thread([this] {
      while (true) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        if (Clock::now().time_since_epoch().count() > until_) passed_ = true;
      }
    }).detach();
  }
  const std::atomic<bool>* begin() {
    until_ = (Clock::now() + std::chrono::milliseconds(200)).time_since_epoch().count();
    passed_ = false;
    return &passed_;
  }

 private:
  std::atomic<Clock::rep> until_{0};
  std::atomic<bool> passed_{false};
};

/// A first line that is a comment in its dialect names it.
Dialect dialect_in(std::string_view text) {
  if (text.starts_with("#lpy\n")) return Dialect::kLpy;
  return text.starts_with("#houdini\n") ? Dialect::kHoudini : Dialect::kCpfg;
}

void derive_and_draw(std::string_view text) {
  static Deadline& deadline = *new Deadline;   // outlives main, as its thread does
  // A folder that is not there: nothing is included, and no curves are found.
  const LSystem system = LSystem::parse(text, "/nonexistent/fuzzed.l", std::nullopt, dialect_in(text));
  DeriveOptions options;
  options.steps = 4;
  options.max_modules = 3000;
  options.print = [](std::string_view) {};
  RunOptions run;
  run.threads = 1;
  run.cancel = deadline.begin();
  const auto string = derive(system, options, run);
  if (!string) return;
  if (const auto step = explain_step(system, options, run)) to_text(*step);
  TurtleOptions turtle;
  turtle.max_modules = 3000;
  options.turtle = turtle;
  Growth growth(system, options, run);
  if (const auto grown = growth.at(2.5)) interpret(*grown, system, turtle, run);
  if (!run.cancelled()) interpret(*string, system, turtle, run);
}

template <class Read>
void read_or_refuse(Read&& read) {
  try {
    read();
  } catch (const InputError&) {
  }
}

}  // namespace
}  // namespace cambium

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cambium;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read_or_refuse([&] { derive_and_draw(text); });
  read_or_refuse([&] { read_view_file(text, "/nonexistent/fuzzed.v"); });
  read_or_refuse([&] { read_patch_surface(text, "/nonexistent/fuzzed.s", "l", 1); });
  read_or_refuse([&] { read_contour_radius(text, "/nonexistent/fuzzed.con"); });
  read_or_refuse([&] { read_curves(text, "/nonexistent/fuzzed.func"); });
  return 0;
}
