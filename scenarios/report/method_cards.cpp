// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/method_cards.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenarios/metrics/localization_score.h"
#include "scenarios/metrics/trajectory.h"
#include "scenarios/report/map_drawing.h"
#include "scenarios/report/palette.h"
#include "scenarios/report/plot.h"
#include "scenarios/report/results.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

std::string centimetres(double metres) { return svg::number(100.0 * metres, 1) + " cm"; }

std::string length(double metres) { return metres < 1.0 ? centimetres(metres) : svg::number(metres, 2) + " m"; }

/// A gate on the position error stands for it.
bool is_error_gated(const Tree& results, const std::string& method) {
  const Tree* gates = results.find("gates");
  if (gates == nullptr) return false;
  const Tree::List& list = gates->as_list();
  return std::any_of(list.begin(), list.end(), [&](const Tree& gate) {
    return text_of(gate, "method") == method && text_of(gate, "metric").starts_with("ate_");
  });
}

/// Error of a SLAM method that is far off and that no gate judges, m.
std::optional<double> far_off(const Tree& results, const std::string& method, const Tree* block) {
  if (block == nullptr || block->find("localization") != nullptr || is_error_gated(results, method))
    return std::nullopt;
  const auto error = number_of(block, "ate_aligned_rmse_m");
  return error && *error > score::TrajectoryRules().far_off_m ? error : std::nullopt;
}

/// A method's gates decide on its colour. Without any a verdict that says something of the answer does: `complete` does
/// not, but an error that is far off does.
std::string judged(const Tree& results, const std::string& method, const Tree* block) {
  const std::string verdict = block == nullptr ? "" : text_of(*block, "verdict");
  const GateCount gates = gates_of(results, method);
  if (gates.passed < gates.all || far_off(results, method, block)) return "bad";
  if (verdict == "success" || verdict == "honest_ambiguity") return "good";
  if (verdict != "complete") return "bad";
  return gates.all > 0 ? "good" : "open";
}

std::string gates_sentence(const ReportInput& input, const std::string& method) {
  const GateCount gates = gates_of(input.results, method);
  if (gates.all == 0) return "No gate judges it.";
  return std::to_string(gates.passed) + " of " + std::to_string(gates.all) +
         (gates.all == 1 ? " gate passed." : " gates passed.");
}

/// It was kidnapped, and from then on never right to the end.
bool never_found_again(const Tree* where) {
  return number_of(where, "kidnap_wrong_s").has_value() && !number_of(where, "kidnap_found_s");
}

bool is_gated(const Tree& results, const std::string& method, const std::string& metric) {
  const Tree* gates = results.find("gates");
  if (gates == nullptr) return false;
  const Tree::List& list = gates->as_list();
  return std::any_of(list.begin(), list.end(), [&](const Tree& gate) {
    return text_of(gate, "method") == method && text_of(gate, "metric") == metric;
  });
}

/// ", since ... (at t = 12.3 s)", or nothing.
std::string why_it_failed(const Tree* where) {
  const std::string failure = where == nullptr ? "" : text_of(*where, "failure");
  std::string why;
  if (failure == "never_sampled") why = "the true pose was never among the hypotheses";
  if (failure == "depleted") why = "the true pose dropped out of the hypotheses";
  if (failure == "twin_preferred") why = "a pose aliased with the true one at the start was preferred";
  if (failure == "wrong_model") why = "a pose not aliased with the true one was preferred";
  if (failure == "undecided") why = "the true pose remained one of several";
  if (why.empty()) return "";
  const auto at = number_of(where, "failure_at_s");
  const std::string when = failure == "undecided" ? " (until t = " : " (at t = ";
  return ", since " + why + (at ? when + svg::number(*at, 1) + " s)" : "");
}

/// What came of a kidnapping, as sentences of their own, or nothing. Durations and times of the run stand apart.
std::string after_kidnap(const ReportInput& input, const Tree* where) {
  const auto wrong = number_of(where, "kidnap_wrong_s");
  if (!wrong || !input.kidnap) return "";
  const auto found = number_of(where, "kidnap_found_s");
  const double down_s = input.kidnap->set_down_s;
  const std::string text = " Kidnapped at t = " + svg::number(input.kidnap->lifted_s, 1) +
                           " s, set down at t = " + svg::number(down_s, 1) + " s. From there on " +
                           (*wrong > 0.0 ? "it was CONVERGED on a wrong pose for up to " + svg::number(*wrong, 1) + " s"
                                         : "it gave no wrong answer");
  return text + (found ? ", and it was localized again at t = " + svg::number(down_s + *found, 1) + " s, " +
                             svg::number(*found, 1) + " s after it was set down."
                       : ", and it was not localized again for good.");
}

/// What a plan localization did; `where` is its block of numbers, may be null. Times are on the run's clock, as marks
/// have them; the block counts from the first scan.
std::string place_sentence(const std::string& verdict, const Tree* where, double start_s) {
  const auto time = number_of(where, "converged_at_s");
  const auto error = number_of(where, "ape_rmse_m");
  const auto places = number_of(where, "hypotheses");
  const bool is_marginal =
      where != nullptr && text_of(*where, "evidence") == score::to_string(score::Evidence::marginal);
  if (verdict == "honest_ambiguity" && places)
    return "Kept " + svg::number(*places, 0) + " hypotheses, rightly: " +
           (is_marginal ? "the scans favour one only marginally, which is not enough for an answer."
                        : "the scans do not distinguish them.");
  if (verdict == "overconfident")
    return std::string("Converged on one pose though ") +
           (is_marginal ? "the scans favour it only marginally" : "several explain the scans") + why_it_failed(where) +
           ".";
  if (!time) return "Never converged on one pose in the building" + why_it_failed(where) + ".";
  const std::string when = " at t = " + svg::number(start_s + *time, 1) + " s";
  if (verdict == "lucky") return "Converged on the right pose before the scans distinguished it from others.";
  const std::string failure = text_of(*where, "failure");
  const auto failed_at = number_of(where, "failure_at_s");
  const bool is_wrong = verdict == "false_convergence";
  if (failure == "tracking_lost" && failed_at)
    return "Converged on the right pose" + when + ", and lost it again at t = " + svg::number(*failed_at, 1) + " s" +
           (is_wrong ? " without saying so." : ".");
  if (is_wrong) return "Converged on a wrong pose" + why_it_failed(where) + ".";
  if (verdict == "lost" || (verdict == "late" && failure != "undecided"))
    return "Converged" + when + " and withdrew its answer" + why_it_failed(where) + ".";
  std::string text = "Converged on the right pose" + when;
  if (error) text += ", with an error of " + length(*error) + " from then on (rms)";
  return text + (verdict == "late" ? "; too late to count: an answer must hold for 5 s and 1 m." : ".");
}

/// Index of the storey on which the robot was at a time.
int true_storey(const ReportInput& input, double t_s) {
  const auto after = std::upper_bound(input.truth.begin(), input.truth.end(), t_s + 1e-6,
                                      [](double t, const ReportSample& sample) { return t < sample.t_s; });
  return after == input.truth.begin() ? -1 : (after - 1)->storey;
}

/// From when to when its answers were first farther off than an answer may be, in position or heading, how often again,
/// and on which wrong storey; or nothing. LOST is no answer. Of SLAM the heading counts as little as in its metrics.
std::string wrong_stretch(const ReportInput& input, const ReportMethod& method) {
  const score::LocalizationRules limits;
  const double limit_m = method.localization ? limits.position_m : score::TrajectoryRules().far_off_m;
  const ReportSample *first = nullptr, *last = nullptr, *astray = nullptr;
  constexpr double degrees = 180.0 / std::numbers::pi;
  double most_m = 0.0, most_deg = 0.0;
  int stretches = 0;
  double all_s = 0.0, before_s = 0.0;
  bool was_wrong = false;
  for (const ReportSample& sample : method.samples) {
    const double off_deg = degrees * std::abs(sample.yaw_error);
    const bool wrong = !sample.lost && (sample.error_m > limit_m || (method.localization && off_deg > limits.yaw_deg));
    if (wrong && !was_wrong && ++stretches == 1) first = &sample;
    if (wrong && stretches == 1) last = &sample;
    if (wrong && was_wrong) all_s += sample.t_s - before_s;
    before_s = sample.t_s;
    was_wrong = wrong;
    if (!wrong) continue;
    most_m = std::max(most_m, sample.error_m);
    most_deg = std::max(most_deg, off_deg);
    const int storey = true_storey(input, sample.t_s);
    if (astray == nullptr && storey >= 0 && storey != sample.storey) astray = &sample;
  }
  if (first == nullptr) return "";
  const bool to_the_end =
      last == &method.samples.back() && !input.truth.empty() && input.truth.back().t_s - last->t_s <= path_gap_s;
  const bool in_position = most_m > limit_m, in_heading = method.localization && most_deg > limits.yaw_deg;
  const auto listed = [&](const std::string& position, const std::string& word, const std::string& heading) {
    return (in_position ? position : "") + (in_position && in_heading ? word : "") + (in_heading ? heading : "");
  };
  std::string text = " More than " +
                     listed(svg::number(limit_m, 1) + " m", " or ", svg::number(limits.yaw_deg, 0) + "°") +
                     " off from t = " + svg::number(first->t_s, 1) + " s " +
                     (to_the_end ? "to the end" : "to t = " + svg::number(last->t_s, 1) + " s");
  if (stretches > 1)
    text += (stretches == 2 ? " and once more, " : " and " + std::to_string(stretches - 1) + " times more, ") +
            svg::number(all_s, 1) + " s in all";
  text += ", at most " + listed(length(most_m), " and ", svg::number(most_deg, 0) + "°") + ".";
  if (astray == nullptr) return text;
  const auto name = [&](int storey) { return input.plan.storeys[static_cast<std::size_t>(storey)].name; };
  return text + " At t = " + svg::number(astray->t_s, 1) + " s it was on storey " + name(astray->storey) +
         ", the robot on " + name(true_storey(input, astray->t_s)) + ".";
}

/// The slip of the feet right before it failed, or nothing.
std::string after_slip(const ReportMethod& method) {
  if (!method.slip || !method.failed_s) return "";
  return " The feet slipped from t = " + svg::number(method.slip->from_s, 1) + " s to " +
         svg::number(method.slip->to_s, 1) + " s; it first failed at t = " + svg::number(*method.failed_s, 1) + " s.";
}

/// What happened, in a sentence or two.
std::string sentence(const ReportInput& input, const ReportMethod& method, const Tree* results) {
  const std::string verdict = results == nullptr ? "" : text_of(*results, "verdict");
  if (verdict == "crashed") {
    const std::string error = text_of(*results, "error");
    return "The method stopped with an error" + (error.empty() ? "." : ": " + error);
  }
  if (method.localization) {
    const Tree* where = results == nullptr ? nullptr : results->find("localization");
    const bool by_furniture = where != nullptr && where->find("evidence_by_furniture") != nullptr;
    return place_sentence(verdict, where, start_s(input)) +
           (input.kidnap ? after_kidnap(input, where) : wrong_stretch(input, method)) +
           (by_furniture ? " Only furniture tells these apart." : "");
  }
  const auto error = number_of(results, "ate_aligned_rmse_m");
  if (!error) return "No trajectory that could be scored.";
  std::string text = "Position error " + length(*error) + " rms after alignment";
  const Tree* rooms = results->find("rooms");
  const auto visited = number_of(rooms, "visited");
  const auto recall = number_of(rooms, "recall");
  if (visited && recall)
    text += "; recognised " + svg::number(*recall * *visited, 0) + " of the " + svg::number(*visited, 0) +
            " rooms it was in";
  const auto found = number_of(rooms, "found"), matched = number_of(rooms, "matched");
  if (found && matched && *found > *matched)
    text += "; " + svg::number(*found - *matched, 0) + " that it claims match none";
  const std::string wrong = wrong_stretch(input, method);
  const auto is_lost = [](const ReportSample& sample) { return sample.lost; };
  const auto lost = std::count_if(method.samples.begin(), method.samples.end(), is_lost);
  text += "." + wrong;
  if (lost > 0)
    text += " It reported LOST at " + std::to_string(lost) + " of " + std::to_string(method.samples.size()) +
            " scans, first at t = " +
            svg::number(std::find_if(method.samples.begin(), method.samples.end(), is_lost)->t_s, 1) + " s" +
            (wrong.empty() ? "." : "; these do not count here.");
  return text;
}

}  // namespace

GateCount gates_of(const Tree& results, const std::string& method) {
  GateCount count;
  const Tree* gates = results.find("gates");
  if (gates == nullptr) return count;
  for (const Tree& gate : gates->as_list()) {
    if (!method.empty() && text_of(gate, "method") != method) continue;
    ++count.all;
    if (gate.find("passed")->as_bool()) ++count.passed;
  }
  return count;
}

std::vector<Unjudged> unjudged(const Tree& results) {
  std::vector<Unjudged> found;
  const Tree* methods = results.find("methods");
  if (methods == nullptr) return found;
  for (const auto& [name, block] : methods->as_map()) {
    const std::string verdict = text_of(block, "verdict");
    if (name == "truth") continue;
    const auto error = far_off(results, name, &block);
    if (verdict == "complete" && error)
      found.push_back({name, "off by " + length(*error) + " rms"});
    else if (gates_of(results, name).all == 0 && judged(results, name, &block) == "bad")
      found.push_back({name, verdict});
    else if (never_found_again(block.find("localization")) && !is_gated(results, name, "localization.kidnap_found_s"))
      found.push_back({name, number_of(block.find("localization"), "converged_at_s")
                                 ? "not localized again after the kidnapping"
                                 : "not localized after the kidnapping either"});
  }
  return found;
}

std::string method_cards(const ReportInput& input) {
  std::string out;
  for (std::size_t i = 0; i < input.methods.size(); ++i) {
    const ReportMethod& method = input.methods[i];
    if (is_truth(method)) continue;
    const Tree* results = results_of(input, method.name);
    const std::string verdict = results == nullptr ? "" : text_of(*results, "verdict");
    const std::string name = svg::escape(method.name);
    out += "<div class=\"method\" style=\"border-color:" + method_ink(method.ink) +
           "\"><h3><label><input type=\"checkbox\" checked data-layer=\"" + name + "\"> " + name +
           "</label> <button type=\"button\" class=\"only\" data-only=\"" + name +
           "\">only</button> <span class=\"verdict " + judged(input.results, method.name, results) + "\">" +
           svg::escape(verdict) + "</span></h3><p>" +
           svg::escape(sentence(input, method, results) + after_slip(method)) + "</p><p>" +
           gates_sentence(input, method.name) + "</p><p id=\"now-" + name + "\"></p></div>";
  }
  return out;
}

}  // namespace plumbline::scenarios
