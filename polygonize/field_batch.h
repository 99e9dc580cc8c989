// Points of one cell of a cover, evaluated together: scratch of one thread.
#pragma once

#include "blobtree/field.h"

#include <vector>

namespace cambium {

class FieldBatch {
 public:
  void clear() { count_ = 0; }
  std::size_t size() const { return count_; }
  /// p: world.
  void add(const PrunedField& field, const Vec3& p) {
    if (count_ == x_.size()) {
      for (auto* v : {&x_, &y_, &z_, &f_, &gx_, &gy_, &gz_}) v->resize(std::max<std::size_t>(64, 2 * count_));
    }
    const Vec3 at = p - field.origin();
    x_[count_] = static_cast<float>(at.x), y_[count_] = static_cast<float>(at.y), z_[count_] = static_cast<float>(at.z);
    ++count_;
  }
  void evaluate_values(Evaluator& evaluator, const PrunedField& field) {
    evaluator.values(field, in(x_), in(y_), in(z_), out(f_));
  }
  void evaluate_samples(Evaluator& evaluator, const PrunedField& field) {
    evaluator.samples(field, in(x_), in(y_), in(z_), out(f_), out(gx_), out(gy_), out(gz_));
  }
  /// f - kIso.
  float value(std::size_t i) const { return f_[i] - static_cast<float>(kIso); }
  glm::vec3 gradient(std::size_t i) const { return {gx_[i], gy_[i], gz_[i]}; }

 private:
  std::span<const float> in(const std::vector<float>& v) const { return {v.data(), count_}; }
  std::span<float> out(std::vector<float>& v) const { return {v.data(), count_}; }
  std::size_t count_ = 0;
  std::vector<float> x_, y_, z_, f_, gx_, gy_, gz_;
};

}  // namespace cambium
