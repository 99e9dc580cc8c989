// Points of a batch, the arrays for what is computed at them, and batches run over a pruned field.
#pragma once

#include <hwy/aligned_allocator.h>

#include <cstddef>
#include <span>

#include "blobtree/field.h"

namespace cambium::bench {

/// Points relative to a pruned field's origin, with room for values and gradients; aligned to cache lines.
class BatchPoints {
 public:
  /// A lattice of edge^3 points that fills the box, centred on it: 9 for a block of a mesh, 16 for 4096 points.
  BatchPoints(const Box& box, int edge);

  std::size_t size() const { return size_; }
  std::span<const float> x() const { return {x_.get(), size_}; }
  std::span<const float> y() const { return {y_.get(), size_}; }
  std::span<const float> z() const { return {z_.get(), size_}; }
  std::span<const float> f() const { return {f_.get(), size_}; }
  float* f_data() { return f_.get(); }

  void values(Evaluator& evaluator, const PrunedField& field);
  void samples(Evaluator& evaluator, const PrunedField& field);

 private:
  std::size_t size_;
  hwy::AlignedFreeUniquePtr<float[]> x_, y_, z_, f_, gx_, gy_, gz_;
};

}  // namespace cambium::bench
