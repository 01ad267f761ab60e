// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/answer_sentence.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "scenarios/metrics/reference_score.h"
#include "scenarios/metrics/state_names.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

std::string number_and(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string at_time(double t_s) { return svg::number(t_s, 1) + " s"; }

/// "CONVERGED 58 % of the time, AMBIGUOUS 42 %", the longest first.
std::string shares_text(const std::vector<StateSpan>& spans) {
  std::vector<std::pair<double, std::string_view>> shares;
  for (const std::string_view name : state_names)
    if (const double share = share_of_time(spans, name); share > 0.0) shares.emplace_back(share, name);
  std::stable_sort(shares.begin(), shares.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (const auto& [share, name] : shares) {
    const double percent = 100.0 * share;
    text += (text.empty() ? "" : ", ") + std::string(name) + " " +
            (percent < 1.0 ? "less than 1" : svg::number(percent, 0)) + " %" + (text.empty() ? " of the time" : "");
  }
  return text;
}

/// " It reported LOST from 12 s to 14 s and once more." or nothing.
std::string lost_text(const std::vector<StateSpan>& spans) {
  constexpr std::size_t most = 3;  // named
  std::vector<const StateSpan*> lost;
  for (const StateSpan& span : spans)
    if (span.state == state_name(slam::State::lost)) lost.push_back(&span);
  if (lost.empty()) return "";
  std::string text = " It reported LOST ";
  for (std::size_t i = 0; i < std::min(most, lost.size()); ++i)
    text += (i == 0 ? "from " : ", from ") + at_time(lost[i]->from_s) +
            (lost[i] == &spans.back() ? " to the end" : " to " + at_time(lost[i]->to_s));
  if (lost.size() > most) text += " and " + number_and(lost.size() - most, "time", "times") + " more";
  return text + ".";
}

std::string localization_text(const MethodRecord& method, const std::vector<StateSpan>& spans) {
  const std::string converged(state_name(slam::State::converged));
  const std::string state = spans.empty() ? std::string("without a state") : spans.back().state;
  std::string text = "Ended " + state;
  const std::vector<slam::Hypothesis> none;
  const std::vector<slam::Hypothesis>& last = method.beliefs.empty() ? none : method.beliefs.back().hypotheses;
  if (state == converged && !last.empty() && !last.front().room.empty())
    text += " in " + last.front().room;
  else if (last.size() > 1)
    text += " with " + number_and(last.size(), "hypothesis", "hypotheses");
  const auto first =
      std::find_if(spans.begin(), spans.end(), [&](const StateSpan& span) { return span.state == converged; });
  text += first == spans.end() ? "; it never announced a pose."
                               : "; it first announced a pose " + at_time(first->from_s) + " after the first scan.";
  const std::string shares = shares_text(spans);
  if (!shares.empty()) text += " " + shares + ".";
  return text + lost_text(spans);
}

/// " 2 loops closed." or nothing of a method that closes none.
std::string loops_text(const slam::Estimate& estimate) {
  if (!estimate.loops) return "";
  return estimate.loops->empty() ? " No loop closed."
                                 : " " + number_and(estimate.loops->size(), "loop", "loops") + " closed.";
}

/// "5 planes, 1 room" of what the method found.
std::string found_text(const slam::Estimate& estimate) {
  std::string text;
  const auto add = [&](std::size_t count, const std::string& one, const std::string& many) {
    text += (text.empty() ? "" : ", ") + number_and(count, one, many);
  };
  if (!estimate.planes.empty()) add(estimate.planes.size(), "plane", "planes");
  if (!estimate.rooms.empty()) add(estimate.rooms.size(), "room", "rooms");
  if (!estimate.floors.empty()) add(estimate.floors.size(), "floor", "floors");
  return text;
}

std::string slam_text(const MethodRecord& method, const std::vector<StateSpan>& spans) {
  const score::PathScore path = score::score_path(method.causal);
  std::string text = "A path of " + svg::number(path.length_m, 1) + " m in " + at_time(path.duration_s);
  if (method.scans > 0) {
    text += "; " + std::to_string(method.causal.size()) + " of " +
            number_and(static_cast<std::size_t>(method.scans), "scan has", "scans have") + " a pose";
    const double scans = method.scans;
    const auto share = [&](int count) {
      return std::to_string(count) + " (" + svg::number(100.0 * count / scans, 0) + " %)";
    };
    text += method.lost_scans > 0 ? ", LOST at " + share(method.lost_scans) : ", never LOST";
    if (method.degenerate_scans > 0)
      text += ", " + share(method.degenerate_scans) + " leave a direction of the pose open";
  }
  text += ".";
  if (const std::string found = found_text(method.estimate); !found.empty()) text += " Found: " + found + ".";
  text += loops_text(method.estimate);
  return text + lost_text(spans);
}

}  // namespace

std::string answer_sentence(const MethodRecord& method, const std::vector<StateSpan>& spans) {
  if (method.crashed) return "The method stopped with an error: " + method.error;
  if (method.localization) return localization_text(method, spans);
  return method.causal.empty() ? "The method gave no pose." : slam_text(method, spans);
}

std::string final_state(const MethodRecord& method, const std::vector<StateSpan>& spans) {
  if (method.crashed) return "crashed";
  if (!method.localization && method.causal.empty()) return "no pose";
  return spans.empty() ? "" : spans.back().state;
}

}  // namespace plumbline::scenarios
