// The commands of the program, one function each. Every one checks its output first, then works, then commits the output.
#pragma once

#include "cli/job.h"

namespace cambium {

// Errors of all: InputError for bad input and options, std::exception for anything else. An interrupted command leaves no
// file.
Outcome run_derive(Job& job);
Outcome run_grow(Job& job);
Outcome run_surface(Job& job);
Outcome run_eval(Job& job);
Outcome run_mesh(Job& job);
Outcome run_volume(Job& job);
Outcome run_render(Job& job);
Outcome run_info(Job& job);

}  // namespace cambium
