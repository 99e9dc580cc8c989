#include <blobtree/surface_cover.h>

#include <cstdio>

// A cloud of points on the surface of a forked branch, with normals.
int main() {
  using namespace cambium;
  BlobTreeBuilder b;
  const NodeId trunk = b.add(Chain{{{{0, 0, 0}, 0.10}, {{0, 0, 1}, 0.08}, {{0, 0, 2}, 0.06}}});
  const NodeId limb = b.add(Chain{{{{0, 0, 1}, 0.06}, {{0.6, 0, 1.5}, 0.04}}});
  const Field field(b.build(b.add(Fork{trunk, {{limb, {0, 0, 1}, {0, 0, 1}, 0.04, 0.3}}})));
  const SurfaceCover cover = *cover_surface(field, {.cell = 0.02}, {});
  Evaluator evaluator;  // one per thread
  for (std::size_t i = 0; i < cover.size(); ++i) {
    const PrunedField cell = cover.field(i);  // a handful of primitives, exact in cell.box()
    Vec3 p = cell.origin();
    for (int step = 0; step < 3; ++step) {
      const Sample s = evaluator.sample(cell, p);
      p = glm::clamp(p - (s.value - kIso) / glm::dot(s.gradient, s.gradient) * s.gradient, cell.box().lo, cell.box().hi);
    }
    const Sample s = evaluator.sample(cell, p);  // many points at once: evaluator.samples()
    const Vec3 n = -glm::normalize(s.gradient);
    if (s.value > 0.49 && s.value < 0.51) std::printf("%.4f %.4f %.4f  %.3f %.3f %.3f\n", p.x, p.y, p.z, n.x, n.y, n.z);
  }
}
