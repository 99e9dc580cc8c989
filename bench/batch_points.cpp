#include "bench/batch_points.h"

namespace cambium::bench {

BatchPoints::BatchPoints(const Box& box, int edge) : size_(static_cast<std::size_t>(edge) * edge * edge) {
  for (auto* array : {&x_, &y_, &z_, &f_, &gx_, &gy_, &gz_}) *array = hwy::AllocateAligned<float>(size_);
  const Vec3 step = box.size() / (edge - 1.0);
  for (std::size_t i = 0; i < size_; ++i) {
    const Vec3 at(static_cast<double>(i % edge), static_cast<double>(i / edge % edge), static_cast<double>(i / edge / edge));
    const Vec3 p = step * at - 0.5 * box.size();
    x_[i] = static_cast<float>(p.x);
    y_[i] = static_cast<float>(p.y);
    z_[i] = static_cast<float>(p.z);
  }
}

void BatchPoints::values(Evaluator& evaluator, const PrunedField& field) {
  evaluator.values(field, x(), y(), z(), {f_.get(), size_});
}

void BatchPoints::samples(Evaluator& evaluator, const PrunedField& field) {
  evaluator.samples(field, x(), y(), z(), {f_.get(), size_}, {gx_.get(), size_}, {gy_.get(), size_}, {gz_.get(), size_});
}

}  // namespace cambium::bench
