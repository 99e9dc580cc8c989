#include "blobtree/field.h"

#include "blobtree/compiled_tree.h"
#include "blobtree/tape.h"

#include <numeric>

namespace cambium {

Field::Field(const BlobTree& tree) : tree_(std::make_shared<const CompiledTree>(compile(tree))) {}

const Box& Field::bounds() const { return tree_->bounds; }
std::size_t Field::atom_count() const { return tree_->atoms.size(); }
double Field::atom_radius(std::uint32_t atom) const { return tree_->atoms[atom].radius; }
const Box& Field::atom_bounds(std::uint32_t atom) const { return tree_->atoms[atom].bounds; }

ActiveSet Field::active(const Box& box) const {
  ActiveSet set{tree_->index.query(box)};
  const Ball ball = circumscribed_ball(box);
  std::erase_if(set.atoms, [&](std::uint32_t atom) { return !is_active(*tree_, atom, box, ball); });
  return set;
}

ActiveSet Field::narrow(const ActiveSet& from, const Box& box) const {
  ActiveSet set;
  const Ball ball = circumscribed_ball(box);
  for (const std::uint32_t atom : from.atoms)
    if (is_active(*tree_, atom, box, ball)) set.atoms.push_back(atom);
  return set;
}

PrunedField Field::prune(const ActiveSet& active, const Box& box) const { return TapeBuilder(tree_, active.atoms, box).build(); }
PrunedField Field::prune(const Box& box) const { return prune(active(box), box); }

PrunedField Field::whole() const {
  std::vector<std::uint32_t> all(tree_->atoms.size());
  std::iota(all.begin(), all.end(), 0u);
  return TapeBuilder(tree_, all, Box{Vec3(-kInfinity), Vec3(kInfinity)}).build();
}

double Field::value(const Vec3& p) const { return Evaluator().value(prune(Box{p, p}), p); }
Sample Field::sample(const Vec3& p) const { return Evaluator().sample(prune(Box{p, p}), p); }
Interval Field::interval(const Box& box) const { return Evaluator().interval(prune(box), box); }

std::size_t PrunedField::memory_bytes() const {
  return sizeof(*this) + tape_.capacity() * sizeof(Instruction) + (slots_.capacity() + frames_.capacity()) * sizeof(std::uint32_t);
}

}  // namespace cambium
