// SPDX-License-Identifier: Apache-2.0
#include "scenarios/score/moment.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "bim/config/tree.h"
#include "scenarios/metrics/localization_score.h"

namespace plumbline::scenarios::score {

namespace {

/// The scan of the greatest error among those that the method does not disclaim.
std::optional<double> worst_moment(const MethodRecord& method, const Truth& truth) {
  const std::vector<PosePair> pairs = associate(truth, method.causal, {});
  if (pairs.empty()) return std::nullopt;
  const Pose X_WF = method.localization ? Pose() : umeyama(pairs);
  double worst = -1.0;
  std::optional<double> at_s;
  for (const PosePair& pair : pairs) {
    const slam::Nanoseconds stamp = truth.scans[pair.scan];
    const double error = (X_WF * pair.X_FR.t - pair.X_WR.t).norm();
    if (error <= worst || (at_s && said_lost(method, stamp))) continue;
    worst = error;
    at_s = slam::seconds(stamp);
  }
  return at_s;
}

/// The first answer of a localization from then on that is wrong by its place.
std::optional<double> first_wrong_answer(const MethodRecord& method, const Truth& truth, double from_s) {
  for (const PosePair& pair : associate(truth, method.causal, {})) {
    const slam::Nanoseconds stamp = truth.scans[pair.scan];
    const double t_s = slam::seconds(stamp);
    if (t_s < from_s - 1e-6 || said_lost(method, stamp)) continue;
    if ((pair.X_FR.t - pair.X_WR.t).norm() > LocalizationRules().position_m) return t_s;
  }
  return std::nullopt;
}

/// Where a method failed or first said that it is lost.
std::optional<double> failed_at(const MethodRecord& method, const MethodScore& score, const Truth& truth) {
  const std::optional<LocalizationScore>& where = score.localization;
  if (where && where->failure_at_s) {
    // What failed before anything was said shows once something is said.
    const auto said = first_wrong_answer(method, truth, *where->failure_at_s);
    return said ? said : where->failure_at_s;
  }
  if (!method.lost.empty()) return slam::seconds(method.lost.front().from);
  for (const BeliefRecord& belief : method.beliefs)
    if (belief.state == slam::State::lost) return slam::seconds(belief.stamp);
  return std::nullopt;
}

}  // namespace

std::string in_link(const std::string& text) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
                       c == '.' || c == '-' || c == '/';
    if (plain)
      out += c;
    else
      out += {'%', digits[byte >> 4U], digits[byte & 15U]};
  }
  return out;
}

std::optional<double> telling_moment(const FinishedRun& run, const RunScore& score, const std::string& method) {
  const std::vector<MethodRecord>& records = run.record.methods;
  for (std::size_t i = 0; i < records.size(); ++i) {
    if (records[i].name != method) continue;
    const std::optional<double> failed = failed_at(records[i], score.methods[i], score.truth);
    return failed ? failed : worst_moment(records[i], score.truth);
  }
  return std::nullopt;
}

std::optional<double> telling_moment(const FinishedRun& run, const RunScore& score, const GateResult& gate) {
  if (gate.value) return telling_moment(run, score, gate.method);
  const std::vector<MethodRecord>& records = run.record.methods;
  for (std::size_t i = 0; i < records.size(); ++i)
    if (records[i].name == gate.method) return failed_at(records[i], score.methods[i], score.truth);
  return std::nullopt;
}

double rounded_up(double t_s, double steps) {
  constexpr double noise = 1e-6;  // of a time that is a multiple already
  return std::ceil(steps * t_s - noise) / steps;
}

std::string moment_link(const FinishedRun& run, const RunScore& score, const GateResult& gate) {
  const std::optional<double> at_s = telling_moment(run, score, gate);
  if (!at_s && !gate.value) return "";
  return "#t=" + format_number(rounded_up(at_s.value_or(score.duration_s), 10.0)) + "&m=" + in_link(gate.method);
}

}  // namespace plumbline::scenarios::score
