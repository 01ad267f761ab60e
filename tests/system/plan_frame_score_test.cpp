// SPDX-License-Identifier: Apache-2.0
// The real program scores a localization of a recording in the plan's frame.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "slam/io/recordings/tum.h"
#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

class PlanFrameScore : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!available()) return;
    folder_ = std::make_unique<Folder>();
    ASSERT_EQ(plumbline({"simulate", project_file("tests/system/short.yaml"), "-o", *folder_ / "walk"}).code, 0);
    estimate("s_graph_localization", {"--plan", project_file("tests/system/short.plan.yaml")});
    estimate("vgicp", {});
  }
  static void TearDownTestSuite() { folder_.reset(); }
  void SetUp() override {
    if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  }
  static void estimate(const std::string& method, const std::vector<std::string>& more) {
    std::vector<std::string> all{"estimate", *folder_ / "walk", "--method", method, "-o", *folder_ / method};
    all.insert(all.end(), more.begin(), more.end());
    ASSERT_EQ(plumbline(all).code, 0);
  }
  static std::string truth() { return *folder_ / "walk/truth.tum"; }
  static Outcome score(const std::string& reference, const std::vector<std::string>& more = {}) {
    std::vector<std::string> all{"score", *folder_ / "s_graph_localization", "--reference", reference};
    all.insert(all.end(), more.begin(), more.end());
    return plumbline(all);
  }
  static nlohmann::json scores() {
    return nlohmann::json::parse(read_file(*folder_ / "s_graph_localization/score.json"));
  }
  /// The true poses, changed.
  template <class Change>
  static std::string changed(const Change& change) {
    std::vector<slam::StampedPose> poses = slam::read_tum(read_file(truth()), truth());
    for (slam::StampedPose& pose : poses) change(pose);
    write_file(*folder_ / "changed.tum", slam::write_tum(poses));
    return *folder_ / "changed.tum";
  }
  static std::unique_ptr<Folder> folder_;
};
std::unique_ptr<Folder> PlanFrameScore::folder_;

TEST_F(PlanFrameScore, WithoutAlignment) {
  const Outcome right = score(truth() + ",frame=W");
  ASSERT_EQ(right.code, 0) << right.err;
  EXPECT_NE(right.out.find("in the plan's frame, not aligned: success; CONVERGED after "), std::string::npos)
      << right.out;
  EXPECT_EQ(scores()["verdict"], "success");
  EXPECT_LT(scores()["localization"]["ape_rmse_m"], 0.1);
  EXPECT_LT(scores()["localization"]["converged_at_s"], 8.0);
  const double aligned = scores()["causal"]["ate_aligned_rmse_m"];

  // As a robot that is in the next room: alignment cannot tell.
  const std::string next_room = changed([](slam::StampedPose& pose) { pose.X_FR.t.x() += 3.0; });
  ASSERT_EQ(score(next_room + ",frame=W").code, 0);
  EXPECT_EQ(scores()["verdict"], "false_convergence");
  EXPECT_NEAR(scores()["localization"]["ape_rmse_m"], 3.0, 0.1);
  EXPECT_NEAR(scores()["causal"]["ate_aligned_rmse_m"], aligned, 1e-6);

  // A reference in another frame says nothing of it.
  ASSERT_EQ(score(next_room).code, 0);
  EXPECT_FALSE(scores().contains("localization"));
  EXPECT_FALSE(scores().contains("verdict"));
  ASSERT_EQ(score(next_room + ",frame=M").code, 0);
  EXPECT_FALSE(scores().contains("localization"));
}

TEST_F(PlanFrameScore, AReferenceOfPositionsAloneJudgesNoHeading) {
  const Outcome outcome = score(changed([](slam::StampedPose& pose) { pose.X_FR.q.setIdentity(); }) + ",frame=W");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(scores()["verdict"], "success");
  EXPECT_FALSE(scores()["localization"].contains("yaw_rmse_deg"));
  for (const char* of_motion : {"step_error_max_m", "step_rotation_median_deg", "rpe_1m_rmse_m", "rpe_1m_rotation_deg"})
    EXPECT_FALSE(scores()["causal"].contains(of_motion)) << of_motion;
}

// As of a total station that loses sight of the robot: what lies between is not known.
TEST_F(PlanFrameScore, WhereTheReferencePausesNothingIsJudged) {
  std::vector<slam::StampedPose> poses = slam::read_tum(read_file(truth()), truth());
  std::erase_if(poses, [](const slam::StampedPose& pose) {
    return slam::seconds(pose.stamp) > 5.0 && slam::seconds(pose.stamp) < 10.0;
  });
  write_file(*folder_ / "paused.tum", slam::write_tum(poses));
  const std::string paused = *folder_ / "paused.tum,frame=W";
  ASSERT_EQ(score(paused).code, 0);
  EXPECT_NEAR(scores()["judged_share"], 0.58, 0.03);
  EXPECT_EQ(scores()["verdict"], "success");
  EXPECT_LT(scores()["localization"]["ape_rmse_m"], 0.1);
  const Outcome gate = score(paused, {"--gate", "localization.ape_rmse_m<=0.1"});
  EXPECT_EQ(gate.code, 1);
  EXPECT_NE(gate.out.find("the reference covers 58 % of the scans"), std::string::npos) << gate.out;
}

// It converges after more than a twentieth of the scans, so that a gate on the aligned error fails whatever that is.
TEST_F(PlanFrameScore, GatesAskForIt) {
  const std::string in_plan = truth() + ",frame=W";
  EXPECT_EQ(score(in_plan, {"--gate", "localization.ape_rmse_m<=0.1", "--gate", "localization.sure_and_wrong<=0"}).code,
            0);
  EXPECT_EQ(score(in_plan, {"--gate", "localization.ape_rmse_m<=0.0001"}).code, 1);
  const Outcome absent = score(truth(), {"--gate", "localization.ape_rmse_m<=0.1"});
  EXPECT_EQ(absent.code, 1) << absent.out;
  EXPECT_NE(absent.out.find("FAILED: localization.ape_rmse_m"), std::string::npos) << absent.out;
}

TEST_F(PlanFrameScore, RefusesWhatItCannotBe) {
  const Outcome slam = plumbline({"score", *folder_ / "vgicp", "--reference", truth() + ",frame=W"});
  EXPECT_EQ(slam.code, 2);
  EXPECT_NE(slam.err.find("'frame=W' is of a localization in a plan; vgicp is none"), std::string::npos) << slam.err;
  const Outcome frame = score(truth() + ",frame=map");
  EXPECT_EQ(frame.code, 2);
  EXPECT_NE(frame.err.find("'frame=map' must be W, the plan's frame, or M"), std::string::npos) << frame.err;
  for (const char* text : {",frame=W", ",topic=/x", "t.tum,frame=", "t.tum,frame=W,frame=M"})
    EXPECT_EQ(score(text).code, 2) << text;
  const Outcome later = score(changed([](slam::StampedPose& pose) { pose.stamp += 1'000'000'000'000; }) + ",frame=W");
  EXPECT_EQ(later.code, 2) << later.out;
}

}  // namespace
}  // namespace plumbline::system_tests
