// From an authored BlobTree to its compiled form.
#include "blobtree/compile_shapes.h"
#include "blobtree/compiled_tree.h"
#include "blobtree/operators.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace cambium {
namespace {

const Box kEverywhere{Vec3(-kInfinity), Vec3(kInfinity)};

class TreeCompiler {
 public:
  explicit TreeCompiler(const BlobTree& authored) : authored_(authored), count_(static_cast<std::uint32_t>(authored.size())) {}

  CompiledTree run() {
    tree_.root = authored_.root();
    tree_.nodes.resize(count_);
    parent_.assign(count_, kNone);
    end_atom_.resize(count_);
    range_.resize(count_);
    for (NodeId id = 0; id < count_; ++id) compile_node(id);
    for (NodeId id = 0; id < count_; ++id) {
      set_range(id);
      node(id).can_exceed_one = range_[id].hi > 1;
    }
    number_atoms();
    for (NodeId id = count_; id-- > 0;) set_acting(id);
    bound_supports();
    bound_atoms();
    shrink();
    return std::move(tree_);
  }

 private:
  CompiledNode& node(NodeId id) { return tree_.nodes[id]; }
  const std::uint32_t* children(const CompiledNode& n) const { return tree_.children.data() + n.first_child; }

  void compile_node(NodeId id) {
    compile_shape(tree_, node(id), authored_.node(id));
    const std::span<const NodeId> ids = authored_.children(id);
    node(id).first_child = static_cast<std::uint32_t>(tree_.children.size());
    node(id).child_count = static_cast<std::uint32_t>(ids.size());
    for (const NodeId child : ids) {
      tree_.children.push_back(child);
      parent_[child] = id;
    }
    if (node(id).op == Op::kIntersection) cut_by_half_spaces(node(id));
  }

  /// A solid's intersection with half-spaces is what is left of it when their other sides are taken away. Where no plane is near these
  /// are 0: a tape is made there without them, as a half-space that is 1 would not be.
  void cut_by_half_spaces(CompiledNode& n) {
    const auto is_solid = [&](NodeId child) { return node(child).op != Op::kHalfSpace; };
    const std::span<NodeId> parts = std::span(tree_.children).subspan(n.first_child, n.child_count);
    if (parts.size() < 2 || std::ranges::count_if(parts, is_solid) != 1) return;
    for (const NodeId plane : std::ranges::stable_partition(parts, is_solid)) {
      Vec3& normal = tree_.half_spaces[node(plane).payload].normal;
      normal = -normal;
    }
    n.op = Op::kDifference;
  }

  void set_range(NodeId id) {
    CompiledNode& n = node(id);
    Interval& range = range_[id];
    std::vector<Interval>& f = child_ranges_;
    f.clear();
    bool any_negative = false, all_negative = n.child_count > 0;
    for (std::uint32_t i = 0; i < n.child_count; ++i) {
      const NodeId child = children(n)[i];
      f.push_back(range_[child]);
      any_negative = any_negative || node(child).can_be_negative;
      all_negative = all_negative && node(child).can_be_negative;
    }
    const auto of_strength = [&](double s) {
      range = {std::min(0.0, s), std::max(0.0, s)};
      n.can_be_negative = s < 0;
    };
    switch (n.op) {
      case Op::kPrimitive: of_strength(tree_.primitive_of(n).strength); break;
      case Op::kChain:
      case Op::kFlare: of_strength(tree_.chain_strength_of(n)); break;
      case Op::kHalfSpace: range = {0, 1}; break;
      case Op::kSum:
        range = sum_of(f.data(), f.size());
        n.can_be_negative = any_negative;
        break;
      case Op::kUnion:
        range = max_of(f.data(), f.size(), false);
        n.can_be_negative = all_negative;
        break;
      case Op::kIntersection:
        range = min_of(f.data(), f.size(), false);
        n.can_be_negative = any_negative;
        break;
      case Op::kDifference: {
        range = difference_of(f[0], f.data() + 1, f.size() - 1, false);
        n.can_be_negative = node(children(n)[0]).can_be_negative;
        for (std::size_t i = 1; i < f.size(); ++i) n.can_be_negative = n.can_be_negative || f[i].hi > 1;
        break;
      }
      case Op::kRicci: range = ricci_of(f.data(), f.size(), tree_.numbers[n.payload]); break;
      case Op::kContact: {
        const CompiledBlend& b = tree_.blends[n.payload];
        range = contact_of(f.data(), f.size(), false, b.width, b.lip);
        n.can_be_negative = all_negative;
        break;
      }
      case Op::kFork: {
        const CompiledBlend& b = tree_.blends[n.payload];
        const std::vector<Interval> weights(f.size(), Interval{0, 1});
        range = fork_of(f[0], f.data() + 1, weights.data(), f.size() - 1, false, b.width, b.lip);
        n.can_be_negative = node(children(n)[0]).can_be_negative;
        break;
      }
      case Op::kScale:
        range = scaled(f[0], tree_.numbers[n.payload]);
        n.can_be_negative = tree_.numbers[n.payload] >= 0 ? any_negative : f[0].hi > 0;
        break;
      case Op::kWarp:
        range = f[0];
        n.can_be_negative = any_negative;
        tree_.warps[n.payload].range = range;
        break;
    }
  }

  void add_atoms(NodeId id) {
    CompiledNode& n = node(id);
    const Attributes& given = authored_.attributes(id);
    n.first_child = static_cast<std::uint32_t>(tree_.leaves.size());
    tree_.leaves.push_back({given.branch, given.order, static_cast<std::uint32_t>(tree_.run_begin.size())});
    const auto begin_with = [&](const Vec3& axis) {
      const Vec3 across = given.u_direction - glm::dot(given.u_direction, axis) * axis;
      return CarriedCoordinates{given.v_begin, glm::length(across) > 1e-9 ? glm::normalize(across) : any_normal(axis), axis};
    };
    const auto begin_run = [&](std::uint32_t atom, const AtomCoordinates& at) {
      tree_.run_first_atom.push_back(atom);
      tree_.run_begin.push_back(at);
    };
    if (!is_swept(n.op)) {
      const Vec3 axis = n.op == Op::kHalfSpace ? Vec3(0, 0, 1) : native_axis(tree_.primitive_of(n)).axis;
      begin_run(n.first_atom, begin_with(axis).at_atom());
      tree_.node_of_atom.push_back(id);
      return;
    }
    const std::uint32_t segments = tree_.chains[n.payload].node_count - 1;
    SweptSegment<double> last;
    CarriedCoordinates carried;
    for (std::uint32_t k = 0; k < segments; ++k) {
      const auto atom = static_cast<std::uint32_t>(tree_.atom_count());
      tree_.node_of_atom.push_back(id);
      const SweptSegment<double> segment = tree_.segment_of(atom);
      if (k == 0) {
        carried = begin_with(segment.axis);
      } else {
        carried.advance(last, segment);
      }
      last = segment;
      if (k % kRunAtoms == 0) begin_run(atom, carried.at_atom());
    }
  }

  /// Depth-first, without recursion: depths, spaces, atoms and the ancestors that neighbouring atoms share.
  void number_atoms() {
    std::vector<std::uint32_t> shared, shared_depth;
    struct Visit {
      NodeId id;
      std::uint32_t next;
    };
    std::vector<Visit> stack{{tree_.root, 0}};
    NodeId lowest = kNone;
    const auto note = [&](NodeId id) {
      if (lowest == kNone || node(id).depth < node(lowest).depth) lowest = id;
    };
    const auto enter = [&](NodeId id) {
      CompiledNode& n = node(id);
      n.first_atom = static_cast<std::uint32_t>(tree_.atom_count());
      if (n.child_count > 0) return;
      if (!tree_.leaves.empty()) {
        shared.push_back(lowest);
        shared_depth.push_back(node(lowest).depth);
      }
      add_atoms(id);
      lowest = kNone;
    };
    enter(tree_.root);
    while (!stack.empty()) {
      Visit& top = stack.back();
      CompiledNode& n = node(top.id);
      if (top.next == n.child_count) {
        end_atom_[top.id] = static_cast<std::uint32_t>(tree_.atom_count());
        stack.pop_back();
        if (!stack.empty()) note(stack.back().id);
        continue;
      }
      const std::uint32_t slot = top.next++;
      const NodeId child = children(n)[slot];
      node(child).depth = n.depth + 1;
      node(child).warp = n.op == Op::kWarp ? top.id : n.warp;
      node(child).subtracted = n.subtracted || (n.op == Op::kDifference && slot > 0);
      enter(child);
      stack.push_back({child, 0});
    }
    tree_.ancestors = AncestorIndex(std::move(shared), std::move(shared_depth));
  }

  void set_acting(NodeId id) {  // parents have larger ids
    const NodeId above = parent_[id];
    if (above == kNone) return;
    CompiledNode& n = node(id);
    const CompiledNode& p = node(above);
    const bool always = p.op == Op::kIntersection || p.op == Op::kRicci || p.op == Op::kScale || p.op == Op::kWarp;
    const bool on_negative = ((p.op == Op::kUnion || p.op == Op::kContact) && p.child_count > 1) || p.op == Op::kFork;
    const bool taken_away = p.op == Op::kDifference && children(p)[0] != id;
    for (const bool negative : {false, true})
      for (const bool exceeding : {false, true}) {
        const std::size_t of = ValueClass{negative, exceeding}.index();
        const bool acts = always || taken_away || (negative && on_negative) || (exceeding && p.op == Op::kDifference);
        n.acts_above[of] = acts ? above : p.acts_above[of];
      }
  }

  static Extents extents_of(const Box& box, const WarpFrame& frame) {
    Extents e;
    for (int i = 0; i < 3; ++i) {
      e[i] = {0, 0};
      for (int k = 0; k < 3; ++k) {
        const double w = frame.axes[i][k];
        if (w == 0) continue;
        const double a = w * (box.lo[k] - frame.anchor[k]), b = w * (box.hi[k] - frame.anchor[k]);
        e[i].lo += std::min(a, b);
        e[i].hi += std::max(a, b);
      }
    }
    return e;
  }

  /// Extents of one atom in the space right below a warp; tight for atoms that live there, by box for deeper ones.
  Extents extents_of(std::uint32_t atom, const Box& box, const WarpFrame& frame) const {
    Extents e = extents_of(box, frame);
    for (int i = 0; i < 3; ++i) {
      const Interval tight = support_along(tree_, atom, frame.axes[i]);
      const double shift = glm::dot(frame.anchor, frame.axes[i]);
      e[i] = {std::max(e[i].lo, tight.lo - shift), std::min(e[i].hi, tight.hi - shift)};
      if (e[i].hi < e[i].lo) e[i].hi = e[i].lo;
    }
    return e;
  }

  /// support_[id]: outside of it the node is 0; in the space of its parent (a warp's own box is already warped).
  void bound_supports() {
    support_.resize(count_);
    atom_boxes_.resize(tree_.atom_count());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, atom_boxes_.size(), 1024), [&](const auto& part) {
      for (std::size_t a = part.begin(); a != part.end(); ++a) atom_boxes_[a] = own_box(tree_, static_cast<std::uint32_t>(a));
    });
    if (!tree_.warps.empty()) lifted_boxes_ = atom_boxes_;
    for (NodeId id = 0; id < count_; ++id) {
      CompiledNode& n = node(id);
      Box& box = support_[id];
      if (n.child_count == 0) {
        for (std::uint32_t a = n.first_atom; a < end_atom_[id]; ++a) box.extend(atom_boxes_[a]);
        continue;
      }
      const std::uint32_t* child = children(n);
      if (n.op == Op::kWarp) {
        box = support_of_warp(id, support_[child[0]]);
      } else if (n.op == Op::kDifference) {
        box = support_[child[0]];
        for (std::uint32_t i = 1; i < n.child_count; ++i)
          if (range_[child[i]].hi > 1) box.extend(support_[child[i]]);
      } else if (n.op == Op::kIntersection) {  // positive only where all are, negative where any is
        box = support_[child[0]];
        for (std::uint32_t i = 1; i < n.child_count; ++i) box = Box::intersection(box, support_[child[i]]);
        if (box.empty()) box = {};
        for (std::uint32_t i = 0; i < n.child_count; ++i)
          if (node(child[i]).can_be_negative) box.extend(support_[child[i]]);
      } else {
        for (std::uint32_t i = 0; i < n.child_count; ++i) box.extend(support_[child[i]]);
      }
    }
    tree_.bounds = support_[tree_.root];
    if (!tree_.bounds.empty() && !tree_.bounds.bounded())
      throw InvalidNode("half_space", "an unbounded field", "a half_space only where an intersection or difference bounds it");
  }

  Box support_of_warp(NodeId id, const Box& child_box) {
    CompiledNode& n = node(id);
    Warp& warp = tree_.warps[n.payload].warp;
    if (child_box.empty()) return {};
    const WarpFrame frame = warp_frame(warp);
    BendWarp* bend = std::get_if<BendWarp>(&warp);
    Box box;
    double deepest = kInfinity;
    const auto add = [&](const Extents& e) {
      if (bend && e[0].hi > 0 && e[0].lo < bend->arc) deepest = std::min(deepest, e[1].lo);
      box.extend(warped_box(warp, e));
    };
    for (std::uint32_t a = n.first_atom; a < end_atom_[id]; ++a) {
      const Box inside = Box::intersection(lifted_boxes_[a], child_box);
      lifted_boxes_[a] = {};
      if (inside.empty()) continue;
      if (!inside.bounded()) {  // a half-space, for an operator above to bound; nothing is known of where it goes
        if (bend) deepest = -kInfinity;
        lifted_boxes_[a] = box = kEverywhere;
        continue;
      }
      const Extents e = node(tree_.node_of_atom[a]).warp == id ? extents_of(a, inside, frame) : extents_of(inside, frame);
      add(e);
      lifted_boxes_[a] = warped_box(warp, e);
    }
    if (bend) {
      bend->inner = bend->rho + std::min(deepest, 0.0);
      if (!(bend->inner > 0))
        throw InvalidNode("angle_degrees", "a bend tighter than its child is thick (support radius >= rho)",
                          "support radius < rho = " + std::to_string(bend->rho) + " m");
    }
    return box;
  }

  void bound_atoms() {
    // clip[id]: where the node can matter at all, in its own space.
    std::vector<Box> clip(count_, kEverywhere);
    for (NodeId id = count_; id-- > 0;) {
      if (id == tree_.root) clip[id] = tree_.bounds;
      const CompiledNode& n = node(id);
      for (std::uint32_t i = 0; i < n.child_count; ++i) {
        const NodeId child = children(n)[i];
        clip[child] = n.op == Op::kWarp ? support_[child] : Box::intersection(clip[id], support_[id]);
      }
    }
    const auto bound = [&](std::uint32_t a) {
      const NodeId owner = tree_.node_of_atom[a];
      Box box = Box::intersection(atom_boxes_[a], clip[owner]);
      bool innermost = true;
      for (std::uint32_t w = node(owner).warp; w != kNone && !box.empty(); w = node(w).warp, innermost = false) {
        if (!box.bounded()) {
          box = clip[w];
          continue;
        }
        const Warp& warp = tree_.warps[node(w).payload].warp;
        const WarpFrame frame = warp_frame(warp);
        const Extents e = innermost ? extents_of(a, box, frame) : extents_of(box, frame);
        box = Box::intersection(warped_box(warp, e).padded(1e-9), clip[w]);
      }
      return FloatBox(box);
    };
    tree_.run_bounds.resize(tree_.run_begin.size());
    const auto runs = static_cast<std::uint32_t>(tree_.run_bounds.size());
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, runs, 256), [&](const auto& part) {
      for (std::uint32_t run = part.begin(); run != part.end(); ++run) {
        FloatBox& box = tree_.run_bounds[run];
        for (std::uint32_t a = tree_.run_first_atom[run]; a < tree_.end_atom_of_run(run); ++a) box.extend(bound(a));
      }
    });
    tree_.index = BoxIndex(tree_.run_bounds);
  }

  void shrink() {
    tree_.children.shrink_to_fit();
    tree_.primitives.shrink_to_fit();
    tree_.chains.shrink_to_fit();
    tree_.chain_nodes.shrink_to_fit();
    tree_.flares.shrink_to_fit();
    tree_.blends.shrink_to_fit();
    tree_.laterals.shrink_to_fit();
    tree_.warps.shrink_to_fit();
    tree_.leaves.shrink_to_fit();
    tree_.node_of_atom.shrink_to_fit();
    tree_.run_begin.shrink_to_fit();
    tree_.run_first_atom.shrink_to_fit();
  }

  const BlobTree& authored_;
  std::uint32_t count_;
  CompiledTree tree_;
  std::vector<NodeId> parent_;
  std::vector<std::uint32_t> end_atom_;
  std::vector<Interval> range_, child_ranges_;   ///< of every node's values anywhere
  std::vector<Box> support_, atom_boxes_;
  std::vector<Box> lifted_boxes_;  ///< of atoms, in the space of the warps that bound_supports() has passed
};

}  // namespace

CompiledTree compile(const BlobTree& tree) { return TreeCompiler(tree).run(); }

}  // namespace cambium
