// SPDX-License-Identifier: Apache-2.0
#include "scenarios/host/files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <optional>

#include "bim/config/tree.h"
#include "scenarios/host/manifest.h"
#include "scenarios/run/cloud_file.h"
#include "scenarios/run/digest_log.h"
#include "scenarios/run/estimate_file.h"
#include "tests/folder.h"
#include "tests/input_error.h"

namespace plumbline::scenarios {
namespace {

namespace fs = std::filesystem;

class Files : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }

  Folder folder_;
};

TEST_F(Files, WholeOrNotAtAll) {
  write_file(path("a"), "one");
  write_file(path("a"), "two");
  EXPECT_EQ(read_text_file(path("a")), "two");
  EXPECT_FALSE(fs::exists(path("a.tmp")));
  EXPECT_THROW(write_file(path("none/b"), "x"), EnvironmentError);
  EXPECT_THROW(write_file("/proc/plumbline", "x"), EnvironmentError);  // not even root may write there
}

TEST_F(Files, ARunDirectoryAppearsAtTheEnd) {
  {
    RunDirectory run(path("runs/one"), DirectoryKind::run, false);
    write_file(run.staging() + "/results.json", "{}");
    write_file(run.staging() + "/truth.tum", "");
    EXPECT_FALSE(fs::exists(path("runs/one/results.json")));
    run.commit();
  }
  EXPECT_TRUE(fs::exists(path("runs/one/results.json")));
  EXPECT_TRUE(fs::exists(path("runs/one/truth.tum")));
  EXPECT_FALSE(fs::exists(path("runs/one/.partial")));
}

TEST_F(Files, AnAbandonedRunLeavesNothing) {
  { const RunDirectory run(path("runs/one"), DirectoryKind::run, false); }
  EXPECT_FALSE(fs::exists(path("runs")));
}

TEST_F(Files, OccupiedDirectoriesAreRefused) {
  fs::create_directories(path("full"));
  write_file(path("full/results.json"), "{}");
  EXPECT_THROW(RunDirectory(path("full"), DirectoryKind::run, false), InputError);
  EXPECT_EQ(read_text_file(path("full/results.json")), "{}");
  {
    RunDirectory run(path("full"), DirectoryKind::run, true);
    EXPECT_THROW(RunDirectory(path("full"), DirectoryKind::run, true), InputError);  // another one is writing
    write_file(run.staging() + "/truth.tum", "new");
    run.commit();
  }
  EXPECT_FALSE(fs::exists(path("full/results.json")));
  EXPECT_EQ(read_text_file(path("full/truth.tum")), "new");
  write_file(path("full/thesis.tex"), "mine");
  EXPECT_THROW(RunDirectory(path("full"), DirectoryKind::run, true), InputError);
  EXPECT_THROW(RunDirectory(path("full/truth.tum"), DirectoryKind::run, false), InputError);
}

TEST_F(Files, OneKindOfDirectoryNeverReplacesAnother) {
  const std::vector<std::pair<DirectoryKind, std::vector<std::string>>> kinds = {
      {DirectoryKind::run, {"scenario.yaml", "results.json", "truth.tum", "vgicp.tum", "building.glb"}},
      {DirectoryKind::recording, {"lidar.pcap", "odometry.tum", "imu.csv", "recording.yaml"}},
      {DirectoryKind::estimate, {"vgicp.tum", "vgicp.estimate.json", "estimate.yaml", "digests.csv"}}};
  for (const auto& [kind, names] : kinds) {
    fs::remove_all(path("there"));
    fs::create_directories(path("there"));
    for (const std::string& name : names) write_file(path("there/" + name), "x");
    for (const auto& [other, unused] : kinds) {
      if (other == kind)
        EXPECT_NO_THROW(RunDirectory(path("there"), other, true));
      else
        EXPECT_THROW(RunDirectory(path("there"), other, true), InputError);
    }
    for (const std::string& name : names) EXPECT_EQ(read_text_file(path("there/" + name)), "x");
  }
  fs::create_directories(path("mine"));
  write_file(path("mine/walk.tum"), "x");
  for (const auto& [kind, unused] : kinds) EXPECT_THROW(RunDirectory(path("mine"), kind, true), InputError);
}

TEST_F(Files, WhatAKilledRunLeftIsNoObstacle) {
  fs::create_directories(path("killed/.partial"));
  write_file(path("killed/.partial/results.json"), "half");
  RunDirectory run(path("killed"), DirectoryKind::run, false);
  write_file(run.staging() + "/truth.tum", "");
  run.commit();
  EXPECT_FALSE(fs::exists(path("killed/results.json")));
}

/// A run that was killed while it replaced another.
TEST_F(Files, WhatAKilledReplacementLeftGoesWithTheNextLook) {
  const auto kill = [&] {
    fs::create_directories(path("run/.partial"));
    write_file(path("run/results.json"), "{}");
    write_file(path("run/.partial/lock"), "x");
    write_file(path("run/.partial/truth.tum"), "half");
  };
  kill();
  EXPECT_THROW(RunDirectory(path("run"), DirectoryKind::run, false), InputError);
  EXPECT_FALSE(fs::exists(path("run/.partial")));
  kill();
  remove_abandoned(path("run"));
  EXPECT_FALSE(fs::exists(path("run/.partial")));
  EXPECT_EQ(read_text_file(path("run/results.json")), "{}");
  remove_abandoned(path("run"));
  remove_abandoned(path("none"));
  EXPECT_FALSE(fs::exists(path("none")));
}

TEST_F(Files, WhatARunIsWritingIsNotAbandoned) {
  RunDirectory run(path("run"), DirectoryKind::run, false);
  write_file(run.staging() + "/truth.tum", "half");
  remove_abandoned(path("run"));
  EXPECT_TRUE(fs::exists(run.staging() + "/truth.tum"));
}

TEST_F(Files, WhatIsUnfinishedIsFoundBelowAFolder) {
  for (const char* killed : {"runs/b/.partial", "runs/deep/a/.partial", "runs/.partial"}) {
    fs::create_directories(path(killed));
    write_file(path(killed) + "/lock", "");
  }
  fs::create_directories(path("runs/other/.partial"));  // without a lock it is not ours
  const RunDirectory going(path("runs/going"), DirectoryKind::run, false);
  EXPECT_EQ(unfinished_in(path("runs")),
            (std::vector<std::string>{path("runs"), path("runs/b"), path("runs/deep/a"), path("runs/going")}));
  EXPECT_TRUE(remove_abandoned(path("runs/deep/a")));
  EXPECT_FALSE(remove_abandoned(path("runs/going")));
  EXPECT_EQ(unfinished_in(path("runs/deep")), std::vector<std::string>());
  EXPECT_EQ(unfinished_in(path("none")), std::vector<std::string>());
}

/// A folder of this name may be another program's.
TEST_F(Files, APartialFolderWithoutALockIsNotOurs) {
  fs::create_directories(path("mine/.partial"));
  write_file(path("mine/.partial/thesis.tex"), "mine");
  remove_abandoned(path("mine"));
  EXPECT_TRUE(fs::exists(path("mine/.partial/thesis.tex")));
}

TEST_F(Files, ALinkToNothingIsNamed) {
  fs::create_symlink(path("nowhere"), path("link"));
  for (const std::string& name : {path("link"), path("link/below")}) {
    const std::string text = input_error([&] { RunDirectory(name, DirectoryKind::run, false); });
    EXPECT_EQ(text,
              path("link") + ": is a link to '" + path("nowhere") + "', which does not exist; name another --out");
  }
  EXPECT_FALSE(fs::exists(path("nowhere")));
  fs::create_directory(path("nowhere"));
  EXPECT_NO_THROW(RunDirectory(path("link"), DirectoryKind::run, false));
}

TEST_F(Files, FoldersAreMadeOrSaidWhyNot) {
  EXPECT_EQ(make_folders(path("a/b/c"), path("a")), (std::vector<std::string>{path("a"), path("a/b"), path("a/b/c")}));
  EXPECT_TRUE(make_folders(path("a/b/c"), path("a")).empty());
  write_file(path("file"), "x");
  try {
    (void)make_folders(path("file/below"), "here");
    FAIL();
  } catch (const EnvironmentError& error) {
    EXPECT_STREQ(error.what(), "here: cannot be created: Not a directory");
  }
}

TEST(DigestLog, RoundTripAndFirstDifference) {
  const DigestLog log =
      merge_logs({{{10, "sim.lidar", 1}, {20, "sim.lidar", 2}}, {{10, "m/a", 3}, {20, "m/a", ~0ULL}}});
  EXPECT_EQ(write_digests(log),
            "tick_ns,stage,digest\n10,sim.lidar,0000000000000001\n10,m/a,0000000000000003\n"
            "20,sim.lidar,0000000000000002\n20,m/a,ffffffffffffffff\n");
  const DigestLog again = read_digests(write_digests(log), "d.csv");
  EXPECT_FALSE(first_difference(log, again));
  EXPECT_EQ(digest_of(log), digest_of(again));

  DigestLog changed = log;
  changed[3].digest = 7;
  EXPECT_NE(digest_of(changed), digest_of(log));
  EXPECT_EQ(first_difference(log, changed)->stage, "m/a");
  EXPECT_EQ(first_difference(log, changed)->tick, 20);
  changed.pop_back();
  EXPECT_EQ(first_difference(log, changed)->what, "only in the first");
  EXPECT_EQ(first_difference(changed, log)->what, "only in the second");
  changed[2].tick = 15;
  EXPECT_EQ(first_difference(log, changed)->tick, 15);
  EXPECT_THROW(static_cast<void>(read_digests("tick_ns,stage,digest\n10,sim", "d.csv")), InputError);
  EXPECT_THROW(static_cast<void>(read_digests("tick_ns,stage,digest\n10,sim,xyz\n", "d.csv")), InputError);
  EXPECT_THROW(static_cast<void>(read_digests("stage\n", "d.csv")), InputError);
}

TEST(CloudFile, RoundTripAndDamage) {
  const std::vector<Eigen::Vector3f> points = {{1.5F, -2.0F, 1e-9F}, {0.0F, 3.25F, 1e9F}};
  const std::string bytes = write_ply(points);
  EXPECT_EQ(read_ply(bytes, "p.ply"), points);
  EXPECT_TRUE(read_ply(write_ply({}), "p.ply").empty());
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_THROW(static_cast<void>(read_ply(std::string_view(bytes).substr(0, n), "p.ply")), InputError) << n;
  EXPECT_THROW(static_cast<void>(write_ply({{std::numeric_limits<float>::quiet_NaN(), 0, 0}})), InternalError);
}

TEST(EstimateFile, RoundTrip) {
  MethodRecord method;
  method.name = "s_graphs_plus";
  method.estimate.frame = slam::Frame::world;
  method.localization = true;
  method.crashed = true;
  method.error = "a \"quoted\" reason";
  method.estimate.planes.push_back({7, {{0.6, 0.8, 0.0}, -1.25}, {1, 2}, {3, 4}, 0.1, 2.9, 12});
  method.estimate.rooms.push_back({2, slam::RoomKind::two_wall, {1, 2}, {{0, 0}, {1, 0}, {1, 1}}, {7, 8}});
  method.estimate.floors.push_back({1, {1, 2, 3}, {{0, 0, 1}, 0.0}});
  method.estimate.loops = {{100, 200, Pose::from_xyz_yaw({1, 2, 3}, 0.5)}};
  method.estimate.segmented = {{300, {0, 0, 0.2}, {{-1500, 20, 3}, {4, 5, 6}}, {-1, 2}}};
  MethodRecord again;
  read_estimate(write_estimate(method), "e.json", again);
  EXPECT_EQ(write_estimate(again), write_estimate(method));
  EXPECT_EQ(again.estimate.rooms[0].kind, slam::RoomKind::two_wall);
  EXPECT_EQ(again.error, method.error);
  EXPECT_EQ(again.estimate.loops->at(0).to, 200);
  EXPECT_EQ(again.estimate.segmented.at(0).point_mm, method.estimate.segmented[0].point_mm);
  EXPECT_EQ(again.estimate.segmented[0].plane, (std::vector<int>{-1, 2}));
  EXPECT_THROW(read_estimate("{}", "e.json", again), InputError);
}

TEST(EstimateFile, NumbersThatDoNotFitAreRefused) {
  MethodRecord method, again;
  method.name = "s_graphs_plus";
  method.scans = 1111;
  method.estimate.planes.push_back({2222, {{0.6, 0.8, 0.0}, -1.25}, {1, 2}, {3, 4}, 0.1, 2.9, 3333});
  method.estimate.rooms.push_back({4444, slam::RoomKind::two_wall, {1, 2}, {{0, 0}, {1, 0}, {1, 1}}, {5555}});
  method.estimate.floors.push_back({6666, {1, 2, 3}, {{0, 0, 1}, 0.0}});
  method.estimate.segmented = {{300, {0, 0, 0.2}, {{7777, 20, 3}}, {8888}}};
  const std::string text = write_estimate(method);
  for (const std::string old : {"1111", "2222", "3333", "4444", "5555", "6666", "7777", "8888"})
    for (const std::string number : {"2147483648", "4294967296", "-2147483649", "-9223372036854775808"}) {
      std::string other = text;
      ASSERT_NE(other.find(old), std::string::npos) << old;
      other.replace(other.find(old), old.size(), number);
      EXPECT_NE(input_error([&] { read_estimate(other, "e.json", again); }).find("a whole number from "),
                std::string::npos)
          << old << " " << number;
    }
  std::string other = text;
  other.replace(other.find("1111"), 4, "-1");
  EXPECT_NE(input_error([&] { read_estimate(other, "e.json", again); }).find("from 0 to"), std::string::npos);
}

TEST_F(Files, AManifestIsOfFilesAndNotOfBrokenLinks) {
  write_file(path("a.csv"), "1");
  fs::create_symlink("loop", path("loop"));
  fs::create_symlink("nowhere", path("dangling"));
  write_manifest(folder_.path());
  EXPECT_TRUE(altered_files(folder_.path(), {}).empty());
  const std::string text = read_text_file(path("manifest.csv"));
  EXPECT_NE(text.find("a.csv,"), std::string::npos);
  EXPECT_EQ(text.find("loop"), std::string::npos);
  EXPECT_EQ(text.find("dangling"), std::string::npos);
}

TEST_F(Files, AManifestNamesFilesOfTheKindThatItDoesNotList) {
  write_file(path("vgicp.estimate.json"), "1");
  write_manifest(folder_.path());
  const ManifestCheck check{{"report.html"}, true, DirectoryKind::estimate};
  for (const char* name :
       {"notes.txt", "gt.tum", "vgicp2.tum", "report.html", "score.json", "plan.json", "vgicp.map.ply"})
    write_file(path(name), "2");
  fs::create_directory(path("old"));
  write_file(path("old/score.json"), "2");
  EXPECT_EQ(altered_files(folder_.path(), check),
            (std::vector<std::string>{"plan.json", "score.json", "vgicp.map.ply"}));
  EXPECT_TRUE(altered_files(folder_.path(), {}).empty());
}

TEST_F(Files, AreReplacedTogetherWithTheirManifest) {
  write_file(path("score.json"), "1");
  write_file(path("reference.tum"), "1");
  write_manifest(folder_.path());
  replace_files(folder_.path(),
                {{"score.json", "2"}, {"report.html", std::string(200'000, 'p')}, {"reference.tum", std::nullopt}});
  EXPECT_EQ(read_text_file(path("score.json")), "2");
  EXPECT_FALSE(fs::exists(path("reference.tum")));
  EXPECT_TRUE(altered_files(folder_.path(), {{}, true, DirectoryKind::estimate}).empty());
  fs::remove(path("report.html"));
  fs::create_directory(path("report.html"));  // cannot be replaced: nor are the others
  EXPECT_THROW(replace_files(folder_.path(), {{"score.json", "3"}, {"report.html", "page"}}), InputError);
  EXPECT_EQ(read_text_file(path("score.json")), "2");
  EXPECT_FALSE(fs::exists(path("score.json.tmp")));
}

TEST(EstimateFile, RefusesWhatIsTooFarOrTooLate) {
  BeliefRecord belief;
  belief.hypotheses = {{1.0, Pose::from_xyz_yaw({1e8, 0, 0}, 0), Eigen::Matrix3d::Identity(), ""}};
  EXPECT_EQ(read_beliefs(write_beliefs({belief}), "h.jsonl").size(), 1U);
  BeliefRecord far = belief, wide = belief, late = belief;
  far.hypotheses[0].X_WR.t.y() = 1e200;
  wide.hypotheses[0].covariance(1, 1) = 1e300;
  late.stamp = std::numeric_limits<std::int64_t>::max();
  for (const BeliefRecord& bad : {far, wide, late})
    EXPECT_THROW(static_cast<void>(read_beliefs(write_beliefs({bad}), "h.jsonl")), InputError);
}

TEST(EstimateFile, BeliefsRoundTrip) {
  BeliefRecord belief;
  belief.stamp = 100'859'000;
  belief.state = slam::State::ambiguous;
  belief.hypotheses = {{0.5, Pose::from_xyz_yaw({1, 2, 3}, 0.5), Eigen::Matrix3d::Identity() * 0.1, "office_a"}};
  belief.hypotheses[0].walls = {{{3, 8}, {1.0004, -2.0, 0.25}, {1.0, 2.0, 0.25}}};
  belief.particles = {{1.0004, 2.0, 0.1234, 0.002}};
  const std::string text = write_beliefs({belief, belief});
  const auto again = read_beliefs(text, "h.jsonl");
  ASSERT_EQ(again.size(), 2U);
  EXPECT_EQ(write_beliefs(again), text);
  EXPECT_EQ(again[1].hypotheses[0].X_WR.q.coeffs(), belief.hypotheses[0].X_WR.q.coeffs());
  EXPECT_EQ(again[0].particles[0].x, 1.0);  // to the millimetre
  ASSERT_EQ(again[0].hypotheses[0].walls.size(), 1U);
  EXPECT_EQ(again[0].hypotheses[0].walls[0].faces, (std::vector<int>{3, 8}));
  EXPECT_EQ(again[0].hypotheses[0].walls[0].p0_R, Eigen::Vector3d(1.0, -2.0, 0.25));
  EXPECT_THROW(static_cast<void>(read_beliefs(text + "{}\n", "h.jsonl")), InputError);
}

}  // namespace
}  // namespace plumbline::scenarios
