// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/localization_score.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "bim/errors.h"
#include "scenarios/metrics/failure_cause.h"

namespace plumbline::scenarios::score {

namespace {

constexpr double degrees = 180.0 / std::numbers::pi;

double position_error(const Pose& X_WR, const Pose& X_WR_true) { return (X_WR.t - X_WR_true.t).norm(); }

double yaw_error_deg(const Pose& X_WR, const Pose& X_WR_true) {
  return std::abs(wrap_angle(X_WR.yaw() - X_WR_true.yaw())) * degrees;
}

bool right(const Pose& X_WR, const Pose& X_WR_true, const LocalizationRules& rules) {
  return position_error(X_WR, X_WR_true) <= rules.position_m && yaw_error_deg(X_WR, X_WR_true) <= rules.yaw_deg;
}

/// What happened from the first convergence to the end.
struct Course {
  std::size_t first = 0;  ///< index of the first converged belief
  bool right_at_first = false;
  bool right_to_the_end = true;
  bool wrong_while_converged = false;
  double ape_sum = 0.0;
  double yaw_sum = 0.0;
  std::size_t count = 0;
};

std::optional<Course> follow(const Truth& truth, const std::vector<Belief>& beliefs, const LocalizationRules& rules) {
  const auto converged = std::find_if(beliefs.begin(), beliefs.end(), [](const Belief& b) {
    return b.state == slam::State::converged && b.X_WR.has_value();
  });
  if (converged == beliefs.end()) return std::nullopt;
  Course course;
  course.first = static_cast<std::size_t>(converged - beliefs.begin());
  Pose X_WR;
  for (std::size_t i = course.first; i < beliefs.size(); ++i) {
    const Belief& belief = beliefs[i];
    if (belief.X_WR) X_WR = *belief.X_WR;
    const Pose X_WR_true = truth.at(belief.stamp);
    const bool is_right = right(X_WR, X_WR_true, rules);
    if (i == course.first) course.right_at_first = is_right;
    course.right_to_the_end = course.right_to_the_end && is_right;
    if (!is_right && belief.state == slam::State::converged) course.wrong_while_converged = true;
    course.ape_sum += std::pow(position_error(X_WR, X_WR_true), 2);
    course.yaw_sum += std::pow(yaw_error_deg(X_WR, X_WR_true), 2);
    ++course.count;
  }
  return course;
}

double walked_at(const Truth& truth, slam::Nanoseconds t) {
  const std::vector<double> walked = truth.walked();
  const auto next = std::upper_bound(truth.scans.begin(), truth.scans.end(), t);
  const auto passed = static_cast<std::size_t>(next - truth.scans.begin());
  return passed == 0 ? 0.0 : walked[passed - 1];
}

/// Honest ambiguity: every hypothesis is the true pose or one the plan cannot tell from it, they are few,
/// and the true one keeps its share.
bool is_honest(const Belief& last, const Pose& X_WR_true, const std::vector<Pose>& others_W,
               const LocalizationRules& rules) {
  std::size_t claimed = 0;
  double true_mass = 0.0;
  for (const slam::Hypothesis& hypothesis : last.hypotheses) {
    if (hypothesis.mass < rules.claimed_mass) continue;
    ++claimed;
    const bool is_true = right(hypothesis.X_WR, X_WR_true, rules);
    const bool is_alias = std::any_of(others_W.begin(), others_W.end(),
                                      [&](const Pose& X_WA) { return right(hypothesis.X_WR, X_WA, rules); });
    if (!is_true && !is_alias) return false;
    if (is_true) true_mass += hypothesis.mass;
  }
  return claimed > 0 && claimed <= 2 * others_W.size() + 1 &&
         true_mass >= 0.5 / (static_cast<double>(others_W.size()) + 1.0);
}

struct Nees {
  std::optional<double> mean;
  std::optional<double> left_out;  ///< how many scans
};

/// Mean normalised estimation error squared over the converged scans that are right, less those without a covariance
/// that is positive definite.
Nees mean_nees(const Truth& truth, const std::vector<Belief>& beliefs, const LocalizationRules& rules) {
  double sum = 0.0;
  int count = 0, left_out = 0;
  for (const Belief& belief : beliefs) {
    if (belief.state != slam::State::converged || belief.hypotheses.empty()) continue;
    const slam::Hypothesis& best = *std::max_element(belief.hypotheses.begin(), belief.hypotheses.end(),
                                                     [](const auto& a, const auto& b) { return a.mass < b.mass; });
    const Pose X_WR_true = truth.at(belief.stamp);
    if (!right(best.X_WR, X_WR_true, rules)) continue;
    const Eigen::Vector3d e(best.X_WR.t.x() - X_WR_true.t.x(), best.X_WR.t.y() - X_WR_true.t.y(),
                            wrap_angle(best.X_WR.yaw() - X_WR_true.yaw()));
    const Eigen::LLT<Eigen::Matrix3d> root(best.covariance);
    const double nees = root.info() == Eigen::Success ? e.dot(root.solve(e)) : std::numeric_limits<double>::infinity();
    const bool is_usable = std::isfinite(nees);
    if (is_usable) sum += nees;
    ++(is_usable ? count : left_out);
  }
  if (count + left_out == 0) return {};
  return {count > 0 ? std::optional(sum / count) : std::nullopt, left_out};
}

double true_mass_of(const Belief& belief, const Pose& X_WR_true, const LocalizationRules& rules) {
  double mass = 0.0;
  for (const slam::Hypothesis& hypothesis : belief.hypotheses)
    if (right(hypothesis.X_WR, X_WR_true, rules)) mass += hypothesis.mass;
  return mass;
}

std::optional<double> aliased_error(const Truth& truth, const std::vector<Belief>& beliefs, std::size_t first,
                                    const std::vector<Pose>& aliases) {
  double sum = 0.0;
  Pose X_WR;
  for (std::size_t i = first; i < beliefs.size(); ++i) {
    if (beliefs[i].X_WR) X_WR = *beliefs[i].X_WR;
    const Pose X_WR_true = truth.at(beliefs[i].stamp);
    double least = position_error(X_WR, X_WR_true);
    for (const Pose& alias : aliases) least = std::min(least, position_error(X_WR, alias * X_WR_true));
    sum += least * least;
  }
  return std::sqrt(sum / static_cast<double>(beliefs.size() - first));
}

LocalizationVerdict judge_unique(const std::optional<Course>& course, slam::State last, bool held) {
  if (!course) return last == slam::State::lost ? LocalizationVerdict::lost : LocalizationVerdict::late;
  if (!course->right_at_first || course->wrong_while_converged) return LocalizationVerdict::false_convergence;
  if (!course->right_to_the_end || last != slam::State::converged) return LocalizationVerdict::lost;
  return held ? LocalizationVerdict::success : LocalizationVerdict::late;
}

/// Where the plan has several answers, a single one is never a success.
LocalizationVerdict judge_ambiguous(const std::optional<Course>& course, const Belief& last, bool held, bool honest) {
  if (last.state == slam::State::converged)
    return held && course->right_to_the_end ? LocalizationVerdict::lucky : LocalizationVerdict::overconfident;
  if (course && course->wrong_while_converged) return LocalizationVerdict::overconfident;
  if (honest) return LocalizationVerdict::honest_ambiguity;
  return last.state == slam::State::lost ? LocalizationVerdict::lost : LocalizationVerdict::late;
}

Evidence evidence_of(const IdentifiabilityAnswer& known, const Truth& truth, const LocalizationRules& rules) {
  if (!known.identifiable) return known.marginal_from_s ? Evidence::marginal : Evidence::ambiguous;
  const double left_s = slam::seconds(truth.scans.back() - truth.scans.front()) - known.at_s.value_or(0.0);
  const double left_m = truth.walked().back() - known.at_m.value_or(0.0);
  return left_s >= rules.hold_s && left_m >= rules.hold_m ? Evidence::unique : Evidence::marginal;
}

/// Sets what can be known by the building, and with the furniture besides.
void set_identifiability(const Identifiability& known, const Truth& truth, const LocalizationRules& rules,
                         LocalizationScore& score) {
  score.identifiable = known.identifiable;
  score.identifiable_at_s = known.at_s;
  score.identifiable_at_m = known.at_m;
  score.evidence = evidence_of(known, truth, rules);
  if (!known.with_furniture) return;
  const IdentifiabilityAnswer& other = *known.with_furniture;
  score.with_furniture = WithFurniture{other.identifiable, evidence_of(other, truth, rules), other.at_s, other.at_m,
                                       static_cast<int>(other.others_W.size())};
  score.evidence_by_furniture =
      score.evidence == Evidence::ambiguous && score.with_furniture->evidence == Evidence::unique;
}

/// What came of a kidnapping. Time in which the robot stands counts too.
void score_kidnap(const Truth& truth, const std::vector<Belief>& beliefs, const LocalizationRules& rules,
                  LocalizationScore& score) {
  const slam::Nanoseconds set_down = *truth.set_down;
  bool was_wrong = false, was_right = false;
  slam::Nanoseconds wrong_from = 0, right_from = 0, longest = 0;
  std::optional<Pose> X_WR;
  for (const Belief& belief : beliefs) {
    if (belief.X_WR) X_WR = belief.X_WR;
    if (belief.stamp < set_down) continue;
    const bool answers = belief.state == slam::State::converged && X_WR.has_value();
    const bool is_right = answers && right(*X_WR, truth.at(belief.stamp), rules), is_wrong = answers && !is_right;
    if (is_right && !was_right) right_from = belief.stamp;
    if (is_wrong && !was_wrong) wrong_from = belief.stamp;
    if (is_wrong) longest = std::max(longest, belief.stamp - wrong_from);
    was_right = is_right;
    was_wrong = is_wrong;
  }
  score.kidnap_wrong_s = slam::seconds(longest);
  score.state = beliefs.back().state;
  score.hypotheses = static_cast<int>(beliefs.back().hypotheses.size());
  if (!was_right || slam::seconds(beliefs.back().stamp - right_from) < rules.hold_s) return;
  const double walked_m = walked_at(truth, right_from);
  if (walked_at(truth, beliefs.back().stamp) - walked_m < rules.hold_m) return;
  score.kidnap_found_s = slam::seconds(right_from - set_down);
  score.kidnap_found_m = walked_m - walked_at(truth, set_down);
}

}  // namespace

std::string to_string(LocalizationVerdict verdict) {
  static constexpr std::array<const char*, 7> names = {
      "success", "false_convergence", "overconfident", "honest_ambiguity", "late", "lost", "lucky"};
  return names[static_cast<std::size_t>(verdict)];
}

LocalizationScore score_localization(const Truth& truth, const std::vector<Belief>& beliefs,
                                     const std::optional<Identifiability>& identifiability,
                                     const LocalizationRules& rules) {
  if (truth.set_down) {
    std::vector<Belief> before = beliefs;
    std::erase_if(before, [&](const Belief& belief) { return belief.stamp >= *truth.set_down; });
    if (before.empty()) before.push_back({truth.scans.front(), slam::State::searching, {}, {}, {}});
    LocalizationScore score = score_localization(truth.before(), before, identifiability, rules);
    score_kidnap(truth, beliefs, rules, score);
    return score;
  }
  if (beliefs.empty()) throw InternalError("score: a localization without any belief");
  const Belief& last = beliefs.back();
  LocalizationScore score;
  score.state = last.state;
  score.hypotheses = static_cast<int>(last.hypotheses.size());
  const std::optional<Course> course = follow(truth, beliefs, rules);
  bool held = false;
  if (course) {
    const slam::Nanoseconds t = beliefs[course->first].stamp;
    score.converged_at_s = slam::seconds(t - truth.scans.front());
    score.converged_at_m = walked_at(truth, t);
    const auto n = static_cast<double>(course->count);
    score.ape_rmse_m = std::sqrt(course->ape_sum / n);
    score.yaw_rmse_deg = std::sqrt(course->yaw_sum / n);
    held = slam::seconds(last.stamp - t) >= rules.hold_s &&
           walked_at(truth, last.stamp) - *score.converged_at_m >= rules.hold_m;
  }
  if (identifiability) set_identifiability(*identifiability, truth, rules, score);
  // Where others are left but marginal, a single answer that stands to the end is judged as where none is.
  const bool answers_marginal = course && score.evidence == Evidence::marginal && last.state == slam::State::converged;
  const bool ambiguous = identifiability && !identifiability->others_W.empty() && !answers_marginal;
  score.verdict = ambiguous ? judge_ambiguous(course, last, held,
                                              is_honest(last, truth.at(last.stamp), identifiability->others_W, rules))
                            : judge_unique(course, last.state, held);
  const bool early = identifiability && score.converged_at_s && identifiability->marginal_from_s &&
                     *score.converged_at_s < *identifiability->marginal_from_s;
  if (early && score.verdict == LocalizationVerdict::success) score.verdict = LocalizationVerdict::lucky;
  const std::vector<Pose> aliases = identifiability ? identifiability->aliases_at_start : std::vector<Pose>();
  if (course) score.aliased_error_rmse_m = aliased_error(truth, beliefs, course->first, aliases);
  if (!last.hypotheses.empty()) score.true_mass = true_mass_of(last, truth.at(last.stamp), rules);
  const Nees nees = mean_nees(truth, beliefs, rules);
  score.nees = nees.mean;
  score.nees_left_out = nees.left_out;
  if (const auto why = failure_of(truth, beliefs, score.verdict, aliases, rules)) {
    score.failure = why->failure;
    score.failure_at_s = slam::seconds(why->stamp);
  }
  return score;
}

}  // namespace plumbline::scenarios::score
