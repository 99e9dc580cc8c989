#include "blobtree/field.h"

#include "blobtree/active_atoms.h"
#include "blobtree/compiled_tree.h"
#include "blobtree/tape.h"

#include <numeric>
#include <utility>

namespace cambium {
namespace {

/// A tape, and what keeps its tree.
struct KeptTape {
  KeptTape(std::shared_ptr<const void> of, const Tape& made) : tree(std::move(of)), tape(made) {}
  std::shared_ptr<const void> tree;
  OwnedTape tape;
};

/// Ascending.
std::vector<std::uint32_t> atoms_of(const Tape& tape) {
  std::vector<std::uint32_t> atoms;
  atoms.reserve(tape.atom_count());
  for (const Instruction& in : tape.instructions()) {
    if (in.op == Op::kPrimitive || in.op == Op::kHalfSpace) atoms.push_back(in.first);
    if (!is_swept(in.op)) continue;
    const auto segments = tape.slots().subspan(in.first, in.count);
    atoms.insert(atoms.end(), segments.begin(), segments.end());
  }
  return atoms;
}

}  // namespace

PrunedField::PrunedField(const CompiledTree& tree, const Tape& tape, std::shared_ptr<const void> owner, const Box& box)
    : tree_(&tree), tape_(&tape), owner_(std::move(owner)), box_(box),
      origin_(box.bounded() ? box.center() : tree.bounds.empty() ? Vec3(0.0) : tree.bounds.center()) {}

bool PrunedField::empty() const { return !tape_ || tape_->empty(); }
std::size_t PrunedField::atom_count() const { return tape_ ? tape_->atom_count() : 0; }
double PrunedField::smallest_radius() const { return tape_ ? tape_->smallest_radius() : kInfinity; }
std::size_t PrunedField::memory_bytes() const {
  return sizeof(*this) + (tape_ ? sizeof(KeptTape) + tape_->array_bytes() : 0);
}

PrunedField PrunedField::narrowed(const Box& part) const {
  if (empty()) return *this;
  ActiveAtoms active;
  find_active(*tree_, atoms_of(*tape_), part, active);
  if (active.size() == tape_->atom_count()) return PrunedField(*tree_, *tape_, owner_, part);
  TapeBuilder builder(*tree_);
  const auto kept = std::make_shared<const KeptTape>(owner_, builder.build(active.atoms));
  return PrunedField(*tree_, kept->tape.tape(), kept, part);
}

Field::Field(const BlobTree& tree) : tree_(std::make_shared<const CompiledTree>(compile(tree))) {}

const Box& Field::bounds() const { return tree_->bounds; }
std::size_t Field::atom_count() const { return tree_->atom_count(); }
double Field::atom_radius(std::uint32_t atom) const { return tree_->radius_of(atom); }
Box Field::atom_bounds(std::uint32_t atom) const { return tree_->bounds_of(atom); }

std::size_t Field::memory_bytes() const { return tree_->memory_bytes(); }

ActiveSet Field::active(const Box& box) const {
  ActiveAtoms active;
  find_active(*tree_, box, active);
  return {std::move(active.atoms)};
}

ActiveSet Field::narrow(const ActiveSet& from, const Box& box) const {
  ActiveAtoms active;
  find_active(*tree_, from.atoms, box, active);
  return {std::move(active.atoms)};
}

PrunedField Field::prune(const ActiveSet& active, const Box& box) const {
  TapeBuilder builder(*tree_);
  const auto owned = std::make_shared<const KeptTape>(tree_, builder.build(active.atoms));
  return PrunedField(*tree_, owned->tape.tape(), owned, box);
}
PrunedField Field::prune(const Box& box) const { return prune(active(box), box); }

PrunedField Field::whole() const {
  ActiveSet all;
  all.atoms.resize(tree_->atom_count());
  std::iota(all.atoms.begin(), all.atoms.end(), 0u);
  return prune(all, Box{Vec3(-kInfinity), Vec3(kInfinity)});
}

double Field::value(const Vec3& p) const { return Evaluator().value(prune(Box{p, p}), p); }
Sample Field::sample(const Vec3& p) const { return Evaluator().sample(prune(Box{p, p}), p); }
Interval Field::interval(const Box& box) const { return Evaluator().interval(prune(box), box); }

}  // namespace cambium
