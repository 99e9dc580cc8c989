// Runs batch programs with the widest vectors that the machine has. Private to blobtree/.
#pragma once

#include "blobtree/batch_program.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace cambium {

/// A batch: n points relative to the program's origin, and where their values go; gx, gy, gz are not written for values.
/// Outputs may be the inputs themselves, but must not overlap them otherwise.
struct BatchArrays {
  std::size_t n = 0;
  const float *x = nullptr, *y = nullptr, *z = nullptr;
  float *f = nullptr, *gx = nullptr, *gy = nullptr, *gz = nullptr;
};

/// Aligned memory for one chunk of points and the values of a program's slots; grows and is kept.
class ChunkMemory {
 public:
  template <class T>
  T* at_least(std::size_t count) {
    const std::size_t lines = (count * sizeof(T) + sizeof(Line) - 1) / sizeof(Line);
    if (lines_.size() < lines) lines_.resize(lines);
    return reinterpret_cast<T*>(lines_.data());
  }

 private:
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  std::vector<Line> lines_;
};

/// Every set of vector instructions gives the same bits.
template <class T>
void run_values(const BatchProgram<T>& program, ChunkMemory& memory, const BatchArrays& batch);
template <class T>
void run_samples(const BatchProgram<T>& program, ChunkMemory& memory, const BatchArrays& batch);

/// Highway's bits of the sets of vector instructions that the kernels are compiled for, and of the one that runs; for tests.
std::int64_t compiled_vector_targets();
std::int64_t running_vector_target();

}  // namespace cambium
