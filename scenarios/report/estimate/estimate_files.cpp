// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/estimate_files.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "bim/errors.h"
#include "scenarios/host/files.h"
#include "scenarios/metrics/reference_axes.h"
#include "scenarios/report/estimate/estimate_page.h"
#include "scenarios/report/results.h"
#include "scenarios/report/svg.h"
#include "scenarios/run/run_files.h"
#include "slam/io/recordings/tum.h"
#include "slam/io/second.h"

namespace plumbline::scenarios {

namespace {

std::string text_of_file(const std::string& path) {
  std::error_code error;
  return std::filesystem::exists(path, error) ? read_text_file(path) : std::string();
}

using Stamps = std::vector<slam::Nanoseconds>;

bool is_stamp(slam::Nanoseconds stamp) { return stamp > -slam::furthest_stamp && stamp < slam::furthest_stamp; }

/// Of poses and beliefs, in order.
Stamps answer_stamps(const MethodRecord& method) {
  std::set<slam::Nanoseconds> stamps;
  for (const slam::StampedPose& pose : method.causal) stamps.insert(pose.stamp);
  for (const BeliefRecord& belief : method.beliefs) stamps.insert(belief.stamp);
  return {stamps.begin(), stamps.end()};
}

/// Whether each answer is of a tick.
bool are_of_ticks(const Stamps& answers, const Stamps& ticks, slam::Nanoseconds origin) {
  return std::all_of(answers.begin(), answers.end(), [&](slam::Nanoseconds stamp) {
    return std::binary_search(ticks.begin(), ticks.end(), stamp - origin);
  });
}

/// Time 0 of the ticks on the clock of the answers, where an earlier version has not written it: the first answer is of
/// one of the first scans. Nothing where the answers fit no ticks.
std::optional<slam::Nanoseconds> origin_by_answers(const Stamps& answers, const Stamps& ticks) {
  constexpr std::size_t most_tried = 1000;
  if (answers.empty() || are_of_ticks(answers, ticks, 0)) return 0;
  for (std::size_t i = 0; i < std::min(most_tried, ticks.size()); ++i) {
    const slam::Nanoseconds origin = answers.front() - ticks[i];
    const bool fits = is_stamp(origin) && is_stamp(ticks.front() + origin) && is_stamp(ticks.back() + origin);
    if (fits && are_of_ticks(answers, ticks, origin)) return origin;
  }
  // Of a method that answers between the scans.
  const bool around = !ticks.empty() && ticks.front() <= answers.front() && answers.back() <= ticks.back();
  return around ? std::optional<slam::Nanoseconds>(0) : std::nullopt;
}

/// Stamps of the scans by the digests that each left; without digests that fit them, of the answers. origin: 0 where it
/// is not known.
Stamps scan_stamps(const DigestLog& digests, const MethodRecord& method, slam::Nanoseconds origin,
                   const std::string& file) {
  std::set<slam::Nanoseconds> ticks;
  for (const DigestEntry& entry : digests) {
    // Each is less than the furthest stamp, so that the sum fits.
    if (!is_stamp(entry.tick) || !is_stamp(entry.tick + origin))
      throw InputError({file, 0, 0}, "has a time of " + std::to_string(entry.tick) +
                                         " ns; with origin_ns of estimate.yaml it must be less than 4e18");
    ticks.insert(entry.tick);
  }
  Stamps stamps(ticks.begin(), ticks.end()), answers = answer_stamps(method);
  const auto known = origin != 0 ? std::optional(origin) : origin_by_answers(answers, stamps);
  if (stamps.empty() || !known) return answers;
  for (slam::Nanoseconds& stamp : stamps) stamp += *known;
  return stamps;
}

/// Whether a method said so that was off by more than a metre; null or never off: nothing.
std::string silence_sentence(const Tree* silence) {
  const auto off = number_of(silence, "off_at_s"), said = number_of(silence, "said_after_s");
  if (!off) return "";
  return " Placed by its first pose it is off by more than a metre after " + svg::number(*off, 1) + " s" +
         (said ? ", and reported LOST " + svg::number(*said, 1) + " s later." : ", and never reported LOST.");
}

std::string unsaid_by_positions(bool positions_alone) {
  if (!positions_alone) return "";
  std::string words(score::positions_alone_words);
  words.front() = 'T';
  return " " + words + ".";
}

}  // namespace

EstimateFiles read_estimate_files(const std::string& dir, const std::optional<NewScore>& fresh) {
  const std::vector<std::string> methods = estimates_in(dir);
  if (methods.size() != 1) throw InputError({dir, 0, 0}, "holds no single estimate; make it again");
  EstimateFiles files;
  files.method = read_method(dir, methods.front());
  const std::string yaml = dir + "/estimate.yaml", digests = dir + "/digests.csv";
  files.facts = estimate_facts(read_yaml(read_text_file(yaml), yaml));
  files.scans = scan_stamps(read_digests(read_text_file(digests), digests), files.method, files.facts.origin, digests);
  const std::string plan = dir + "/" + std::string(plan_drawing_name), scores = dir + "/" + std::string(scores_name),
                    reference = dir + "/" + std::string(reference_name);
  if (const std::string text = text_of_file(plan); !text.empty()) files.plan = read_plan_drawing(text, plan);
  const NewScore score = fresh ? *fresh : NewScore{text_of_file(scores), text_of_file(reference)};
  if (!score.scores.empty()) files.scores = read_estimate_scores(score.scores, scores);
  if (!score.reference.empty()) files.reference = slam::read_tum(score.reference, reference);
  files.reference_kind.in_plan_frame = files.scores && files.scores->numbers.find("verdict") != nullptr;
  files.reference_kind.positions_alone = !files.reference.empty() && !files.method.causal.empty() &&
                                         score::is_without_orientation(files.reference, files.method.causal);
  return files;
}

std::string reference_sentence(const EstimateFiles& files) {
  if (!files.scores) return "";
  const Tree& scores = files.scores->numbers;
  const bool positions_alone = files.reference_kind.positions_alone;
  if (scores.find("reference") == nullptr) return "";
  std::string text;
  const auto metres = [](double m) { return m < 1.0 ? svg::number(100.0 * m, 1) + " cm" : svg::number(m, 2) + " m"; };
  const Tree* localization = scores.find("localization");
  if (const std::string verdict = text_of(scores, "verdict"); !verdict.empty()) {
    text = "By the reference in the plan's frame: " + verdict;
    if (const auto error = number_of(localization, "ape_rmse_m"))
      text += ", position error " + metres(*error) + " rms from the convergence on";
    return text + "." + unsaid_by_positions(positions_alone);
  }
  const Tree* causal = scores.find("causal");
  const auto error = number_of(causal, "ate_aligned_rmse_m");
  if (!error) return "";
  text = "By the reference, aligned: position error " + metres(*error) + " rms";
  if (const auto over = number_of(causal, "rpe_1m_rmse_m"); over) text += ", " + metres(*over) + " over each metre";
  const std::string of_place = files.method.localization
                                   ? " The reference is aligned to the estimate and cannot show a wrong place; one in "
                                     "the plan's frame, given with frame=W, can."
                                   : "";
  return text + "." + of_place + unsaid_by_positions(positions_alone) + silence_sentence(scores.find("silence"));
}

}  // namespace plumbline::scenarios
