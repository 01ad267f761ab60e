// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/estimate_files.h"

#include <filesystem>
#include <set>

#include "bim/errors.h"
#include "scenarios/host/files.h"
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

bool is_stamp(slam::Nanoseconds stamp) { return stamp > -slam::furthest_stamp && stamp < slam::furthest_stamp; }

/// Stamps of the scans by the digests that each left; without them, of the answers.
std::vector<slam::Nanoseconds> scan_stamps(const DigestLog& digests, const MethodRecord& method,
                                           slam::Nanoseconds origin, const std::string& file) {
  std::set<slam::Nanoseconds> stamps;
  for (const DigestEntry& entry : digests) {
    // Each is less than the furthest stamp, so that the sum fits.
    if (!is_stamp(entry.tick) || !is_stamp(entry.tick + origin))
      throw InputError({file, 0, 0}, "has a time of " + std::to_string(entry.tick) +
                                         " ns; with origin_ns of estimate.yaml it must be less than 4e18");
    stamps.insert(entry.tick + origin);
  }
  if (stamps.empty()) {
    for (const slam::StampedPose& pose : method.causal) stamps.insert(pose.stamp);
    for (const BeliefRecord& belief : method.beliefs) stamps.insert(belief.stamp);
  }
  return {stamps.begin(), stamps.end()};
}

/// Whether a method said so that was off by more than a metre; null or never off: nothing.
std::string silence_sentence(const Tree* silence) {
  const auto off = number_of(silence, "off_at_s"), said = number_of(silence, "said_after_s");
  if (!off) return "";
  return " Placed by its first pose it is off by more than a metre after " + svg::number(*off, 1) + " s" +
         (said ? ", and reported LOST " + svg::number(*said, 1) + " s later." : ", and never reported LOST.");
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
  return files;
}

std::string reference_sentence(const EstimateScores& by) {
  const Tree& scores = by.numbers;
  if (scores.find("reference") == nullptr) return "";
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

}  // namespace plumbline::scenarios
