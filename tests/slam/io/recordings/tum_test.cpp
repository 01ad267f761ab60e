// SPDX-License-Identifier: Apache-2.0
#include "slam/io/recordings/tum.h"

#include <gtest/gtest.h>

#include "bim/errors.h"
#include "tests/input_error.h"

namespace plumbline::slam {
namespace {

TEST(Tum, RoundTripIsExact) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 100; ++i)
    poses.push_back(
        {123456789LL * i - 5, exp_se3((Vector6d() << 0.1 * i, 1e-9, -3.0, 0.01 * i, 0.2, -0.1).finished())});
  const std::string text = write_tum(poses);
  const auto again = read_tum(text, "t.tum");
  ASSERT_EQ(again.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(again[i].stamp, poses[i].stamp);
    EXPECT_EQ(again[i].X_FR.t, poses[i].X_FR.t);
    EXPECT_EQ(again[i].X_FR.q.coeffs(), poses[i].X_FR.q.coeffs());
  }
  EXPECT_EQ(write_tum(again), text);
  EXPECT_EQ(text.find("  "), std::string::npos);
  EXPECT_EQ(text.find(" \n"), std::string::npos);
}

TEST(Tum, NamesTheLineThatIsWrong) {
  const auto complaint = [](const std::string& text) {
    return input_error([&] { static_cast<void>(read_tum(text, "t.tum")); });
  };
  const std::string good = "0.5 1 2 3 0 0 0 1\n";
  EXPECT_EQ(complaint(good), "no error");
  EXPECT_EQ(complaint(good + "1.0 1 2 3 0 0 1\n").rfind("t.tum:2:1: 7 columns", 0), 0U);
  EXPECT_EQ(complaint(good + "1.0,1,2,3,0,0,0,1\n").rfind("t.tum:2:1: 1 columns", 0), 0U);
  EXPECT_EQ(complaint(good + "1.0 1 2 x 0 0 0 1\n").rfind("t.tum:2:1: not a number", 0), 0U);
  EXPECT_EQ(complaint(good + "1.0 1 2 nan 0 0 0 1\n").rfind("t.tum:2:1: not a number", 0), 0U);
  EXPECT_EQ(complaint(good + "1.0 1 2 3 0 0 0 2\n").rfind("t.tum:2:1: the quaternion", 0), 0U);
  EXPECT_EQ(complaint(good + "1.0 1 2 3 0 0 1e200 0\n").rfind("t.tum:2:1: the quaternion", 0), 0U);
  EXPECT_EQ(complaint(good + "1.0 1 2 -1e100 0 0 0 1\n").rfind("t.tum:2:1: a position's coordinates", 0), 0U);
  EXPECT_EQ(complaint("1700000000100839168 1 2 3 0 0 0 1\n"),
            "t.tum:1:1: '1700000000100839168' is no time in seconds; is it in nanoseconds?");
  EXPECT_EQ(complaint("3999999999.5 1 2 3 0 0 0 1\n"), "no error");
  for (const std::string time : {"4000000000", "4000000000.0", "-4e9", "8999999999.9"})
    EXPECT_EQ(complaint(time + " 1 2 3 0 0 0 1\n"),
              "t.tum:1:1: '" + time + "' is no time in seconds; is it in nanoseconds?");
  EXPECT_EQ(complaint(good + good).rfind("t.tum:2:1: stamps must increase", 0), 0U);
  const auto other = read_tum("# comment\n\n1.5e0 1 2 3 0 0 0 1\n1403636580.123456789 1\t2 3 0 0 0 1\r\n", "t");
  ASSERT_EQ(other.size(), 2U);
  EXPECT_EQ(other[0].stamp, 1'500'000'000);
  EXPECT_EQ(other[1].stamp, 1'403'636'580'123'456'789);
}

}  // namespace
}  // namespace plumbline::slam
