#include "polygonize/texture_layout.h"

#include "sample_fields.h"
#include "small_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace cambium {
namespace {

using namespace testing;

struct Texel {
  double density = 0, area = 0;
};

double area_of(const Mesh& mesh, std::size_t t) {
  const auto& c = mesh.triangles[t];
  return 0.5 * glm::length(glm::cross(mesh.positions[c[1]] - mesh.positions[c[0]], mesh.positions[c[2]] - mesh.positions[c[0]]));
}

double signed_uv_area(const MeshAttributes& a, std::size_t t) {
  const auto& uv = a.uv_triangles[t];
  const glm::dvec2 o(a.uvs[uv[0]]), p = glm::dvec2(a.uvs[uv[1]]) - o, q = glm::dvec2(a.uvs[uv[2]]) - o;
  return 0.5 * (p.x * q.y - p.y * q.x);
}

/// Share of the area on which the texture's density is within a fifth of its median.
double even_share(const Mesh& mesh, const MeshAttributes& a) {
  std::vector<Texel> texels;
  double total = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const double area = area_of(mesh, t);
    if (!(area > 0)) continue;
    texels.push_back({std::sqrt(std::abs(signed_uv_area(a, t)) / area), area});
    total += area;
  }
  std::sort(texels.begin(), texels.end(), [](const Texel& x, const Texel& y) { return x.density < y.density; });
  double seen = 0, median = 0, even = 0;
  for (const Texel& texel : texels)
    if ((seen += texel.area) >= 0.5 * total) {
      median = texel.density;
      break;
    }
  for (const Texel& texel : texels) even += std::abs(texel.density / median - 1) <= 0.2 ? texel.area : 0;
  return even / total;
}

TEST(TextureLayout, DensityIsEvenOverNearlyAllOfATree) {
  const Field field = small_tree();
  for (const double voxel : {0.02, 0.01}) {
    const Mesh mesh = small_tree_mesh(field, voxel);
    const MeshAttributes a = small_tree_attributes(field, mesh);
    EXPECT_GE(even_share(mesh, a), 0.95) << voxel;
  }
}

TEST(TextureLayout, EveryEntryBelongsToOneVertexAndEveryCornerHasOne) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  const MeshAttributes a = small_tree_attributes(field, mesh);
  ASSERT_EQ(a.uv_triangles.size(), mesh.triangles.size());
  ASSERT_EQ(a.unrolled.size(), a.uvs.size());
  std::vector<std::uint32_t> vertex_of(a.uvs.size(), 0xffffffffu);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t uv = a.uv_triangles[t][c];
      ASSERT_LT(uv, a.uvs.size());
      if (vertex_of[uv] == 0xffffffffu) vertex_of[uv] = mesh.triangles[t][c];
      EXPECT_EQ(vertex_of[uv], mesh.triangles[t][c]);
    }
  EXPECT_EQ(std::count(vertex_of.begin(), vertex_of.end(), 0xffffffffu), 0);
  for (const glm::vec2& uv : a.uvs) ASSERT_TRUE(std::isfinite(uv.x) && std::isfinite(uv.y));
}

// A repeat is some girths of a few cells; a triangle that ran round the seam the wrong way would be most of a girth long.
TEST(TextureLayout, NoTriangleSpansTheSeam) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  const MeshAttributes a = small_tree_attributes(field, mesh);
  const double girth = 2 * std::numbers::pi * 0.1;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    double longest = 0, longest_uv = 0;
    for (int c = 0; c < 3; ++c) {
      longest = std::max(longest, glm::distance(mesh.positions[mesh.triangles[t][c]], mesh.positions[mesh.triangles[t][(c + 1) % 3]]));
      longest_uv = std::max<double>(longest_uv, glm::distance(a.uvs[a.uv_triangles[t][c]], a.uvs[a.uv_triangles[t][(c + 1) % 3]]));
    }
    EXPECT_LT(longest_uv * a.tile, std::min(0.3 * girth, 6 * longest)) << "triangle " << t;
  }
}

// Along a plain branch what two triangles say of a vertex they share differs by whole repeats around, and by nothing along.
TEST(TextureLayout, SeamsAreWholeRepeatsAndOfOneColumn) {
  const Field field = field_of(Chain{{{Vec3(0, 0, 0), 0.1}, {Vec3(0.05, 0, 0.5), 0.1}, {Vec3(0, 0.1, 1), 0.1}}, 1});
  const Mesh mesh = small_tree_mesh(field, 0.015);
  const MeshAttributes a = small_tree_attributes(field, mesh);
  std::map<std::uint32_t, std::set<std::uint32_t>> uvs_of;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    double low = kInfinity, high = -kInfinity;   // away from its round ends
    for (const std::uint32_t v : mesh.triangles[t]) low = std::min(low, mesh.positions[v].z), high = std::max(high, mesh.positions[v].z);
    if (low < 0.15 || high > 0.85) continue;
    for (int c = 0; c < 3; ++c) uvs_of[mesh.triangles[t][c]].insert(a.uv_triangles[t][c]);
  }
  std::size_t on_seam = 0;
  for (const auto& [vertex, uvs] : uvs_of) {
    if (uvs.size() == 1) continue;
    ++on_seam;
    for (const std::uint32_t uv : uvs) {
      const glm::vec2 d = a.uvs[uv] - a.uvs[*uvs.begin()];
      EXPECT_NEAR(d.x, std::round(d.x), 1e-4);
      EXPECT_EQ(d.y, 0);
    }
  }
  EXPECT_GT(on_seam, 5u);
  EXPECT_LT(on_seam, uvs_of.size() / 10);
}

TEST(TextureLayout, SeamsLieOnTheHiddenSide) {
  const Field field = field_of(Chain{{{Vec3(0, 0, 0), 0.1}, {Vec3(1, 0, 0), 0.1}}, 1});
  const Mesh mesh = small_tree_mesh(field, 0.015);
  for (const Vec3& hidden : {Vec3(0, 0, -1), Vec3(0, 1, 0)}) {
    MeshAttributeOptions options;
    options.hidden_side = hidden;
    const MeshAttributes a = *mesh_attributes(field, mesh, options, {});
    std::vector<std::uint32_t> first(mesh.positions.size(), 0xffffffffu);
    std::size_t seams = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (int c = 0; c < 3; ++c) {
        const std::uint32_t v = mesh.triangles[t][c], uv = a.uv_triangles[t][c];
        if (first[v] == 0xffffffffu) first[v] = uv;
        const double x = mesh.positions[v].x;
        if (first[v] == uv || x < 0.1 || x > 0.9) continue;
        ++seams;
        EXPECT_GT(glm::dot(Vec3(mesh.normals[v]), hidden), 0.9);
      }
    EXPECT_GT(seams, 20u);
  }
}

TEST(TextureLayout, RepeatsAreOfTheGivenLengthAndWholeInNumber) {
  const Field field = field_of(Chain{{{Vec3(0, 0, 0), 0.1}, {Vec3(0, 0, 1), 0.1}}, 1});
  const Mesh mesh = small_tree_mesh(field, 0.015);
  MeshAttributeOptions options;
  options.tile = 0.1;
  options.aspect = 0.5;   // 12.6 of its widths go round: twelve
  const MeshAttributes a = *mesh_attributes(field, mesh, options, {});
  EXPECT_EQ(a.tile, 0.1);
  double shift = 0;
  bool first = true;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int c = 0; c < 3; ++c) {
      const Vec3& p = mesh.positions[mesh.triangles[t][c]];
      if (p.z < 0.1 || p.z > 0.9) continue;
      const glm::vec2 uv = a.uvs[a.uv_triangles[t][c]];
      const double turns = std::atan2(p.y, p.x) / (2 * std::numbers::pi);
      if (first) shift = uv.x - 12 * turns;
      first = false;
      EXPECT_NEAR(std::remainder(uv.x - 12 * turns - shift, 1.0), 0, 0.02);
      EXPECT_NEAR(std::remainder(uv.y - p.z / 0.1, 1.0), 0, 1e-3);
    }
  EXPECT_FALSE(first);
}

// What a level of detail changes is the mesh, not where the bark lies on the tree.
TEST(TextureLayout, LevelsOfDetailHaveTheirTextureInTheSamePlace) {
  const Field field = field_of(Chain{{{Vec3(0, 0, 0), 0.1}, {Vec3(0, 0, 1), 0.1}}, 1});
  MeshAttributeOptions options;
  options.tile = 0.05;
  const auto phases = [&](double voxel) {   // of u, in repeats beside twelve to the turn
    const Mesh mesh = small_tree_mesh(field, voxel);
    const MeshAttributes a = *mesh_attributes(field, mesh, options, {});
    glm::dvec2 sum(0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (int c = 0; c < 3; ++c) {
        const Vec3& p = mesh.positions[mesh.triangles[t][c]];
        if (p.z < 0.1 || p.z > 0.9) continue;
        const double phase = 2 * std::numbers::pi * a.uvs[a.uv_triangles[t][c]].x - 12 * std::atan2(p.y, p.x);
        sum += glm::dvec2(std::cos(phase), std::sin(phase));
      }
    return glm::normalize(sum);
  };
  EXPECT_LT(glm::distance(phases(0.01), phases(0.04)), 0.05);
}

// On a saw cut the texture is seen as on a board: no pole, no stretching, nothing mirrored.
TEST(TextureLayout, CutsArePlane) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field, 0.006);
  const MeshAttributes a = small_tree_attributes(field, mesh);
  std::size_t on_cut = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    bool flat = true;
    for (const std::uint32_t v : mesh.triangles[t])
      flat = flat && std::abs(mesh.positions[v].y + 0.3) < 1e-3 && glm::distance(mesh.positions[v], Vec3(0.01, -0.3, 1.5)) < 0.03;
    if (!flat) continue;
    ++on_cut;
    for (int c = 0; c < 3; ++c) {
      const double length = glm::distance(mesh.positions[mesh.triangles[t][c]], mesh.positions[mesh.triangles[t][(c + 1) % 3]]);
      EXPECT_NEAR(glm::distance(a.uvs[a.uv_triangles[t][c]], a.uvs[a.uv_triangles[t][(c + 1) % 3]]) * a.tile / length, 1, 0.02);
    }
    EXPECT_GT(signed_uv_area(a, t), 0);
  }
  EXPECT_GT(on_cut, 20u);
}

TEST(TextureLayout, TheTextureIsNeverMirrored) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field, 0.01);
  const MeshAttributes a = small_tree_attributes(field, mesh);
  double mirrored = 0, total = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    total += area_of(mesh, t);
    if (signed_uv_area(a, t) < 0) mirrored += area_of(mesh, t);
  }
  EXPECT_LT(mirrored / total, 1e-3);
}

TEST(TextureLayout, TrianglesHaveTheOrderWhoseBarkTheyWear) {
  const Field field = small_tree();
  const Mesh mesh = small_tree_mesh(field);
  const MeshAttributes a = small_tree_attributes(field, mesh);
  ASSERT_EQ(a.triangle_order.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3& p = mesh.positions[mesh.triangles[t][0]];
    if (p.z > 0.7 && p.x < 0.4) continue;
    EXPECT_EQ(a.triangle_order[t], p.x > 0.4 ? 1 : 0);
  }
}

// Triangles larger than what a branch reaches: some corners know nothing of what the others are on.
TEST(TextureLayout, AMeshMuchCoarserThanItsBranchesStillHasCoordinates) {
  const Field field = small_tree();
  Mesh mesh;
  mesh.positions = {Vec3(-0.1, 0, 0.1), Vec3(0.7, 0, 1.4), Vec3(0, -0.3, 1.5), Vec3(5, 5, 5)};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.triangles = {{{0, 1, 2}}, {{0, 1, 3}}, {{1, 2, 3}}, {{3, 3, 3}}};
  const MeshAttributes a = small_tree_attributes(field, mesh);
  for (const auto& uv : a.uv_triangles)
    for (const std::uint32_t i : uv) {
      ASSERT_LT(i, a.uvs.size());
      EXPECT_TRUE(std::isfinite(a.uvs[i].x));
    }
}

}  // namespace
}  // namespace cambium
