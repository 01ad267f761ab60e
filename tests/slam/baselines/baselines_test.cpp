// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "slam/methods.h"
#include "tests/slam/synthetic.h"

namespace plumbline::slam {
namespace {

struct Answer {
  std::vector<Output> outputs;
  Estimate estimate;
};

Answer run(std::string_view name, const synthetic::Recording& recording) {
  MethodInput input;
  input.calibration = recording.calibration;
  const std::unique_ptr<Method> method = find_method(name)->make(input);
  Answer result;
  std::size_t next = 0;
  for (const Scan& scan : recording.scans) {
    for (; next < recording.odometry.size() && recording.odometry[next].stamp <= scan.stamp; ++next)
      method->on_odometry(recording.odometry[next]);
    result.outputs.push_back(method->on_scan(scan));
  }
  result.estimate = method->finish();
  return result;
}

synthetic::Recording short_walk() {
  synthetic::WalkConfig config;
  config.duration_s = 2.5;
  return synthetic::walk(synthetic::corridor_house(), synthetic::corridor_house_walk(), config);
}

class BaselineTest : public testing::TestWithParam<std::string_view> {};

TEST_P(BaselineTest, GivesOnePoseAScanAMapAndTheSameBytesTwice) {
  const synthetic::Recording recording = short_walk();
  const Answer a = run(GetParam(), recording);
  const Answer b = run(GetParam(), recording);
  ASSERT_EQ(a.outputs.size(), recording.scans.size());
  ASSERT_EQ(a.estimate.trajectory.size(), recording.scans.size());
  EXPECT_GT(a.estimate.map_F.size(), 3000U);
  for (std::size_t k = 0; k < a.outputs.size(); ++k) {
    ASSERT_TRUE(a.outputs[k].X_FR.has_value());
    EXPECT_EQ(a.outputs[k].stamp, recording.scans[k].stamp);
    ASSERT_EQ(a.outputs[k].digests.size(), b.outputs[k].digests.size());
    ASSERT_FALSE(a.outputs[k].digests.empty());
    for (std::size_t i = 0; i < a.outputs[k].digests.size(); ++i)
      EXPECT_EQ(a.outputs[k].digests[i].digest, b.outputs[k].digests[i].digest);
    EXPECT_EQ(a.outputs[k].X_FR->t, b.outputs[k].X_FR->t);
  }
}

TEST_P(BaselineTest, MapPointsLieOnTheHouse) {
  const synthetic::Recording recording = short_walk();
  const Answer result = run(GetParam(), recording);
  const Pose X_WM = recording.truth.front().X_FR * result.estimate.trajectory.front().X_FR.inverse();
  std::size_t near = 0;
  for (const Eigen::Vector3f& p_M : result.estimate.map_F) {
    const Eigen::Vector3d p = X_WM * p_M.cast<double>();
    double distance = std::min(std::abs(p.z()), std::abs(p.z() - 2.8));
    for (const synthetic::Box& box : synthetic::corridor_house().boxes)
      distance = std::min(distance, (p.cwiseMax(box.min).cwiseMin(box.max) - p).norm());
    if (distance < 0.08) ++near;
  }
  EXPECT_GT(static_cast<double>(near), 0.95 * static_cast<double>(result.estimate.map_F.size()));
}

INSTANTIATE_TEST_SUITE_P(Methods, BaselineTest,
                         testing::Values("odometry", "vgicp", "floam", "aloam", "pcl_gicp", "pcl_ndt"),
                         [](const auto& name) { return std::string(name.param); });

TEST(MethodsTest, NamesAreUniqueAndFound) {
  std::set<std::string_view> names;
  for (const MethodRow& row : methods()) {
    EXPECT_TRUE(names.insert(row.name).second);
    EXPECT_EQ(find_method(row.name), &row);
    EXPECT_FALSE(row.summary.empty());
  }
  EXPECT_EQ(find_method("truth"), nullptr) << "the runner adds it; no estimator is the truth";
  EXPECT_EQ(find_method("nonsense"), nullptr);
}

}  // namespace
}  // namespace plumbline::slam
