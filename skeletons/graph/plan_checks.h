// What settings of a plan are refused, before anything is grown.
#pragma once

#include "blobtree/input_error.h"
#include "skeletons/graph/plan.h"

namespace cambium {

/// Errors: InputError (no location) as plan_tree says, of what can be seen from the settings alone. Solids are looked at where their
/// volume is made.
void check_plan(const GraphOptions& options);

/// Errors: InputError for a level whose graphs have more nodes in all than a machine would hold on to.
void check_level_size(std::size_t level, double graphs, std::size_t nodes);

/// Calls make() and puts `where` in front of what an InputError of it found.
template <class Make>
auto naming(const std::string& where, Make&& make) {
  try {
    return make();
  } catch (const InputError& error) {
    throw InputError(error.location(), where + ": " + error.found(), error.expected());
  }
}

}  // namespace cambium
