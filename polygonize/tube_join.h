// Triangles between the open end of a mesh and the first ring of a tube. Private to polygonize/.
#pragma once

#include "polygonize/annulus.h"
#include "polygonize/mesh_border.h"
#include "polygonize/tube_rings.h"

#include <array>
#include <cstdint>
#include <vector>

namespace cambium {

/// What a tube adds to a mesh.
struct Tube {
  static constexpr std::uint32_t kOwn = 0x80000000u;         ///< marks vertices of its own, counted from its first
  std::vector<Vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  std::uint32_t add(const ChainPath::SurfacePoint& vertex) {
    positions.push_back(vertex.position);
    normals.emplace_back(vertex.normal);
    return static_cast<std::uint32_t>(positions.size() - 1) | kOwn;
  }
  Vec3 position(const Mesh& mesh, std::uint32_t vertex) const { return vertex & kOwn ? positions[vertex & ~kOwn] : mesh.positions[vertex]; }
};

/// An open end of a mesh, and the ring before it. Everything is seen as if the chain ran from the end to the ring.
class TubeJoin {
 public:
  /// at_end: the tube ends here, so that the chain runs the other way. All outlive it. tolerance: metres.
  TubeJoin(const ChainPath& path, const TubeRing& ring, bool at_end, const Mesh& mesh, const MeshBorder& border, std::uint32_t loop,
           double tolerance);

  /// first: the ring's corner 0 in the tube. False, with the tube of no use, where the end's line does not go once around below the
  /// ring without crossing itself on the unrolled surface, where a triangle would reach too far around or leave the surface, or where it
  /// would meet another triangle than those it shares a corner or a side with.
  bool add_to(Tube& tube, std::uint32_t first) const;

  struct Eased {
    std::uint32_t vertex = 0;
    ChainPath::SurfacePoint to;
  };
  /// The vertices of all triangles that touch the end's line, ascending, each in the middle of those it shares a triangle with, on the
  /// chain's surface.
  std::vector<Eased> eased() const;
  /// Whether no two triangles at the end meet but in what they share.
  bool is_untangled() const;

 private:
  struct Unrolled {
    double angle = 0, z = 0;       // around the ring, and along the chain from it
    Vec3 outwards{0.0};
  };
  Unrolled unrolled(const Vec3& p) const;
  ChainPath::SurfacePoint rolled(const glm::dvec2& point) const;
  bool unroll_line(std::vector<glm::dvec2>& line, std::vector<std::uint32_t>& names) const;
  bool add_with_chords(Tube& tube, std::uint32_t first, double chord_share) const;
  bool is_straight(double lowest) const;
  ChordExcess chord_excess(double lowest, double chord_share) const;
  bool keeps_to_surface(const Tube& tube, std::size_t begin) const;
  bool is_graph() const;
  bool crosses(const Tube& tube, std::size_t begin, std::uint32_t first) const;
  double nearest(const Vec3& p) const;

  const ChainPath& path_;
  TubeRing ring_;
  const bool at_end_;
  const Mesh& mesh_;
  const std::vector<std::uint32_t>& loop_;
  const std::vector<std::uint32_t>& triangles_;
  const double radius_, tolerance_;
};

}  // namespace cambium
