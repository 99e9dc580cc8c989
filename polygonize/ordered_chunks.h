// Parallel loops whose results come in the order of what was looped over, whatever the threads do.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace cambium {

/// Calls body(part, begin, end) for every chunk of `grain` of the numbers below n, each with a Part of its own. The parts, in order.
template <class Part, class Body>
std::vector<Part> in_chunks(std::size_t n, std::size_t grain, Body&& body) {
  std::vector<Part> parts((n + grain - 1) / grain);
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) { body(parts[i], i * grain, std::min(n, (i + 1) * grain)); });
  return parts;
}

/// Appends what the parts hold, in order, and lets go of it.
template <class T>
void append_parts(std::vector<std::vector<T>>& parts, std::vector<T>& all) {
  std::vector<std::size_t> at(parts.size() + 1, all.size());
  for (std::size_t i = 0; i < parts.size(); ++i) at[i + 1] = at[i] + parts[i].size();
  all.resize(at.back());
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    std::copy(parts[i].begin(), parts[i].end(), all.begin() + static_cast<std::ptrdiff_t>(at[i]));
    parts[i] = {};
  });
}

}  // namespace cambium
