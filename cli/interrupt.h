// Ctrl-C and termination: first ask the work to stop, then stop the process.
#pragma once

#include <atomic>

namespace cambium {

/// Catches SIGINT, SIGTERM and SIGHUP from now on. The flag turns true with the first of them; work that polls it ends by
/// itself. Work that has not ended 120 ms later (a library call that does not poll) is ended: the unfinished output files
/// are removed and the process exits with 1. Ignores SIGPIPE, so that a closed stdout is an error like any other. Call once.
const std::atomic<bool>& catch_interrupts();

/// From now on the first signal leaves the work as long as it needs: interrupted, it still finishes and writes what it has.
/// A second signal ends the process at once, as above. Any thread may call this, also after the first signal.
void take_time_to_finish();

}  // namespace cambium
