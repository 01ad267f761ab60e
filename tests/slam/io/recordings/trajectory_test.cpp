// SPDX-License-Identifier: Apache-2.0
#include "slam/io/recordings/trajectory.h"

#include <gtest/gtest.h>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "bim/random/stream.h"
#include "slam/io/recordings/tum.h"
#include "tests/input_error.h"

namespace plumbline::slam {
namespace {

std::vector<StampedPose> random_poses(int count) {
  const Stream stream(5, "bim.generate");
  std::vector<StampedPose> poses;
  for (int i = 0; i < count; ++i) {
    Vector6d v;
    for (int k = 0; k < 6; ++k)
      v[k] = stream.gauss(static_cast<std::uint64_t>(i), static_cast<std::uint32_t>(k)) * (k < 3 ? 20.0 : 1.0);
    poses.push_back({1'403'636'579'758'555'392 + 100'000'123LL * i, exp_se3(v)});
  }
  return poses;
}

std::vector<Nanoseconds> stamps_of(const std::vector<StampedPose>& poses) {
  std::vector<Nanoseconds> stamps;
  for (const StampedPose& pose : poses) stamps.push_back(pose.stamp);
  return stamps;
}

std::string line_of(const std::vector<double>& values, const std::string& between) {
  std::string line;
  for (const double v : values) line += (line.empty() ? "" : between) + format_number(v);
  return line;
}

std::string write_euroc(const std::vector<StampedPose>& poses, const std::string& more = "") {
  std::string text =
      "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\r\n";
  for (const StampedPose& p : poses)
    text += std::to_string(p.stamp) + ", " +
            line_of({p.X_FR.t.x(), p.X_FR.t.y(), p.X_FR.t.z(), p.X_FR.q.w(), p.X_FR.q.x(), p.X_FR.q.y(), p.X_FR.q.z()},
                    ",") +
            more + "\r\n";
  return text;
}

std::string write_kitti(const std::vector<StampedPose>& poses) {
  std::string text;
  for (const StampedPose& p : poses) {
    const Eigen::Matrix3d R = p.X_FR.q.toRotationMatrix();
    std::vector<double> values;
    for (int i = 0; i < 3; ++i) values.insert(values.end(), {R(i, 0), R(i, 1), R(i, 2), p.X_FR.t[i]});
    text += line_of(values, " ") + "\n";
  }
  return text;
}

TEST(Trajectory, EveryFormGivesTheSamePoses) {
  const std::vector<StampedPose> poses = random_poses(200);
  const std::vector<Nanoseconds> stamps = stamps_of(poses);
  EXPECT_EQ(trajectory_form(write_tum(poses)), TrajectoryForm::tum);
  EXPECT_EQ(trajectory_form(write_kitti(poses)), TrajectoryForm::kitti);
  EXPECT_EQ(trajectory_form(write_euroc(poses)), TrajectoryForm::euroc);
  // In a EuRoC file velocity and biases may follow.
  for (const std::string& text :
       {write_tum(poses), write_kitti(poses), write_euroc(poses), write_euroc(poses, ",0.1,0.2,0.3,0,0,0,0,0,0")}) {
    const std::vector<StampedPose> read = read_trajectory(text, "t", stamps);
    ASSERT_EQ(read.size(), poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      EXPECT_EQ(read[i].stamp, poses[i].stamp);
      EXPECT_EQ(read[i].X_FR.t, poses[i].X_FR.t);
      EXPECT_LT(read[i].X_FR.q.angularDistance(poses[i].X_FR.q), 1e-7);  // of a rotation's acos near 1
    }
  }
}

TEST(Trajectory, NamesTheLineThatIsWrong) {
  const auto complaint = [](const std::string& text, std::size_t scans = 1) {
    const std::vector<Nanoseconds> stamps(scans);
    return input_error([&] { static_cast<void>(read_trajectory(text, "t.txt", stamps)); });
  };
  const std::string euroc = "# t\n100,1,2,3,1,0,0,0\n";
  EXPECT_EQ(complaint(euroc), "no error");
  EXPECT_EQ(complaint(euroc + "200,1,2,3,1,0,0\n").rfind("t.txt:3:1: 7 columns between commas", 0), 0U);
  EXPECT_EQ(complaint(euroc + "200,1,2,x,1,0,0,0\n").rfind("t.txt:3:1: 'x' is not a number", 0), 0U);
  EXPECT_EQ(complaint(euroc + "2.5,1,2,3,1,0,0,0\n").rfind("t.txt:3:1: '2.5' is no time", 0), 0U);
  EXPECT_EQ(complaint(euroc + "3999999999999999999,1,2,3,1,0,0,0\n"), "no error");
  EXPECT_EQ(complaint(euroc + "4000000000000000000,1,2,3,1,0,0,0\n").rfind("t.txt:3:1: '4000000000000000000' is no", 0),
            0U);
  EXPECT_EQ(complaint(euroc + "9223372036854775807,1,2,3,1,0,0,0\n").rfind("t.txt:3:1: '9223372036854775807' is no", 0),
            0U);
  EXPECT_EQ(complaint(euroc + "200,1,2,3,1,1,0,0\n").rfind("t.txt:3:1: the quaternion", 0), 0U);
  EXPECT_EQ(complaint(euroc + "100,1,2,3,1,0,0,0\n").rfind("t.txt:3:1: stamps must increase", 0), 0U);
  const std::string kitti = "1 0 0 5 0 1 0 6 0 0 1 7\n";
  EXPECT_EQ(complaint(kitti), "no error");
  EXPECT_EQ(complaint(kitti + "1 0 0 5 0 1 0 6 0 0 1\n", 2).rfind("t.txt:2:1: 11 columns", 0), 0U);
  EXPECT_EQ(complaint(kitti + "1 0 0 5 0 1 0 6 0 0 nan 7\n", 2).rfind("t.txt:2:1: 'nan' is not a number", 0), 0U);
  EXPECT_EQ(complaint(kitti + "1 0 0 5 0 1 0 6 0 0 1.1 7\n", 2).rfind("t.txt:2:1: the first three columns", 0), 0U);
  EXPECT_EQ(complaint(kitti + "1 0 0 5 0 1 0 6 0 0 -1 7\n", 2).rfind("t.txt:2:1: the first three columns", 0), 0U);
  EXPECT_EQ(complaint(kitti + kitti).rfind("t.txt: holds 2 poses in KITTI form", 0), 0U);
  EXPECT_EQ(complaint(kitti, 3).rfind("t.txt: holds 1 poses in KITTI form", 0), 0U);
  EXPECT_EQ(complaint("1 2 3\n").rfind("t.txt:1:1: 3 columns; a TUM line has 8", 0), 0U);
}

}  // namespace
}  // namespace plumbline::slam
