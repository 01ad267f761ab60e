// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/estimate_facts.h"

#include <string_view>

#include "bim/errors.h"
#include "scenarios/report/results.h"
#include "slam/io/second.h"

namespace plumbline::scenarios {

namespace {

std::string fact_at(const Tree* tree, std::string_view key) {
  const Tree* value = tree == nullptr ? nullptr : tree->find(key);
  if (value == nullptr || value->is_null()) return "";
  const auto text = [](const Tree& scalar) {
    return std::holds_alternative<std::string>(scalar.value) ? scalar.as_string() : write_json(scalar, 0);
  };
  if (value->is_scalar()) return text(*value);
  std::string list;
  if (!value->is_list()) return list;
  for (const Tree& entry : value->as_list()) list += (list.empty() ? "" : ", ") + text(entry);
  return list;
}

std::string unscored(std::string text) {
  for (char& c : text)
    if (c == '_') c = ' ';
  return text;
}

/// "16 rings, points with times"
std::string points_text(const Tree* input) {
  if (input == nullptr) return "";
  const std::string rings = fact_at(input, "rings");
  return (rings.empty() || rings == "0" || rings == "1" ? "no rings" : rings + " rings") +
         (fact_at(input, "point_times") == "true" ? ", points with times" : ", points without times");
}

std::string mount_text(const std::string& mount) {
  if (mount == "unknown") return "not known: the robot's frame is the LiDAR's";
  if (mount == "description") return "from the description";
  if (mount == "same_frame") return "none needed: the points are in the robot's frame";
  return mount.empty() ? "" : "from /" + mount;
}

std::string height_text(const Tree* given) {
  const std::string height = fact_at(given, "lidar_height_m"), from = fact_at(given, "lidar_height_from");
  if (height.empty()) return "";
  const std::string why = from == "scans"     ? " (by the first scans that show it)"
                          : from == "assumed" ? " (assumed: no scan shows a floor)"
                                              : " (as described)";
  return height + " m above the floor" + why;
}

std::vector<std::string> sentences_of(const Tree& tree, std::string_view key) {
  std::vector<std::string> sentences;
  if (const Tree* list = tree.find(key))
    for (const Tree& sentence : list->as_list()) sentences.push_back(sentence.as_string());
  return sentences;
}

/// What was left out of the recording on purpose.
std::string degradation_text(const Tree& tree) {
  std::string text;
  const auto add = [&](std::string_view key, const std::string& before, const std::string& after) {
    const std::string value = fact_at(&tree, key);
    if (!value.empty()) text += (text.empty() ? "" : "; ") + before + value + after;
  };
  add("every", "one scan in ", "");
  add("without", "without ", "");
  add("max_range_m", "returns within ", " m");
  add("beams", "", " beams");
  add("one_of", "one return in ", "");
  return text;
}

}  // namespace

EstimateFacts estimate_facts(const Tree& estimate) {
  EstimateFacts facts;
  const Tree *given = estimate.find("given"), *input = estimate.find("input");
  facts.recording = fact_at(given, "recording");
  facts.command = fact_at(given, "command");
  const auto add = [&](const char* heading, std::string value) {
    if (!value.empty()) facts.given.emplace_back(heading, std::move(value));
  };
  add("recording", facts.recording);
  add("points", fact_at(input, "points"));
  add("of these", points_text(input));
  add("frame of the points", fact_at(input, "frame"));
  add("not read", fact_at(input, "other_points"));
  add("kept back", degradation_text(estimate));
  add("mount of the LiDAR", mount_text(fact_at(input, "mount")));
  add("its height", height_text(given));
  const std::string odometry = fact_at(given, "odometry");
  add("odometry", odometry == "true" ? "read " + fact_at(input, "odometry") : odometry.empty() ? "" : "none");
  add("IMU", fact_at(input, "imu"));
  add("method", fact_at(&estimate, "method"));
  add("it got", fact_at(&estimate, "sensors") == "lidar" ? "LiDAR alone" : "");
  add("plan", fact_at(given, "plan"));
  add("furniture in the plan", unscored(fact_at(given, "plan_furniture")));
  const std::string yaw = fact_at(given, "yaw_deg"), storey = fact_at(given, "storey");
  add("heading at the start",
      yaw.empty() ? (given != nullptr && given->find("plan") != nullptr ? "unknown" : "") : yaw + "°");
  add("storey at the start", storey.empty() && given != nullptr && given->find("plan") != nullptr ? "unknown" : storey);
  add("plan moved by, m", fact_at(&estimate, "plan_moved_by_m"));
  add("seed", fact_at(&estimate, "seed"));
  for (const char* key : {"left_out", "assumed", "warnings"})
    for (std::string& said : sentences_of(estimate, key)) facts.warnings.push_back(std::move(said));
  facts.unchecked = sentences_of(estimate, "unchecked");
  if (const Tree* config = estimate.find("config")) facts.config = write_yaml(*config);
  if (const Tree* origin = input == nullptr ? nullptr : input->find("origin_ns")) {
    facts.origin = origin->as_int();
    if (facts.origin <= -slam::furthest_stamp || facts.origin >= slam::furthest_stamp)
      throw InputError(origin->mark, "a time of less than 4e18 ns is expected");
  }
  return facts;
}

}  // namespace plumbline::scenarios
