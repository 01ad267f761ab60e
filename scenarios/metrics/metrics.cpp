// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/metrics.h"

#include <algorithm>
#include <array>

namespace plumbline::scenarios::score {

namespace {

using Value = std::optional<double>;

template <class Part, class T>
std::function<Value(const MethodScore&)> field(std::optional<Part> MethodScore::*part, T Part::*member) {
  return [part, member](const MethodScore& score) -> Value {
    if (!(score.*part)) return std::nullopt;
    return static_cast<double>((*(score.*part)).*member);
  };
}

template <class Part, class T>
std::function<Value(const MethodScore&)> field(std::optional<Part> MethodScore::*part, std::optional<T> Part::*member) {
  return [part, member](const MethodScore& score) -> Value {
    if (!(score.*part) || !((*(score.*part)).*member)) return std::nullopt;
    return static_cast<double>(*((*(score.*part)).*member));
  };
}

std::vector<MetricRow> make_rows() {
  using S = MethodScore;
  using T = TrajectoryScore;
  using L = LocalizationScore;
  return {
      {"ate_rmse_m", "m", Better::lower, field(&S::trajectory, &T::ate_rmse_m)},
      {"ate_aligned_rmse_m", "m", Better::lower, field(&S::trajectory, &T::ate_aligned_rmse_m)},
      {"ate_final_rmse_m", "m", Better::lower, field(&S::trajectory, &T::ate_final_rmse_m)},
      {"rpe_1m_rmse_m", "m", Better::lower, field(&S::trajectory, &T::rpe_1m_rmse_m)},
      {"drift_10m_percent", "%", Better::lower, field(&S::trajectory, &T::drift_10m_percent)},
      {"drift_10m_deg_per_m", "deg/m", Better::lower, field(&S::trajectory, &T::drift_10m_deg_per_m)},
      {"coverage", "", Better::higher, field(&S::trajectory, &T::coverage)},
      {"map_rmse_m", "m", Better::lower, field(&S::map, &MapScore::rmse_m)},
      {"map_capped_share", "", Better::lower, field(&S::map, &MapScore::capped_share)},
      {"map_completeness", "", Better::higher, field(&S::map, &MapScore::completeness)},
      {"rooms.visited", "", Better::neither, field(&S::rooms, &RoomScore::visited)},
      {"rooms.found", "", Better::neither, field(&S::rooms, &RoomScore::found)},
      {"rooms.matched", "", Better::higher, field(&S::rooms, &RoomScore::matched)},
      {"rooms.precision", "", Better::higher, field(&S::rooms, &RoomScore::precision)},
      {"rooms.recall", "", Better::higher, field(&S::rooms, &RoomScore::recall)},
      {"walls.precision", "", Better::higher, field(&S::walls, &WallScore::precision)},
      {"walls.recall", "", Better::higher, field(&S::walls, &WallScore::recall)},
      {"localization.converged_at_s", "s", Better::lower, field(&S::localization, &L::converged_at_s)},
      {"localization.converged_at_m", "m", Better::lower, field(&S::localization, &L::converged_at_m)},
      {"localization.ape_rmse_m", "m", Better::lower, field(&S::localization, &L::ape_rmse_m)},
      {"localization.yaw_rmse_deg", "deg", Better::lower, field(&S::localization, &L::yaw_rmse_deg)},
      {"localization.hypotheses", "", Better::neither, field(&S::localization, &L::hypotheses)},
      {"localization.identifiable_at_s", "s", Better::neither, field(&S::localization, &L::identifiable_at_s)},
      {"localization.identifiable_at_m", "m", Better::neither, field(&S::localization, &L::identifiable_at_m)},
      {"localization.twin_error_rmse_m", "m", Better::lower, field(&S::localization, &L::twin_error_rmse_m)},
      {"localization.true_mass", "", Better::higher, field(&S::localization, &L::true_mass)},
      {"localization.nees", "", Better::neither, field(&S::localization, &L::nees)},
      {"localization.handover_precision", "", Better::higher, field(&S::localization, &L::handover_precision)},
      {"localization.failure_at_s", "s", Better::neither, field(&S::localization, &L::failure_at_s)},
      {"localization.kidnap_wrong_s", "s", Better::lower, field(&S::localization, &L::kidnap_wrong_s)},
      {"localization.kidnap_found_s", "s", Better::lower, field(&S::localization, &L::kidnap_found_s)},
      {"localization.kidnap_found_m", "m", Better::lower, field(&S::localization, &L::kidnap_found_m)},
  };
}

std::string_view state_name(slam::State state) {
  static constexpr std::array<std::string_view, 4> names = {"SEARCHING", "AMBIGUOUS", "CONVERGED", "LOST"};
  return names[static_cast<std::size_t>(state)];
}

}  // namespace

std::string to_string(Evidence evidence) {
  static constexpr std::array<const char*, 3> names = {"unique", "weak", "ambiguous"};
  return names[static_cast<std::size_t>(evidence)];
}

std::string to_string(Failure failure) {
  static constexpr std::array<const char*, 6> names = {"never_sampled", "depleted",      "twin_preferred",
                                                       "wrong_model",   "tracking_lost", "undecided"};
  return names[static_cast<std::size_t>(failure)];
}

std::span<const MetricRow> metrics() {
  static const std::vector<MetricRow> rows = make_rows();
  return rows;
}

const MetricRow* find_metric(std::string_view name) {
  const auto rows = metrics();
  const auto it = std::find_if(rows.begin(), rows.end(), [&](const MetricRow& row) { return row.name == name; });
  return it == rows.end() ? nullptr : &*it;
}

Tree to_results(const MethodScore& score) {
  Tree tree = Tree::map();
  tree.set("verdict", score.verdict);
  if (!score.error.empty()) tree.set("error", score.error);
  std::vector<std::pair<std::string, Tree>> blocks;
  const auto block_of = [&](const std::string& name) -> Tree& {
    const auto it = std::find_if(blocks.begin(), blocks.end(), [&](const auto& b) { return b.first == name; });
    return it != blocks.end() ? it->second : blocks.emplace_back(name, Tree::map()).second;
  };
  if (score.localization) {
    block_of("localization").set("state", state_name(score.localization->state));
    if (score.localization->failure) block_of("localization").set("failure", to_string(*score.localization->failure));
    if (score.localization->identifiable)
      block_of("localization").set("identifiable", *score.localization->identifiable);
    if (score.localization->evidence)
      block_of("localization").set("evidence", to_string(*score.localization->evidence));
  }
  for (const MetricRow& row : metrics()) {
    const Value value = row.value(score);
    if (!value) continue;
    const std::size_t dot = row.name.find('.');
    if (dot == std::string_view::npos)
      tree.set(std::string(row.name), *value);
    else
      block_of(std::string(row.name.substr(0, dot))).set(std::string(row.name.substr(dot + 1)), *value);
  }
  for (auto& [name, block] : blocks) tree.set(name, std::move(block));
  return tree;
}

}  // namespace plumbline::scenarios::score
