// Batches of points given as floats relative to the origin of the pruned box. Where floats could not keep 1e-4 (a box much
// larger than the thinnest primitive in it, or one that a warp tears or stretches as far) the same batch runs in double.
#include "blobtree/batch.h"

#include "blobtree/evaluator_scratch.h"

#include <algorithm>
#include <stdexcept>

namespace cambium {
namespace {

void check_lengths(std::size_t n, std::initializer_list<std::size_t> others) {
  for (const std::size_t other : others)
    if (other != n) throw std::invalid_argument("batch arrays differ in length");
}

}  // namespace

void BatchScratch::prepare(const TapeView& view, const Box& box, const Vec3& origin) {
  if (origin_ == origin && box_.lo == box.lo && box_.hi == box.hi && tape_.is(view.tree, view.tape)) return;
  tape_.forget();   // should the following throw
  in_float_ = compiler_.compile(view, box, origin, floats_);
  if (!in_float_) compiler_.compile(view, box, origin, doubles_);
  box_ = box;
  origin_ = origin;
  tape_.remember(view.tree, view.tape);
}

void BatchScratch::values(const TapeView& view, const Box& box, const Vec3& origin, const BatchArrays& batch) {
  if (batch.n == 0) return;
  prepare(view, box, origin);
  if (in_float_)
    run_values(floats_, memory_, batch);
  else
    run_values(doubles_, memory_, batch);
}

void BatchScratch::samples(const TapeView& view, const Box& box, const Vec3& origin, const BatchArrays& batch) {
  if (batch.n == 0) return;
  prepare(view, box, origin);
  if (in_float_)
    run_samples(floats_, memory_, batch);
  else
    run_samples(doubles_, memory_, batch);
}

void Evaluator::values(const PrunedField& field, std::span<const float> x, std::span<const float> y,
                       std::span<const float> z, std::span<float> f) {
  check_lengths(x.size(), {y.size(), z.size(), f.size()});
  if (field.empty()) {
    std::fill(f.begin(), f.end(), 0.0f);
    return;
  }
  scratch_->batch.values(Scratch::view(field), field.box(), field.origin(),
                         {x.size(), x.data(), y.data(), z.data(), f.data()});
}

void Evaluator::samples(const PrunedField& field, std::span<const float> x, std::span<const float> y,
                        std::span<const float> z, std::span<float> f, std::span<float> gx, std::span<float> gy,
                        std::span<float> gz) {
  check_lengths(x.size(), {y.size(), z.size(), f.size(), gx.size(), gy.size(), gz.size()});
  if (field.empty()) {
    for (const std::span<float> out : {f, gx, gy, gz}) std::fill(out.begin(), out.end(), 0.0f);
    return;
  }
  scratch_->batch.samples(Scratch::view(field), field.box(), field.origin(),
                          {x.size(), x.data(), y.data(), z.data(), f.data(), gx.data(), gy.data(), gz.data()});
}

}  // namespace cambium
