// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/estimate_builder.h"

#include <gtest/gtest.h>

#include <utility>

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

TEST(EstimateBuilder, ThinsEachPathByItsOwnLength) {
  const Folder folder;
  MethodRecord method = method_on_a_bend(6000);
  method.estimate.trajectory = poses_on_a_bend(100);
  for (slam::StampedPose& pose : method.estimate.trajectory) pose.X_FR.t.x() += 1.0;
  write_estimate(folder.path(), method, {});
  EstimatePage page = read_estimate_page(folder.path());
  EXPECT_EQ(page.thinned, 2U);
  EXPECT_EQ(page.input.methods.at(0).samples.size(), 3001U);
  EXPECT_EQ(page.input.methods.at(0).corrected.size(), 100U);

  std::swap(method.causal, method.estimate.trajectory);
  write_estimate(folder.path(), method, {});
  page = read_estimate_page(folder.path());
  EXPECT_EQ(page.thinned, 1U);
  EXPECT_EQ(page.input.methods.at(0).samples.size(), 100U);
  EXPECT_EQ(page.input.methods.at(0).corrected.size(), 3001U);
}

TEST(EstimateBuilder, DrawsASparseReferenceWhole) {
  const Folder folder;
  const MethodRecord method = method_on_a_bend(100);
  write_estimate(folder.path(), method, {});
  MethodRecord sparse = method;
  sparse.causal.clear();
  for (std::size_t i = 0; i < method.causal.size(); i += 15) sparse.causal.push_back(method.causal[i]);
  write_reference_at(folder.path(), sparse, Pose(), true);
  EXPECT_EQ(occurrences(render_estimate(read_estimate_page(folder.path())), "class=\"truth\""), 1U);
}

}  // namespace
}  // namespace plumbline::scenarios
