// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/estimate_files.h"

#include <gtest/gtest.h>

#include "slam/io/recordings/tum.h"
#include "tests/scenarios/report/estimate/estimate_folder.h"

namespace plumbline::scenarios {
namespace {

constexpr slam::Nanoseconds recorded_at = 1'600'000'000'000'000'000;

/// Not evenly apart, as scans of a real LiDAR.
std::vector<slam::Nanoseconds> uneven_ticks(int ticks) {
  std::vector<slam::Nanoseconds> all;
  for (int i = 0; i < ticks; ++i) all.push_back(i * tenth_ns + i * i * 1000);
  return all;
}

std::vector<slam::Nanoseconds> moved_ticks(std::vector<slam::Nanoseconds> ticks, slam::Nanoseconds by) {
  for (slam::Nanoseconds& tick : ticks) tick += by;
  return ticks;
}

/// With a pose at each tick but the first and the last.
MethodRecord method_at(const std::vector<slam::Nanoseconds>& ticks) {
  MethodRecord method = method_on_a_bend(static_cast<int>(ticks.size()) - 2);
  for (std::size_t i = 0; i < method.causal.size(); ++i) method.causal[i].stamp = ticks[i + 1];
  return method;
}

TEST(EstimateFiles, OfAnEarlierVersionHaveTheirScansOnTheRecordingsClock) {
  const std::vector<slam::Nanoseconds> ticks = uneven_ticks(20);
  for (const slam::Nanoseconds origin : {slam::Nanoseconds{0}, 5 * tenth_ns, recorded_at}) {
    const Folder folder;
    write_estimate(folder.path(), method_at(moved_ticks(ticks, origin)), ticks);
    EXPECT_EQ(read_estimate_files(folder.path()).scans, moved_ticks(ticks, origin)) << origin;
  }
}

TEST(EstimateFiles, WhoseDigestsFitNoAnswerHaveTheScansOfTheAnswers) {
  const Folder folder;
  write_estimate(folder.path(), method_on_a_bend(20, recorded_at), uneven_ticks(25));
  std::vector<slam::Nanoseconds> stamps;
  for (const slam::StampedPose& pose : poses_on_a_bend(20, recorded_at)) stamps.push_back(pose.stamp);
  EXPECT_EQ(read_estimate_files(folder.path()).scans, stamps);
}

TEST(EstimateFiles, KeepTicksAroundTheAnswers) {
  const Folder folder;  // as of a method that gives its poses between the scans
  MethodRecord method = method_at(uneven_ticks(20));
  for (slam::StampedPose& pose : method.causal) pose.stamp += 7 * (pose.stamp % 11);
  write_estimate(folder.path(), method, uneven_ticks(20));
  EXPECT_EQ(read_estimate_files(folder.path()).scans, uneven_ticks(20));
}

TEST(EstimateFiles, TakeTheOriginThatIsWritten) {
  const Folder folder;
  const std::vector<slam::Nanoseconds> ticks = uneven_ticks(20);
  write_estimate(folder.path(), method_at(moved_ticks(ticks, recorded_at)), ticks);
  write_file(folder / "estimate.yaml", "estimate: 1\nmethod: kiss_icp\nseed: 1\ninput: {origin_ns: 17}\n");
  EXPECT_EQ(read_estimate_files(folder.path()).scans, moved_ticks(ticks, 17));
}

// Each sum of a tick and the answers' clock must fit.
TEST(EstimateFiles, TakeNoClockThatTicksDoNotFit) {
  const Folder folder;
  constexpr slam::Nanoseconds far = 3'900'000'000'000'000'000;
  write_estimate(folder.path(), method_at({-far, 3'800'000'000'000'000'000, far}), {-far, far});
  EXPECT_EQ(read_estimate_files(folder.path()).scans, (std::vector<slam::Nanoseconds>{-far, far}));
}

EstimateFiles scored_files() {
  EstimateFiles files;
  Tree& numbers = files.scores.emplace().numbers;
  numbers = Tree::map();
  numbers.set("reference", Tree::map().set("poses", 30));
  numbers.set("causal", Tree::map().set("ate_aligned_rmse_m", 0.08).set("rpe_1m_rmse_m", 0.89));
  return files;
}

TEST(EstimateFiles, TellAReferenceOfPositionsAlone) {
  const Folder folder;
  write_estimate(folder.path(), method_on_a_bend(40), uneven_ticks(0));
  std::vector<slam::StampedPose> reference = poses_on_a_bend(40);
  write_file(folder / "reference.tum", slam::write_tum(reference));
  EXPECT_FALSE(read_estimate_files(folder.path()).reference_kind.positions_alone);
  for (slam::StampedPose& pose : reference) pose.X_FR.q = Eigen::Quaterniond::Identity();
  write_file(folder / "reference.tum", slam::write_tum(reference));
  EXPECT_TRUE(read_estimate_files(folder.path()).reference_kind.positions_alone);
}

TEST(ReferenceSentence, SaysNoMoreThanPositionsTell) {
  EXPECT_EQ(reference_sentence({}), "");
  EstimateFiles files = scored_files();
  EXPECT_NE(reference_sentence(files).find("8 cm rms, 89 cm over each metre."), std::string::npos);
  files.reference_kind.positions_alone = true;
  files.scores->numbers.set("causal", Tree::map().set("ate_aligned_rmse_m", 0.08));
  const std::string said = reference_sentence(files);
  EXPECT_EQ(said.find("over each metre"), std::string::npos) << said;
  EXPECT_NE(said.find("one orientation throughout: errors of steps, of rotation and over a metre are left out."),
            std::string::npos)
      << said;
}

TEST(ReferenceSentence, SaysThatAnAlignedOneShowsNoWrongPlace) {
  EstimateFiles files = scored_files();
  const std::string why = "cannot show a wrong place";
  EXPECT_EQ(reference_sentence(files).find(why), std::string::npos) << "SLAM has no place in a plan";
  files.method.localization = true;
  EXPECT_NE(reference_sentence(files).find(why), std::string::npos);
  EXPECT_NE(reference_sentence(files).find("frame=W"), std::string::npos);
  files.scores->numbers.set("verdict", "success");
  EXPECT_EQ(reference_sentence(files).find(why), std::string::npos);
}

}  // namespace
}  // namespace plumbline::scenarios
