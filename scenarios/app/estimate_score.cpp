// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/estimate_score.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "bim/config/printable.h"
#include "bim/config/tree.h"
#include "bim/errors.h"
#include "bim/median.h"
#include "scenarios/app/estimate_reference.h"
#include "scenarios/app/page_attempt.h"
#include "scenarios/app/plan_frame_score.h"
#include "scenarios/host/files.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/host/manifest.h"
#include "scenarios/host/terminal.h"
#include "scenarios/metrics/metrics.h"
#include "scenarios/metrics/reference_axes.h"
#include "scenarios/metrics/reference_score.h"
#include "scenarios/metrics/silence.h"
#include "scenarios/metrics/trajectory.h"
#include "scenarios/report/estimate/estimate_page.h"
#include "scenarios/report/estimate/page_file.h"
#include "scenarios/report/svg.h"
#include "scenarios/run/run_files.h"
#include "slam/io/recordings/tum.h"

namespace plumbline::scenarios {

namespace {

using Poses = std::vector<slam::StampedPose>;

/// Of one trajectory of an estimate.
struct TrajectoryScores {
  score::PathScore path;
  std::optional<score::ReferenceScore> reference;
};

std::string span_of(const Poses& poses) {
  return slam::format_stamp(poses.front().stamp) + " to " + slam::format_stamp(poses.back().stamp) + " s";
}

TrajectoryScores score_one(const Poses& poses, const Poses& reference, const std::string& file) {
  TrajectoryScores scores{score::score_path(poses), {}};
  if (reference.empty() || poses.empty()) return scores;
  scores.reference = score::score_by_reference(reference, poses);
  if (!scores.reference)
    throw InputError({file, 0, 0}, "has fewer than " + std::to_string(score::ReferenceRules().least_matched) +
                                       " poses at times of the estimate; it is of " + span_of(reference) +
                                       ", the estimate of " + span_of(poses));
  return scores;
}

/// Turns the axes of a reference to the robot's where they are another body's, and says what was done; empty: nothing.
std::string turn_to_robot(const Poses& poses, Poses& reference, Tree& tree) {
  if (reference.empty()) return {};
  auto turned = score::turned_to_robot(reference, poses);
  if (!turned) return {};
  reference = std::move(turned->reference_W);
  const double degrees = turned->turned_rad * 180.0 / std::numbers::pi;
  tree.set("reference_turned_deg", degrees);
  return "the reference's axes are turned by " + std::to_string(std::lround(degrees)) +
         " degrees against the robot's, and are turned back";
}

Tree to_json(const TrajectoryScores& scores) {
  const score::PathScore& path = scores.path;
  Tree tree = Tree::map();
  tree.set("poses", static_cast<std::int64_t>(path.poses)).set("duration_s", path.duration_s);
  tree.set("length_m", path.length_m).set("vertical_m", path.vertical_m);
  if (path.straightness) tree.set("straightness", *path.straightness);
  if (!scores.reference) return tree;
  const score::ReferenceScore& by = *scores.reference;
  tree.set("matched", static_cast<std::int64_t>(by.matched)).set("ate_aligned_rmse_m", by.ate_aligned_rmse_m);
  if (by.steps) {
    tree.set("step_error_median_m", by.steps->median_m).set("step_error_max_m", by.steps->max_m);
    tree.set("step_rotation_median_deg", by.steps->rotation_median_deg);
    tree.set("step_rotation_max_deg", by.steps->rotation_max_deg);
  }
  if (by.rpe_1m_rmse_m) tree.set("rpe_1m_rmse_m", *by.rpe_1m_rmse_m);
  if (by.rpe_1m_rotation_deg) tree.set("rpe_1m_rotation_deg", *by.rpe_1m_rotation_deg);
  return tree;
}

Tree to_json(const score::Silence& silence) {
  Tree tree = Tree::map();
  tree.set("silent_s", silence.silent_s);
  if (silence.off_at_s) tree.set("off_at_s", *silence.off_at_s);
  if (silence.said_after_s) tree.set("said_after_s", *silence.said_after_s);
  return tree;
}

std::string cell(const std::optional<double>& value, int decimals) {
  char text[32];
  if (!value) return "        -";
  std::snprintf(text, sizeof(text), "%9.*f", decimals, *value);
  return text;
}

std::string line_of(const char* name, const TrajectoryScores& scores) {
  char head[64];
  std::snprintf(head, sizeof(head), "%-8s%7zu", name, scores.path.poses);
  std::string text =
      head + cell(scores.path.length_m, 2) + cell(scores.path.straightness, 3) + cell(scores.path.vertical_m, 2);
  if (!scores.reference) return text + "\n";
  const score::ReferenceScore& by = *scores.reference;
  text += cell(static_cast<double>(by.matched), 0) + cell(by.ate_aligned_rmse_m, 3);
  for (const auto error : {&score::StepErrors::median_m, &score::StepErrors::max_m,
                           &score::StepErrors::rotation_median_deg, &score::StepErrors::rotation_max_deg})
    text += cell(by.steps ? std::optional((*by.steps).*error) : std::nullopt, 3);
  return text + cell(by.rpe_1m_rmse_m, 3) + cell(by.rpe_1m_rotation_deg, 3) + "\n";
}

/// Of a method whose error was more than a metre.
std::string words_of(const score::Silence& silence) {
  std::string text = "off by more than a metre after " + svg::number(*silence.off_at_s, 1) + " s, ";
  if (!silence.said_after_s) return text + "and never said so";
  return text + "said so " + svg::number(*silence.said_after_s, 1) + " s later; off and silent for " +
         svg::number(silence.silent_s, 1) + " s at a time";
}

/// What gates may name, whether this estimate has it or not.
const std::vector<std::string>& gate_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {"coverage", "lost_share", "degenerate_share", "silence.silent_s"};
    TrajectoryScores every;
    every.path.straightness = 1.0;
    every.reference.emplace().steps.emplace();
    every.reference->rpe_1m_rmse_m = every.reference->rpe_1m_rotation_deg = 0.0;
    const Tree tree = to_json(every);
    for (const auto& [key, value] : std::get<Tree::Map>(tree.value)) {
      all.push_back(key);
      all.push_back("final." + key);
    }
    for (const score::MetricRow& row : score::metrics())
      if (row.name.starts_with("localization.")) all.emplace_back(row.name);
    return all;
  }();
  return names;
}

std::optional<double> value_at(const Tree& scores, const std::string& name) {
  const std::size_t dot = name.find('.');
  const Tree* at = scores.find(name.substr(0, dot));
  if (at != nullptr && dot != std::string::npos) at = at->find(name.substr(dot + 1));
  if (at == nullptr && dot == std::string::npos) at = scores.find("causal")->find(name);
  return at == nullptr ? std::nullopt : std::optional(at->as_double());
}

void check_names(const std::vector<GateSpec>& gates) {
  for (const GateSpec& gate : gates) {
    const auto& known = gate_names();
    if (std::find(known.begin(), known.end(), gate.metric) != known.end()) continue;
    const std::string close = did_you_mean(gate.metric, known);
    throw InputError({"--gate", 0, 0},
                     "an estimate alone has no '" + gate.metric + "'" +
                         (close.empty() ? "; score.json names what it has" : "; did you mean '" + close + "'?"));
  }
}

/// How much of the walk a trajectory and the reference are of.
struct Covered {
  std::size_t poses = 0, scans = 0;       ///< scans 0: not known
  std::optional<double> reference_share;  ///< of the poses, between the ends of the reference
  std::optional<double> judged_share;     ///< of the scans, in the plan's frame

  /// Why a gate fails whatever its value; empty: enough.
  [[nodiscard]] std::string too_little() const {
    constexpr double least = score::TrajectoryRules().min_coverage;
    if (static_cast<double>(poses) < least * static_cast<double>(scans)) return words_of_poses();
    return reference_share && *reference_share < least ? words_of_reference() : "";
  }
  /// The same of a gate on what is judged in the plan's frame.
  [[nodiscard]] std::string too_little_judged() const {
    constexpr double least = score::TrajectoryRules().min_coverage;
    if (!judged_share || *judged_share >= least) return {};
    return "the reference covers " + std::to_string(std::lround(100.0 * *judged_share)) + " % of the scans";
  }
  [[nodiscard]] std::string words_of_poses() const {
    return std::to_string(poses) + " of " + std::to_string(scans) + " scans have a pose";
  }
  [[nodiscard]] std::string words_of_reference() const {
    return "the reference covers " + std::to_string(std::lround(100.0 * *reference_share)) + " % of the estimate";
  }
};

Covered covered(const Poses& poses, int scans, const Poses& reference) {
  Covered covered{poses.size(), static_cast<std::size_t>(std::max(scans, 0)), {}, {}};
  if (reference.empty() || poses.empty()) return covered;
  // The reference may begin and end between two poses; where a method was silent is no step.
  std::vector<slam::Nanoseconds> steps;
  for (std::size_t i = 1; i < poses.size(); ++i) steps.push_back(poses[i].stamp - poses[i - 1].stamp);
  const slam::Nanoseconds step = steps.empty() ? 0 : upper_median(steps);
  const auto within = std::count_if(poses.begin(), poses.end(), [&](const slam::StampedPose& pose) {
    return pose.stamp >= reference.front().stamp - step && pose.stamp <= reference.back().stamp + step;
  });
  covered.reference_share = static_cast<double>(within) / static_cast<double>(poses.size());
  return covered;
}

/// Why a gate fails whatever its value is. What a method says of itself is judged however little it covers; its silence
/// is not, which is measured where it has a pose.
std::string but(const GateSpec& gate, const Covered& causal, const Covered& last) {
  for (const char* name : {"coverage", "lost_share", "degenerate_share", "poses", "final.poses"})
    if (gate.metric == name) return {};
  if (gate.metric.starts_with("localization.")) return causal.too_little_judged();
  return (gate.metric.starts_with("final.") ? last : causal).too_little();
}

/// Judges them, adds them to the scores, and says so in words; their number that failed.
int judge(const std::vector<GateSpec>& gates, const std::string& method, const Covered& causal, const Covered& last,
          Tree& scores, std::string& text) {
  int failed = 0;
  Tree list = Tree::list();
  for (const GateSpec& gate : gates) {
    const score::GateResult result =
        score::judge_gate(gate, method, value_at(scores, gate.metric), but(gate, causal, last));
    failed += result.passed ? 0 : 1;
    text += (result.passed ? "passed: " : "FAILED: ") + score::describe(result) + "\n";
    list.push(score::to_results(result));
  }
  if (!gates.empty()) scores.set("gates", std::move(list));
  return failed;
}

/// What is known of an estimate, and by a reference where there is one.
struct ScoredEstimate {
  Poses reference;   ///< as it was compared
  std::string axes;  ///< what is to say of its axes
  TrajectoryScores causal, last;
  Covered causal_covered, last_covered;
  std::optional<score::Silence> silence;
  std::optional<PlanFrameScore> in_plan_frame;
  Tree numbers = Tree::map();  ///< score.json
  std::string judged;          ///< its gates, in words
  int failed = 0;
};

MethodRecord read_scorable(const std::string& dir) {
  const std::vector<std::string> methods = estimates_in(dir);
  if (methods.size() != 1) throw InputError({dir, 0, 0}, "holds no single estimate; make it again");
  MethodRecord method = read_method(dir, methods.front());
  if (method.crashed) throw InputError({dir, 0, 0}, "is of a method that crashed: " + method.error);
  if (method.causal.empty()) throw InputError({dir, 0, 0}, "holds no pose; the method gave none");
  return method;
}

/// Fills in all but the numbers and the gates; sets in the numbers what was done to the reference.
void compare(const MethodRecord& method, const ReferenceSource& source, ScoredEstimate& scored) {
  if (source.in_plan_frame && !method.localization)
    throw InputError({"--reference", 0, 0}, "'frame=W' is of a localization in a plan; " + method.name + " is none");
  Poses& reference = scored.reference;
  if (!source.file.empty()) reference = read_reference(source, method.causal);
  const bool positions_alone = !reference.empty() && score::is_without_orientation(reference, method.causal);
  scored.axes = positions_alone ? std::string(score::positions_alone_words)
                                : turn_to_robot(method.causal, reference, scored.numbers);
  scored.causal = score_one(method.causal, reference, source.file);
  scored.last = score_one(method.estimate.trajectory, reference, source.file);
  if (positions_alone)
    for (TrajectoryScores* scores : {&scored.causal, &scored.last})
      if (scores->reference) scores->reference->drop_motion();
  scored.causal_covered = covered(method.causal, method.scans, reference);
  scored.last_covered = covered(method.estimate.trajectory, method.scans, reference);
  if (method.scans > 0 && !positions_alone)
    scored.silence = score::score_silence(reference, method.causal, method.lost);
  if (!source.in_plan_frame) return;
  scored.in_plan_frame = score_in_plan_frame(method, reference, positions_alone, source.file);
  scored.causal_covered.judged_share = scored.in_plan_frame->judged_share;
}

/// unchecked: files that were altered, of the estimate and of its recording.
void set_numbers(const MethodRecord& method, const std::vector<std::string>& unchecked, ScoredEstimate& scored) {
  Tree& tree = scored.numbers;
  Tree names = Tree::list();
  for (const std::string& name : unchecked) names.push(name);
  if (!unchecked.empty()) tree.set("unchecked", std::move(names));
  if (method.scans > 0)
    tree.set("scans", method.scans)
        .set("coverage", static_cast<double>(method.causal.size()) / method.scans)
        .set("lost_share", 1.0 * method.lost_scans / method.scans)
        .set("degenerate_share", 1.0 * method.degenerate_scans / method.scans);
  if (!scored.reference.empty())
    tree.set("reference", Tree::map()
                              .set("poses", static_cast<std::int64_t>(scored.reference.size()))
                              .set("length_m", score::score_path(scored.reference).length_m)
                              .set("share", *scored.causal_covered.reference_share));
  if (scored.silence) tree.set("silence", to_json(*scored.silence));
  if (const auto& in_plan = scored.in_plan_frame) {
    const Tree results = score::to_results(in_plan->score);
    tree.set("verdict", in_plan->score.verdict).set("judged_share", in_plan->judged_share);
    tree.set("localization", *results.find("localization"));
  }
  tree.set("causal", to_json(scored.causal));
  if (scored.last.path.poses > 0) tree.set("final", to_json(scored.last));
}

/// All that score leaves, nothing of it before all is on the disk. Returns whether it has a page.
bool write_score(const std::string& dir, const ScoredEstimate& scored, const std::vector<std::string>& altered) {
  const NewScore fresh{write_json(scored.numbers) + "\n",
                       scored.reference.empty() ? std::string() : slam::write_tum(scored.reference)};
  std::optional<std::string> page, reference;
  const bool has_page = attempt_page(dir, dir, [&] { page = estimate_page(dir, altered, fresh); });
  if (!fresh.reference.empty()) reference = fresh.reference;
  catch_interrupts();  // which nothing looks at: the files appear together
  replace_files(dir, {{std::string(scores_name), fresh.scores},
                      {std::string(reference_name), std::move(reference)},
                      {std::string(estimate_page_name), std::move(page)}});
  return has_page;
}

std::string words_of(const MethodRecord& method, const ScoredEstimate& scored) {
  const Covered& covered = scored.causal_covered;
  std::string text = method.name;
  if (method.scans > 0)
    text += ": LOST at " + std::to_string(method.lost_scans) + " of " + std::to_string(method.scans) + " scans";
  if (covered.poses < covered.scans) text += "; " + covered.words_of_poses();
  if (!scored.reference.empty()) text += "; reference: " + std::to_string(scored.reference.size()) + " poses";
  if (covered.reference_share.value_or(1.0) < 1.0) text += "; " + covered.words_of_reference();
  if (!scored.axes.empty()) text += "\n" + scored.axes;
  if (scored.in_plan_frame) text += "\n" + words_of(*scored.in_plan_frame);
  if (scored.silence && scored.silence->off_at_s) text += "\n" + words_of(*scored.silence);
  text += "\n          poses   path m straight   vert. m";
  if (!scored.reference.empty()) text += "  matched    ATE m   step m    max m step deg  max deg    RPE/m    deg/m";
  text += "\n" + line_of("causal", scored.causal);
  return scored.last.path.poses > 0 ? text + line_of("final", scored.last) : text;
}

}  // namespace

bool is_estimate_directory(const std::string& dir) {
  namespace fs = std::filesystem;
  return fs::exists(dir + "/estimate.yaml") && !fs::exists(dir + "/scenario.yaml");
}

std::vector<std::string> unchecked_by_estimate(const std::string& dir) {
  const std::string path = dir + "/estimate.yaml";
  std::vector<std::string> names;
  if (!std::filesystem::exists(path)) return names;
  const Tree tree = read_yaml(read_text_file(path), path);
  const Tree* list = tree.is_map() ? tree.find("unchecked") : nullptr;
  if (list == nullptr || !list->is_list()) return names;
  for (const Tree& name : list->as_list()) names.push_back(name.as_string());
  return names;
}

int score_estimate(const std::string& dir, const std::string& reference_text, const std::vector<GateSpec>& gates,
                   bool unchecked) {
  check_names(gates);
  remove_abandoned(dir);
  const std::vector<std::string> altered = altered_files(dir, {derived_files(), true, DirectoryKind::estimate});
  refuse_altered(dir, altered, unchecked);
  const MethodRecord method = read_scorable(dir);
  ScoredEstimate scored;
  scored.numbers.set("plumbline", PLUMBLINE_VERSION).set("method", method.name);
  compare(method, reference_source(reference_text), scored);
  std::vector<std::string> taken = altered;
  for (const std::string& name : unchecked_by_estimate(dir)) taken.push_back("recording/" + name);
  set_numbers(method, taken, scored);
  scored.failed = judge(gates, method.name, scored.causal_covered, scored.last_covered, scored.numbers, scored.judged);
  const bool has_page = write_score(dir, scored, altered);
  const std::string start = printable(dir) + "/";
  print(words_of(method, scored) + "scores: " + start + std::string(scores_name) +
        (has_page ? "\nreport: " + start + std::string(estimate_page_name) : "") + "\n" + scored.judged);
  return scored.failed == 0 ? 0 : 1;
}

}  // namespace plumbline::scenarios
