// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/estimate_description.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "bim/config/number_list.h"
#include "bim/config/tree.h"
#include "bim/config/utf8.h"
#include "scenarios/app/degradation_options.h"

namespace plumbline::scenarios {

namespace {

double to_hundredths(double value) { return std::round(100.0 * value) / 100.0; }

/// Names of files and frames may be of any encoding, and YAML is UTF-8.
Tree with_utf8(Tree tree) {
  if (auto* text = std::get_if<std::string>(&tree.value)) *text = utf8_of_bytes(*text);
  if (auto* list = std::get_if<Tree::List>(&tree.value))
    for (Tree& entry : *list) entry = with_utf8(std::move(entry));
  if (auto* map = std::get_if<Tree::Map>(&tree.value))
    for (auto& [key, value] : *map) value = with_utf8(std::move(value));
  return tree;
}

/// What was given, by names without their folders.
Tree given_tree(const EstimateDescription& description, const slam::Recording& recording,
                const slam::MethodInput& input) {
  Tree tree = Tree::map();
  tree.set("recording", description.recording).set("odometry", recording.has_odometry());
  tree.set("lidar_height_m", to_hundredths(input.calibration.sensor_height_m));
  tree.set("lidar_height_from", names_of(description.height)[static_cast<std::size_t>(description.height)]);
  if (input.plan) {
    tree.set("plan", description.plan).set("plan_furniture", description.plan_furniture);
    if (input.prior.yaw_W) tree.set("yaw_deg", to_hundredths(*input.prior.yaw_W * 180.0 / std::numbers::pi));
    if (!description.storey.empty()) tree.set("storey", description.storey);
  }
  return tree.set("command", description.command);
}

}  // namespace

std::string describe(const EstimateDescription& description, const slam::Recording& recording,
                     const slam::MethodInput& input) {
  const slam::RecordingInfo& info = recording.info();
  Tree tree = Tree::map();
  tree.set("estimate", 1).set("method", description.method);
  tree.set("seed", static_cast<std::int64_t>(description.seed));
  if (description.sensors != Sensors::all)
    tree.set("sensors", names_of(description.sensors)[static_cast<std::size_t>(description.sensors)]);
  describe(description.degradation, tree);
  const auto add = [&](const char* key, const std::vector<std::string>& sentences) {
    Tree list = Tree::list();
    for (const std::string& said : sentences) list.push(said);
    if (!sentences.empty()) tree.set(key, list);
  };
  add("unchecked", description.altered);
  add("left_out", recording.left_out());
  add("assumed", recording.assumed());
  add("warnings", description.warnings);
  tree.set("given", given_tree(description, recording, input));
  Tree read = to_tree(recording.taken(), description.scans);
  if (recording.origin() != 0) read.set("origin_ns", recording.origin());
  tree.set("input", std::move(read));
  if (info.walk) tree.set("walk", *info.walk);
  if (description.plan_moved_by) tree.set("plan_moved_by_m", number_list(*description.plan_moved_by));
  if (!input.config.is_null()) tree.set("config", input.config);
  return write_yaml(with_utf8(std::move(tree)));
}

}  // namespace plumbline::scenarios
