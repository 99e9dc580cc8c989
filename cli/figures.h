// What a run reports about itself: counts, seconds per stage, peak memory.
#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace cambium {

using Json = nlohmann::ordered_json;

class Figures {
 public:
  Figures() : begin_(Clock::now()) {}

  /// Adds or replaces one top-level figure.
  void set(const std::string& key, Json value) { values_[key] = std::move(value); }
  void add_seconds(const std::string& stage, double seconds);

  /// The one object of `--json`: the figures in the order they were set, `seconds` (by stage, and total),
  /// `peak_memory_bytes`.
  Json object() const;

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_;
  Json values_ = Json::object();
  Json seconds_ = Json::object();
};

/// Times a stage from construction to destruction.
class StageTimer {
 public:
  StageTimer(Figures& figures, std::string stage)
      : figures_(figures), stage_(std::move(stage)), begin_(std::chrono::steady_clock::now()) {}
  ~StageTimer() {
    figures_.add_seconds(stage_, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count());
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  Figures& figures_;
  std::string stage_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace cambium
