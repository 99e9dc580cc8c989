// Cost of the field: a point, and a point of a batch, on one chain and on one fork, over the number of chain nodes.
#include "blobtree/field.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace cambium {
namespace {

constexpr std::size_t kBatch = 512;

/// A gently winding stem along z from `from`, 1 m long, tapering from `radius` to half of it.
Chain winding_stem(const Vec3& from, const Vec3& along, double radius, int nodes) {
  Chain chain;
  for (int i = 0; i < nodes; ++i) {
    const double t = i / (nodes - 1.0);
    chain.nodes.push_back({from + t * along + Vec3(0.05 * std::sin(6 * t), 0.05 * std::sin(5 * t), 0), radius * (1 - 0.5 * t)});
  }
  return chain;
}

Field chain_field(int nodes) {
  BlobTreeBuilder builder;
  return Field(builder.build(builder.add(winding_stem({0, 0, 0}, {0, 0, 1}, 0.1, nodes))));
}

Field fork_field(int nodes) {
  BlobTreeBuilder builder;
  Fork fork;
  fork.axis = builder.add(winding_stem({0, 0, 0}, {0, 0, 1}, 0.1, nodes));
  const NodeId lateral = builder.add(winding_stem({0, 0, 0.5}, {0.6, 0, 0.6}, 0.06, nodes));
  fork.laterals.push_back({lateral, {0, 0, 0.5}, {0, 0, 1}, 0.036, 0.32});
  return Field(builder.build(builder.add(fork)));
}

/// Points of a low-discrepancy sequence in a box of 0.2 m around the middle of the stem.
std::vector<Vec3> points_near_the_fork() {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < kBatch; ++i) {
    const double n = static_cast<double>(i);
    points.emplace_back(0.2 * (std::fmod(n * 0.8191725, 1) - 0.5), 0.2 * (std::fmod(n * 0.6710436, 1) - 0.5),
                        0.5 + 0.2 * (std::fmod(n * 0.5497005, 1) - 0.5));
  }
  return points;
}

void point_samples(benchmark::State& state, const Field& field) {
  const std::vector<Vec3> points = points_near_the_fork();
  for (auto _ : state)
    for (const Vec3& p : points) benchmark::DoNotOptimize(field.sample(p));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}

void batch_samples(benchmark::State& state, const Field& field) {
  const PrunedField pruned = field.prune({{-0.1, -0.1, 0.4}, {0.1, 0.1, 0.6}});
  std::vector<float> x(kBatch), y(kBatch), z(kBatch), f(kBatch), gx(kBatch), gy(kBatch), gz(kBatch);
  const std::vector<Vec3> points = points_near_the_fork();
  for (std::size_t i = 0; i < kBatch; ++i) {
    const Vec3 p = points[i] - pruned.origin();
    x[i] = static_cast<float>(p.x), y[i] = static_cast<float>(p.y), z[i] = static_cast<float>(p.z);
  }
  Evaluator evaluator;
  for (auto _ : state) {
    evaluator.samples(pruned, x, y, z, f, gx, gy, gz);
    benchmark::DoNotOptimize(f.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kBatch));
}

void chain_points(benchmark::State& state) { point_samples(state, chain_field(static_cast<int>(state.range(0)))); }
void chain_batches(benchmark::State& state) { batch_samples(state, chain_field(static_cast<int>(state.range(0)))); }
void fork_points(benchmark::State& state) { point_samples(state, fork_field(static_cast<int>(state.range(0)))); }
void fork_batches(benchmark::State& state) { batch_samples(state, fork_field(static_cast<int>(state.range(0)))); }

BENCHMARK(chain_points)->Arg(8)->Arg(64)->Arg(512);
BENCHMARK(chain_batches)->Arg(8)->Arg(64)->Arg(512);
BENCHMARK(fork_points)->Arg(8)->Arg(64)->Arg(512);
BENCHMARK(fork_batches)->Arg(8)->Arg(64)->Arg(512);

}  // namespace
}  // namespace cambium

BENCHMARK_MAIN();
