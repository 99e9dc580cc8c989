// What an evaluator keeps between batches: the program of the field that it saw last, and memory to run it in.
// Private to blobtree/.
#pragma once

#include "blobtree/batch_kernels.h"

namespace cambium {

class BatchScratch {
 public:
  /// Points relative to `origin`, in `box`. Cost of the tape only if it is not the one of the last call; no allocation then.
  void values(const TapeView& view, const Box& box, const Vec3& origin, const BatchArrays& batch);
  void samples(const TapeView& view, const Box& box, const Vec3& origin, const BatchArrays& batch);

 private:
  void prepare(const TapeView& view, const Box& box, const Vec3& origin);

  // What the programs were made from.
  RememberedTape tape_;
  Box box_;
  Vec3 origin_{0.0};

  bool in_float_ = false;   ///< which of the two programs is the one
  BatchProgram<float> floats_;
  BatchProgram<double> doubles_;
  BatchCompiler compiler_;
  ChunkMemory memory_;
};

}  // namespace cambium
