// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/estimate_builder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "bim/median.h"
#include "scenarios/host/files.h"
#include "scenarios/metrics/reference_score.h"
#include "scenarios/metrics/storey.h"
#include "scenarios/report/belief.h"
#include "scenarios/report/belief_builder.h"
#include "scenarios/report/estimate/answer_sentence.h"
#include "scenarios/report/estimate/map_points.h"
#include "scenarios/report/estimate/plan_drawing.h"
#include "scenarios/report/estimate/reference_errors.h"
#include "scenarios/report/hypothesis_history.h"
#include "scenarios/report/results.h"
#include "scenarios/report/svg.h"
#include "scenarios/run/run_files.h"
#include "slam/io/recordings/tum.h"

namespace plumbline::scenarios {

namespace {

constexpr std::size_t most_samples = 5000;  // of a path as drawn

/// The files of an estimate.
struct EstimateFiles {
  MethodRecord method;
  EstimateFacts facts;
  std::vector<slam::Nanoseconds> scans;  ///< on the recording's clock
  std::optional<PlanDrawing> plan;
  Tree scores;  ///< score.json; null where there is none
  std::vector<slam::StampedPose> reference;
};

std::string text_of_file(const std::string& path) {
  std::error_code error;
  return std::filesystem::exists(path, error) ? read_text_file(path) : std::string();
}

/// Stamps of the scans by the digests that each left; without them, of the answers.
std::vector<slam::Nanoseconds> scan_stamps(const DigestLog& digests, const MethodRecord& method,
                                           slam::Nanoseconds origin) {
  std::set<slam::Nanoseconds> stamps;
  for (const DigestEntry& entry : digests) stamps.insert(entry.tick + origin);
  if (stamps.empty()) {
    for (const slam::StampedPose& pose : method.causal) stamps.insert(pose.stamp);
    for (const BeliefRecord& belief : method.beliefs) stamps.insert(belief.stamp);
  }
  return {stamps.begin(), stamps.end()};
}

EstimateFiles read_estimate_files(const std::string& dir) {
  const std::vector<std::string> methods = estimates_in(dir);
  if (methods.size() != 1) throw InputError({dir, 0, 0}, "holds no single estimate; make it again");
  EstimateFiles files;
  files.method = read_method(dir, methods.front());
  const std::string yaml = dir + "/estimate.yaml", digests = dir + "/digests.csv";
  files.facts = estimate_facts(read_yaml(read_text_file(yaml), yaml));
  files.scans = scan_stamps(read_digests(read_text_file(digests), digests), files.method, files.facts.origin);
  const std::string plan = dir + "/" + std::string(plan_drawing_name),
                    reference = dir + "/" + std::string(reference_name);
  if (const std::string text = text_of_file(plan); !text.empty()) files.plan = read_plan_drawing(text, plan);
  const std::string scores = dir + "/score.json";
  if (const std::string text = text_of_file(scores); !text.empty()) files.scores = read_json(text, scores);
  if (const std::string text = text_of_file(reference); !text.empty())
    files.reference = slam::read_tum(text, reference);
  return files;
}

/// Paths of fast or slow sensors stay whole: what several usual steps do not reach is a jump.
PathBreaks breaks_of(const std::vector<ReportSample>& samples, double interval_s) {
  constexpr double of_usual = 5.0;
  std::vector<double> steps_m;
  for (std::size_t i = 1; i < samples.size(); ++i)
    steps_m.push_back(std::hypot(samples[i].x - samples[i - 1].x, samples[i].y - samples[i - 1].y));
  PathBreaks breaks;
  breaks.gap_s = std::max(breaks.gap_s, of_usual * interval_s);
  if (!steps_m.empty()) breaks.jump_m = std::max(breaks.jump_m, of_usual * upper_median(steps_m));
  return breaks;
}

std::vector<ReportSample> samples_of_path(const std::vector<slam::StampedPose>& poses, const EstimateFiles& files,
                                          const std::vector<bim::PlanStorey>& storeys) {
  std::vector<ReportSample> samples;
  for (const slam::StampedPose& pose : poses) {
    const Pose& X_FR = pose.X_FR;
    ReportSample& sample = samples.emplace_back();
    sample.t_s = slam::seconds(pose.stamp - files.scans.front());
    sample.x = X_FR.t.x();
    sample.y = X_FR.t.y();
    sample.yaw = X_FR.yaw();
    sample.storey = score::storey_of_base(storeys, X_FR.t.z());
    sample.lost = said_lost(files.method, pose.stamp);
    sample.judged = false;
  }
  return samples;
}

/// The storey of the path at a time.
int storey_at(const std::vector<ReportSample>& samples, double t_s) {
  const auto next = std::lower_bound(samples.begin(), samples.end(), t_s,
                                     [](const ReportSample& sample, double t) { return sample.t_s < t; });
  return next == samples.end() ? samples.back().storey : next->storey;
}

/// One in `every`, and the last one.
std::vector<ReportSample> thinned_samples(const std::vector<ReportSample>& samples, std::size_t every) {
  std::vector<ReportSample> kept;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (i % every == 0 || i + 1 == samples.size()) kept.push_back(samples[i]);
  return kept;
}

/// The path after the last optimisation, where it is another one than that first given.
std::vector<ReportSample> corrected_path(const EstimateFiles& files, const std::vector<bim::PlanStorey>& storeys,
                                         std::size_t every) {
  constexpr double least_m = 0.05;  // a line's width
  const std::vector<slam::StampedPose>&given = files.method.causal, &corrected = files.method.estimate.trajectory;
  bool differs = corrected.size() != given.size();
  for (std::size_t i = 0; !differs && i < given.size(); ++i)
    differs = (given[i].X_FR.t - corrected[i].X_FR.t).norm() > least_m;
  if (!differs) return {};
  std::vector<ReportSample> samples = samples_of_path(corrected, files, storeys);
  for (ReportSample& sample : samples) sample.lost = false;
  return thinned_samples(samples, every);
}

void add_found(const slam::Estimate& estimate, const std::vector<bim::PlanStorey>& storeys, ReportMethod& shown) {
  for (const slam::PlaneNode& plane : estimate.planes)
    shown.walls.push_back({plane.p0, plane.p1, score::storey_of_height(storeys, 0.5 * (plane.z0 + plane.z1))});
  for (const slam::RoomNode& node : estimate.rooms) {
    ReportRoom& room = shown.rooms.emplace_back();
    room.polygon_W = node.polygon_F;
    room.matched = true;
    room.storey = score::storey_of_height(storeys, score::height_of_room(estimate, node).value_or(0.0));
  }
}

/// The heaviest hypothesis, or nothing.
const slam::Hypothesis* heaviest(const BeliefRecord& belief) {
  const auto most = std::max_element(belief.hypotheses.begin(), belief.hypotheses.end(),
                                     [](const auto& a, const auto& b) { return a.mass < b.mass; });
  return most == belief.hypotheses.end() ? nullptr : &*most;
}

/// Where the heaviest hypothesis is, at a time or next after it.
ReportPlace believed_place(const MethodRecord& method, const std::vector<bim::PlanStorey>& storeys,
                           slam::Nanoseconds stamp) {
  auto at = std::lower_bound(method.beliefs.begin(), method.beliefs.end(), stamp,
                             [](const BeliefRecord& belief, slam::Nanoseconds t) { return belief.stamp < t; });
  for (; at != method.beliefs.end(); ++at)
    if (const slam::Hypothesis* most = heaviest(*at))
      return {most->X_WR.t.head<2>(), score::storey_of_base(storeys, most->X_WR.t.z())};
  return {};
}

/// Hypotheses of a localization, none of which is known to be the right one.
void add_localization(const EstimateFiles& files, const bim::Plan& plan, ReportMethod& shown) {
  constexpr std::size_t shown_places = 6;  // curves that stay apart
  const MethodRecord& method = files.method;
  BeliefContext context;
  context.origin = files.scans.front();
  context.place = [&](slam::Nanoseconds stamp) { return believed_place(method, plan.storeys, stamp); };
  add_beliefs(method, context, shown);
  add_matched_walls(method, plan, context, shown);
  score::Truth motion;
  motion.poses_W = method.estimate.trajectory;
  if (motion.poses_W.empty()) motion.poses_W.push_back({files.scans.front(), Pose()});
  HypothesisHistories histories = hypothesis_histories(method.beliefs, motion, shown_places, false);
  shown.hypotheses_left_out = histories.left_out;
  const double origin_s = slam::seconds(files.scans.front());
  const auto since_first = [&](std::vector<Eigen::Vector2d>& points) {
    for (Eigen::Vector2d& p : points) p.x() -= origin_s;
  };
  for (HypothesisHistory& history : histories.shown) since_first(history.points);
  since_first(histories.others);
  shown.histories = std::move(histories.shown);
  shown.other_hypotheses = std::move(histories.others);
}

/// Storeys that the method was on or may be on at the end, from the lowest up.
std::vector<ReportStorey> shown_storeys(const EstimateFiles& files, const bim::Plan& plan,
                                        const std::vector<ReportSample>& samples) {
  std::set<int> on;
  for (const ReportSample& sample : samples) on.insert(sample.storey);
  if (!files.method.beliefs.empty())
    for (const slam::Hypothesis& hypothesis : files.method.beliefs.back().hypotheses)
      on.insert(score::storey_of_base(plan.storeys, hypothesis.X_WR.t.z()));
  if (on.empty()) on.insert(0);
  std::vector<ReportStorey> storeys;
  for (const int index : on) {
    ReportStorey& storey = storeys.emplace_back();
    storey.index = index;
    storey.name = plan.storeys[static_cast<std::size_t>(index)].name;
  }
  const auto height = [&](const ReportStorey& storey) {
    return plan.storeys[static_cast<std::size_t>(storey.index)].elevation_m;
  };
  std::stable_sort(storeys.begin(), storeys.end(),
                   [&](const ReportStorey& a, const ReportStorey& b) { return height(a) < height(b); });
  return storeys;
}

/// The points of the map under each storey's plan, those that lie on it.
void lay_map(const std::vector<Eigen::Vector3f>& map_F, ReportInput& input) {
  if (map_F.empty()) return;
  MapBox box = bounds(input);
  if (!input.has_plan) {
    const MapBox of_points = box_of_points(map_F);
    box.add(of_points.min);
    box.add(of_points.max);
    input.extent = {box.min, box.max};
  }
  for (ReportStorey& storey : input.storeys) {
    std::vector<Eigen::Vector3f> here;
    for (const Eigen::Vector3f& p : map_F)
      if (input.storeys.size() == 1 || score::storey_of_height(input.plan.storeys, p.z()) == storey.index)
        here.push_back(p);
    storey.ground += draw_map_points(here, box, input.has_plan);
  }
}

Tree path_numbers(const std::vector<slam::StampedPose>& poses) {
  const score::PathScore path = score::score_path(poses);
  Tree tree = Tree::map();
  tree.set("poses", static_cast<std::int64_t>(path.poses)).set("duration_s", path.duration_s);
  tree.set("length_m", path.length_m).set("vertical_m", path.vertical_m);
  return path.straightness ? tree.set("straightness", *path.straightness) : tree;
}

/// Hypotheses at the end of a localization that has no single answer.
bool mark_hypotheses(const MethodRecord& method, ReportInput& input) {
  constexpr std::size_t most = 20;
  if (method.beliefs.empty() || method.beliefs.back().state == slam::State::converged) return false;
  std::vector<slam::Hypothesis> last = method.beliefs.back().hypotheses;
  std::stable_sort(last.begin(), last.end(), [](const auto& a, const auto& b) { return a.mass > b.mass; });
  last.resize(std::min(most, last.size()));
  for (ReportStorey& storey : input.storeys)
    for (const slam::Hypothesis& hypothesis : last)
      if (score::storey_of_base(input.plan.storeys, hypothesis.X_WR.t.z()) == storey.index)
        storey.ground += draw_hypothesis_mark(hypothesis.X_WR, hypothesis.mass);
  return !last.empty();
}

/// What results.json has of a run: gates, and every number of the method.
Tree results_by_score(const EstimateFiles& files) {
  const MethodRecord& method = files.method;
  Tree numbers = Tree::map(), results = Tree::map();
  if (files.scores.is_map()) {
    for (const auto& [key, value] : files.scores.as_map())
      if (key != "plumbline" && key != "method" && key != "gates") numbers.set(key, value);
    if (const Tree* gates = files.scores.find("gates")) results.set("gates", *gates);
  } else if (!method.causal.empty()) {
    numbers.set("causal", path_numbers(method.causal));
    if (!method.estimate.trajectory.empty()) numbers.set("final", path_numbers(method.estimate.trajectory));
  }
  return results.set("methods", Tree(Tree::Map{{method.name, std::move(numbers)}}));
}

/// Whether a method said so that was off by more than a metre; null or never off: nothing.
std::string silence_sentence(const Tree* silence) {
  const auto off = number_of(silence, "off_at_s"), said = number_of(silence, "said_after_s");
  if (!off) return "";
  return " Placed by its first pose it is off by more than a metre after " + svg::number(*off, 1) + " s" +
         (said ? ", and reported LOST " + svg::number(*said, 1) + " s later." : ", and never reported LOST.");
}

/// "By the reference: ..." or nothing.
std::string reference_sentence(const Tree& scores) {
  if (!scores.is_map() || scores.find("reference") == nullptr) return "";
  std::string text;
  const auto metres = [](double m) { return m < 1.0 ? svg::number(100.0 * m, 1) + " cm" : svg::number(m, 2) + " m"; };
  const Tree* localization = scores.find("localization");
  if (const std::string verdict = text_of(scores, "verdict"); !verdict.empty()) {
    text = "By the reference in the plan's frame: " + verdict;
    if (const auto error = number_of(localization, "ape_rmse_m"))
      text += ", position error " + metres(*error) + " rms from the convergence on";
    return text + ".";
  }
  const Tree* causal = scores.find("causal");
  const auto error = number_of(causal, "ate_aligned_rmse_m");
  if (!error) return "";
  text = "By the reference, aligned: position error " + metres(*error) + " rms";
  if (const auto over = number_of(causal, "rpe_1m_rmse_m")) text += ", " + metres(*over) + " over each metre";
  return text + "." + silence_sentence(scores.find("silence"));
}

}  // namespace

EstimatePage read_estimate_page(const std::string& dir) {
  EstimateFiles files = read_estimate_files(dir);
  const MethodRecord& method = files.method;
  EstimatePage page;
  ReportInput& input = page.input;
  input.has_plan = files.plan.has_value();
  input.truth_name = "reference";
  if (files.plan) {
    input.plan = files.plan->plan;
    input.obstacles = std::move(files.plan->obstacles);
    input.flights = std::move(files.plan->flights);
  } else {
    input.plan.storeys = {{}};
  }
  ReportMethod shown;
  shown.name = method.name;
  shown.localization = method.localization;
  shown.judged = false;
  shown.lost_drawn = true;
  if (files.scans.empty()) files.scans.push_back(0);
  page.spans = state_spans(method, files.scans);
  std::vector<ReportSample> samples = samples_of_path(method.causal, files, input.plan.storeys);
  const bool in_plan_frame = files.scores.is_map() && files.scores.find("verdict") != nullptr;
  input.truth =
      lay_reference(files.reference, method, in_plan_frame, {files.scans.front(), files.scans.back()}, samples);
  for (ReportSample& sample : input.truth) sample.storey = storey_at(samples, sample.t_s);
  page.thinned = samples.size() / most_samples + 1;
  shown.samples = thinned_samples(samples, page.thinned);
  shown.breaks = breaks_of(shown.samples, static_cast<double>(page.thinned) * usual_interval_s(files.scans));
  input.truth = thinned_samples(input.truth, input.truth.size() / most_samples + 1);
  shown.corrected = corrected_path(files, input.plan.storeys, page.thinned);
  add_found(method.estimate, input.plan.storeys, shown);
  if (method.localization) add_localization(files, input.plan, shown);
  for (const ReportState& state : shown.states)
    if (!shown.converged_s && state.state == slam::State::converged) shown.converged_s = state.t_s;
  input.storeys = shown_storeys(files, input.plan, shown.samples);
  input.results = results_by_score(files);
  input.methods.push_back(std::move(shown));
  lay_map(method.estimate.map_F, input);
  page.has_map = !method.estimate.map_F.empty();
  page.has_marks = mark_hypotheses(method, input);
  constexpr double marks_across = 60.0;
  const MapBox box = bounds(input);
  input.mark_scale = std::max(1.0, (box.max - box.min).norm() / marks_across);
  page.answer = answer_sentence(method, page.spans);
  page.state = final_state(method, page.spans);
  page.by_reference = reference_sentence(files.scores);
  page.pauses = scan_pauses(files.scans);
  page.first_scan = files.scans.front();
  for (const slam::Nanoseconds stamp : files.scans) page.scans_s.push_back(slam::seconds(stamp - files.scans.front()));
  page.facts = std::move(files.facts);
  return page;
}

std::vector<std::string> made_of_an_estimate() {
  return {std::string(estimate_page_name), "score.json", std::string(reference_name)};
}

void write_estimate_page(const std::string& dir, const std::vector<std::string>& altered) {
  EstimatePage page = read_estimate_page(dir);
  page.altered = altered;
  write_file(dir + "/" + std::string(estimate_page_name), render_estimate(page));
}

}  // namespace plumbline::scenarios
