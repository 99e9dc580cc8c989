#include "bench/measurements.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace cambium::bench {
namespace {

/// Keeps the fastest repetition of each benchmark and prints nothing.
class FastestRuns : public benchmark::BenchmarkReporter {
 public:
  explicit FastestRuns(std::map<std::string, double>& fastest) : fastest_(fastest) {}
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      if (run.error_occurred) throw std::runtime_error(run.run_name.function_name + ": " + run.error_message);
      const double ns = run.cpu_accumulated_time / static_cast<double>(run.iterations) * 1e9;
      const auto [place, is_new] = fastest_.emplace(run.run_name.function_name, ns);
      if (!is_new) place->second = std::min(place->second, ns);
    }
  }

 private:
  std::map<std::string, double>& fastest_;
};

/// Google Benchmark takes this setting from its command line only.
void take_turns() {
  std::string program = "cambium_bench", in_turns = "--benchmark_enable_random_interleaving=true";
  char* arguments[] = {program.data(), in_turns.data(), nullptr};
  int count = 2;
  benchmark::Initialize(&count, arguments);
}

}  // namespace

void Measurements::add(std::string name, std::function<void()> work) {
  work_.emplace_back(std::move(name), std::move(work));
}

void Measurements::run() {
  take_turns();
  for (const auto& [name, work] : work_)
    benchmark::RegisterBenchmark(name.c_str(),
                                 [&work](benchmark::State& state) {
                                   for (auto _ : state) {
                                     work();
                                     benchmark::ClobberMemory();
                                   }
                                 })
        ->Repetitions(pace_.repetitions)
        ->MinTime(pace_.seconds);
  FastestRuns reporter(fastest_);
  benchmark::RunSpecifiedBenchmarks(&reporter);
  benchmark::ClearRegisteredBenchmarks();
  work_.clear();
}

double Measurements::ns(const std::string& name) const { return fastest_.at(name); }

}  // namespace cambium::bench
