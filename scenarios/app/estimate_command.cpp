// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/estimate_command.h"

#include <filesystem>
#include <utility>

#include "bim/config/tree.h"
#include "scenarios/host/terminal.h"

namespace plumbline::scenarios {

namespace {

/// Options of a command line, one after the other.
class CommandText {
 public:
  explicit CommandText(std::string start) : text_(std::move(start)) {}
  void add(const std::string& option, const std::string& value) {
    if (!value.empty()) text_ += " " + option + " " + shell_argument(value);
  }
  void add_file(const std::string& option, const std::string& path) { add(option, name_of_path(path)); }
  void add_flag(const std::string& option, bool given) {
    if (given) text_ += " " + option;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void add_degradation(const DegradationOptions& options, CommandText& command) {
  if (options.every != 1) command.add("--every", std::to_string(options.every));
  std::string without;
  for (const std::string& part : options.without) without += (without.empty() ? "" : ",") + part;
  command.add("--without", without);
  if (options.max_range_m > 0.0) command.add("--max-range", format_number(options.max_range_m));
  if (options.beams != 0) command.add("--beams", std::to_string(options.beams));
  if (options.one_of != 1) command.add("--one-of", std::to_string(options.one_of));
}

}  // namespace

std::string name_of_path(const std::string& path) {
  std::error_code error;
  std::filesystem::path whole = std::filesystem::absolute(path, error).lexically_normal();
  if (!whole.has_filename()) whole = whole.parent_path();  // of a closing slash
  return path.empty() ? "" : whole.filename().string();
}

std::string repeating_command(const EstimateArguments& options, bool has_config) {
  CommandText command("plumbline estimate " + shell_argument(name_of_path(options.input.recording)));
  command.add_file("--description", options.input.description);
  command.add("--points-topic", options.input.topics.points);
  command.add("--odometry-topic", options.input.topics.odometry);
  command.add("--imu-topic", options.input.topics.imu);
  command.add_file("--odometry", options.input.motion.odometry);
  command.add_file("--imu", options.input.motion.imu);
  command.add("--method", options.method + (options.is_process ? "=COMMAND" : ""));
  if (options.sensors_option->given()) command.add("--sensors", options.sensors);
  add_degradation(options.degradation, command);
  command.add_file("--plan", options.plan);
  if (options.furniture_option->given()) command.add("--plan-furniture", options.plan_furniture);
  if (has_config) command.add_file("--config", options.config);
  if (options.seed_option->given()) command.add("--seed", std::to_string(options.seed));
  if (options.yaw_option->given()) command.add("--yaw-deg", format_number(options.yaw_deg));
  command.add("--storey", options.storey);
  command.add_flag("--unchecked", options.unchecked);
  command.add("-o", "again");
  return command.text();
}

}  // namespace plumbline::scenarios
