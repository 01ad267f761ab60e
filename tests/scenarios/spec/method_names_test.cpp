// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/method_names.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenarios/spec/resolve.h"
#include "tests/data.h"
#include "tests/folder.h"
#include "tests/input_error.h"

namespace plumbline::scenarios {
namespace {

using Names = std::vector<std::string>;

slam::MethodRow row(std::string_view name, bool needs_odometry) {
  slam::MethodRow made;
  made.name = name;
  made.needs_odometry = needs_odometry;
  return made;
}

TEST(MethodNames, LabelsAndChoicesAreInversesOfEachOther) {
  for (const char* label : {"vgicp", "vgicp.lidar", "truth", "a.b", ".lidar", ""})
    EXPECT_EQ(choice_of(label).label(), label);
  EXPECT_EQ(choice_of("vgicp.lidar").method, "vgicp");
  EXPECT_EQ(choice_of("vgicp.lidar").sensors, Sensors::lidar);
  EXPECT_EQ(choice_of("vgicp_lidar").sensors, Sensors::all);
}

TEST(MethodNames, AMethodIsRunWithEachOfTheSensorsThatItCanDoWith) {
  const std::vector<slam::MethodRow> table = {row("free", false), row("bound", true)};
  const std::vector<Sensors> both = {Sensors::all, Sensors::lidar}, alone = {Sensors::lidar};
  EXPECT_EQ(labels_of("free", {}, table), Names{"free"});
  EXPECT_EQ(labels_of("free", both, table), (Names{"free", "free.lidar"}));
  EXPECT_EQ(labels_of("free", alone, table), Names{"free.lidar"});
  EXPECT_EQ(labels_of("free.lidar", both, table), Names{"free.lidar"});
  EXPECT_EQ(labels_of("bound", both, table), Names{"bound"});
  EXPECT_EQ(labels_of("bound", alone, table), Names{"bound.lidar"}) << "to be refused";
  EXPECT_EQ(labels_of("truth", both, table), Names{"truth"});
  EXPECT_EQ(labels_of("truth", alone, table), Names{"truth"});
  EXPECT_EQ(row_of("free.lidar", table), &table[0]);
  EXPECT_EQ(row_of("none", table), nullptr);
}

/// A scenario of the short walk with other methods.
class SensorsOfScenarios : public ::testing::Test {
 protected:
  [[nodiscard]] std::string file(const std::string& keys) const {
    std::filesystem::copy_file(project_file("tests/system/short.plan.yaml"), folder_ / "short.plan.yaml",
                               std::filesystem::copy_options::overwrite_existing);
    std::ofstream(folder_ / "s.yaml") << "scenario: 1\nbuilding: short.plan.yaml\nstart: {room: left}\n" << keys;
    return folder_ / "s.yaml";
  }
  [[nodiscard]] Scenario resolved(const std::string& keys, const Overrides& overrides = {}) const {
    return resolve(file(keys), overrides).scenario;
  }
  [[nodiscard]] std::string error_of(const std::string& keys) const {
    return input_error([&] { (void)resolved(keys); });
  }

  const Folder folder_;
};

TEST_F(SensorsOfScenarios, BecomeLabelsThatAReplayReads) {
  const std::string keys = "methods: [truth, odometry, vgicp]\nsensors: [all, lidar]\n";
  const Scenario scenario = resolved(keys);
  EXPECT_EQ(scenario.methods, (Names{"truth", "odometry", "vgicp", "vgicp.lidar"}));
  EXPECT_EQ(read_scenario(write_scenario(scenario), "s").scenario.methods, scenario.methods);
  EXPECT_TRUE(read_scenario(write_scenario(scenario), "s").scenario.sensors.empty());
  EXPECT_EQ(resolved("methods: [truth, vgicp]\nsensors: lidar\n").methods, (Names{"truth", "vgicp.lidar"}));
  EXPECT_EQ(resolved("methods: [vgicp.lidar, vgicp]\n").methods, (Names{"vgicp.lidar", "vgicp"}));
  const Names asked = {"s_graphs_plus"};
  EXPECT_EQ(resolved(keys, {asked, {}}).methods, (Names{"s_graphs_plus", "s_graphs_plus.lidar"}));
}

TEST_F(SensorsOfScenarios, LeaveOutOfTheDefaultsWhatCannotDoWithThem) {
  const Names alone = resolved("sensors: lidar\n").methods;
  EXPECT_FALSE(alone.empty());
  for (const std::string& label : alone) EXPECT_EQ(choice_of(label).sensors, Sensors::lidar) << label;
}

TEST_F(SensorsOfScenarios, AGateIsOfALabel) {
  const std::string gate = "gates: [{metric: ate_aligned_rmse_m, method: vgicp.lidar, max: 1}]\n";
  EXPECT_EQ(resolved("methods: [vgicp, vgicp.lidar]\n" + gate).gates.size(), 1U);
  EXPECT_EQ(resolved("methods: [vgicp]\nsensors: [all, lidar]\n" + gate).gates.size(), 1U);
  EXPECT_NE(error_of("methods: [vgicp]\n" + gate).find("'vgicp.lidar' is not one of"), std::string::npos);
}

TEST_F(SensorsOfScenarios, AGateIsOfAMetricThatItsMethodMayHave) {
  const auto gated = [](const std::string& method, const std::string& metric) {
    return "methods: [" + method + "]\ngates: [{metric: " + metric + ", method: " + method + ", min: 0.1}]\n";
  };
  const std::string localizer = "s_graph_localization";
  for (const char* metric : {"coverage", "tracking.lost_share", "rooms.recall", "drift_10m_percent"})
    EXPECT_NE(error_of(gated(localizer, metric)).find("never has '" + std::string(metric) + "': it localizes"),
              std::string::npos)
        << metric;
  for (const char* metric : {"map_rmse_m", "walls.recall", "localization.yaw_rmse_deg"})
    EXPECT_EQ(resolved(gated(localizer, metric)).gates.size(), 1U) << metric;
  for (const char* metric : {"coverage", "rooms.recall", "map_rmse_m", "walls.recall"})
    EXPECT_EQ(resolved(gated("vgicp", metric)).gates.size(), 1U) << metric;
  EXPECT_NE(error_of(gated("vgicp", "localization.hypotheses")).find("it does not localize"), std::string::npos);
}

TEST_F(SensorsOfScenarios, FaultsAreNamedWhereTheyStand) {
  EXPECT_NE(error_of("methods: [vgicp, odometry.lidar]\n").find("s.yaml:4:18: method 'odometry' needs odometry"),
            std::string::npos);
  EXPECT_NE(error_of("methods: [odometry]\nsensors: lidar\n").find("s.yaml:4:11: method 'odometry' needs odometry"),
            std::string::npos);
  EXPECT_NE(error_of("methods: [truth.lidar]\n").find("reads no sensors"), std::string::npos);
  EXPECT_NE(error_of("methods: [vgcip.lidar]\n").find("did you mean 'vgicp.lidar'"), std::string::npos);
  EXPECT_NE(error_of("methods: [vgicp, vgicp.lidar]\nsensors: [all, lidar]\n").find("'vgicp.lidar' is asked for twice"),
            std::string::npos);
  EXPECT_NE(error_of("sensors: [radar]\n").find("lidar"), std::string::npos);
}

}  // namespace
}  // namespace plumbline::scenarios
