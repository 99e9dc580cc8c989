// A growing plant in pictures: one command done once for each of a row of times.
#pragma once

#include "cli/commands.h"

namespace cambium {

/// `command` (grow, mesh or render) at derivation step 0, --step, twice --step and so on up to the last step, or only for
/// the one that --frame names, into numbered files: tree.0001.png at step 0, and on. All pictures are framed on the last.
/// Where nothing has grown yet there is nothing to mesh or to render: no file is made, and a warning says so. Each file is
/// there whole or not at all, interrupted or not. Errors: InputError for a step of 0 or less, more than 9999 frames, an
/// input that is no L-system, and what cannot be together with --step.
Outcome run_frames(Job& job, Outcome (*command)(Job&));

}  // namespace cambium
