// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/estimate_builder.h"

#include <gtest/gtest.h>

#include "slam/io/recordings/tum.h"
#include "tests/occurrences.h"
#include "tests/scenarios/report/estimate/estimate_folder.h"

namespace plumbline::scenarios {
namespace {

/// What score leaves of a reference that is the estimate's own path, moved by `X`.
void write_reference_at(const std::string& dir, const MethodRecord& method, const Pose& X, bool in_plan_frame) {
  std::vector<slam::StampedPose> reference = method.causal;
  for (slam::StampedPose& pose : reference) pose.X_FR = X * pose.X_FR;
  write_file(dir + "/reference.tum", slam::write_tum(reference));
  Tree scores = Tree::map();
  scores.set("reference", Tree::map().set("poses", static_cast<std::int64_t>(reference.size())));
  if (in_plan_frame) scores.set("verdict", "success");
  write_file(dir + "/score.json", write_json(scores.set("causal", Tree::map().set("ate_aligned_rmse_m", 0.0))));
}

TEST(EstimateBuilder, SaysOfAReferenceThatItIsAligned) {
  const Folder folder;
  const MethodRecord method = method_on_a_bend(40);
  write_estimate(folder.path(), method, {});
  const Pose elsewhere = Pose::from_xyz_yaw({50.0, 0.0, 0.0}, 1.0);
  for (const bool in_plan_frame : {false, true}) {
    write_reference_at(folder.path(), method, elsewhere, in_plan_frame);
    const EstimatePage page = read_estimate_page(folder.path());
    EXPECT_EQ(page.input.truth_name, in_plan_frame ? "reference" : "reference, aligned to the estimate");
    EXPECT_NEAR(page.input.truth.at(0).x, in_plan_frame ? 50.0 : 0.0, 1e-6);
    const std::string written = render_estimate(page);
    EXPECT_EQ(occurrences(written, "the reference, aligned to the estimate, over time"), in_plan_frame ? 0U : 1U);
    EXPECT_EQ(occurrences(written, ">reference, aligned to the estimate</span>"), in_plan_frame ? 0U : 1U);
  }
}

TEST(EstimateBuilder, DrawsErrorsOfAnEarlierVersionsRealRecording) {
  const Folder folder;
  constexpr slam::Nanoseconds recorded_at = 1'600'000'000'000'000'000;
  const MethodRecord method = method_on_a_bend(40, recorded_at);
  std::vector<slam::Nanoseconds> ticks;
  for (int i = 0; i < 40; ++i) ticks.push_back(i * tenth_ns);
  write_estimate(folder.path(), method, ticks);
  write_reference_at(folder.path(), method, Pose(), false);
  const EstimatePage page = read_estimate_page(folder.path());
  EXPECT_EQ(page.input.truth.size(), 40U);
  EXPECT_NEAR(page.input.methods.at(0).samples.back().t_s, 3.9, 1e-9);
  EXPECT_TRUE(page.input.methods.at(0).samples.back().judged);
  EXPECT_NE(render_estimate(page).find("id=\"errors\""), std::string::npos);
}

}  // namespace
}  // namespace plumbline::scenarios
