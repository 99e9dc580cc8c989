#include "bench/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace cambium::bench {
namespace {

/// Four figures that count, without an exponent.
std::string plain(double value) {
  const int before = value == 0 ? 1 : static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  return fmt::format("{:.{}f}", value, std::clamp(4 - before, 0, 4));
}

bool is_time_per_item(const std::string& unit) { return unit.rfind("ns/", 0) == 0; }

std::string target_text(const Target& target) {
  return fmt::format("{} {:g}", target.side == Target::Side::kAtLeast ? ">=" : "<=", target.bound);
}

std::string row_text(const Row& row) {
  std::string figure, rate, ratio, target, verdict;
  if (row.figure) figure = plain(*row.figure);
  if (row.figure && is_time_per_item(row.unit)) rate = fmt::format("{}", plain(1e3 / *row.figure));
  if (row.ratio) ratio = fmt::format("{:.2f} of {}", *row.ratio, row.ratio_to);
  if (row.target) target = target_text(*row.target);
  if (const auto met = row.met()) verdict = *met ? "pass" : "FAIL";
  std::string text =
      fmt::format("  {:<46} {:>9} {:<18} {:>8}  {:<24} {:<9} {}", row.what, figure, row.unit, rate, ratio, target, verdict);
  text.erase(text.find_last_not_of(' ') + 1);
  return text + '\n';
}

}  // namespace

std::optional<bool> Row::met() const {
  if (!target || (!ratio && !figure)) return std::nullopt;
  return target->met_by(ratio ? *ratio : *figure);
}

void Report::heading(std::string text) { lines_.push_back({Line::Kind::kHeading, std::move(text), {}}); }
void Report::add(Row row) { lines_.push_back({Line::Kind::kRow, {}, std::move(row)}); }
void Report::note(std::string text) { lines_.push_back({Line::Kind::kNote, std::move(text), {}}); }

std::size_t Report::judged() const {
  std::size_t count = 0;
  for (const Line& line : lines_) count += line.row.met().has_value();
  return count;
}

std::size_t Report::missed() const {
  std::size_t count = 0;
  for (const Line& line : lines_) count += line.row.met() == false;
  return count;
}

std::string Report::table() const {
  std::string text = fmt::format("  {:<46} {:>9} {:<18} {:>8}  {:<24} {:<9}\n", "", "figure", "", "M/s", "ratio", "target");
  for (const Line& line : lines_) {
    if (line.kind == Line::Kind::kHeading)
      text += '\n' + line.text + '\n';
    else if (line.kind == Line::Kind::kNote)
      text += "  (" + line.text + ")\n";
    else
      text += row_text(line.row);
  }
  return text;
}

std::string Report::json() const {
  nlohmann::ordered_json sections = nlohmann::ordered_json::array();
  for (const Line& line : lines_) {
    if (line.kind == Line::Kind::kHeading) {
      sections.push_back({{"section", line.text}, {"rows", nlohmann::ordered_json::array()}});
      continue;
    }
    if (line.kind == Line::Kind::kNote) {
      sections.back()["notes"].push_back(line.text);
      continue;
    }
    const Row& row = line.row;
    nlohmann::ordered_json out = {{"what", row.what}};
    if (row.figure) out["figure"] = *row.figure, out["unit"] = row.unit;
    if (row.ratio) out["ratio"] = *row.ratio, out["ratio_to"] = row.ratio_to;
    if (row.target) out["target"] = target_text(*row.target);
    if (const auto met = row.met()) out["met"] = *met;
    sections.back()["rows"].push_back(std::move(out));
  }
  return sections.dump(2) + '\n';
}

}  // namespace cambium::bench
