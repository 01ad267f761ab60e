// SPDX-License-Identifier: Apache-2.0
#include "slam/io/clouds/cloud_times.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "bim/errors.h"
#include "tests/folder.h"
#include "tests/input_error.h"
#include "tests/slam/io/clouds/bin_file.h"

namespace plumbline::slam {
namespace {

TEST(CloudTimes, AreSecondsOrDates) {
  const std::vector<Nanoseconds> read = read_cloud_times(
      "0.000000e+00\n1.036224e-01\r\n\n1700000000.123456789\n2011-09-26 13:02:25.594360375\n1970-01-02T00:00:01\n",
      "t");
  EXPECT_EQ(read, (std::vector<Nanoseconds>{0, 103'622'400, 1'700'000'000'123'456'789, 1'317'042'145'594'360'375,
                                            86'401'000'000'000}));
}

TEST(CloudTimes, OtherLinesAreRefusedByNumber) {
  for (const char* line :
       {"x", "-1", "1 2", "nan", "1e300", "2011-13-26 13:02:25", "2011-02-30 13:02:25", "2011-09-26 25:02:25",
        "2011-09-26 13:02:99", "2011-09-26 13:02:", "4000000000", "2096-11-01 00:00:00", "2011-09-26 13:0-:25"})
    EXPECT_EQ(input_error([&] { (void)read_cloud_times("0\n" + std::string(line) + "\n", "t.txt"); }).find("t.txt:2"),
              0U)
        << line;
}

TEST(CloudTimes, MayBeTheNamesOfTheClouds) {
  const std::vector<Nanoseconds> stamps = {1'700'000'000'000'000'000, 1'700'000'000'200'000'000};
  for (const std::vector<std::string>& names : {std::vector<std::string>{"1700000000.0.pcd", "1700000000.2.pcd"},
                                                {"1700000000.pcd", "1700000000.200000000.pcd"},
                                                {"1700000000_000000000.pcd", "1700000000_200000000.pcd"},
                                                {"1700000000000.bin", "1700000000200.bin"},
                                                {"a-1__TOP__1700000000000000.bin", "a-1__TOP__1700000000200000.bin"},
                                                {"cloud_1700000000.pcd", "cloud_1700000000.2.pcd"},
                                                {"1700000000000000.ply", "1700000000200000.ply"},
                                                {"1700000000000000000.pcd.bin", "1700000000200000000.pcd.bin"}})
    EXPECT_EQ(stamps_in(names), stamps) << names.front();
  for (const std::vector<std::string>& names : {std::vector<std::string>{"1700000000.0.pcd"},
                                                {"0.pcd", "1.pcd"},
                                                {"17.5.pcd", "17.6.pcd"},
                                                {"1700000000.2.pcd", "1700000000.2.pcd"},
                                                {"0000000001.bin", "0000000002.bin"},
                                                {"1700000000_1.pcd", "1700000000_2.pcd"},
                                                {"17000000001.pcd", "17000000002.pcd"},
                                                {"4000000000.0.pcd", "4000000001.0.pcd"},
                                                {"9000000000000.pcd", "9999999999999.pcd"},
                                                {"9000000000000000000.pcd", "9000000000000000001.pcd"},
                                                {"1700000000.0.pcd", "a.pcd"}})
    EXPECT_TRUE(stamps_in(names).empty()) << names.front();
}

TEST(CloudTimes, StandBesideTheCloudsOrTheirFolder) {
  const Folder folder;
  const std::string inner = folder / "velodyne";
  std::filesystem::create_directory(inner);
  EXPECT_FALSE(find_cloud_times(inner));
  write_raw(folder / "timestamps.txt", "1\n");
  for (const char* slash : {"", "/", "/."}) {
    const auto above = find_cloud_times(inner + slash);
    ASSERT_TRUE(above) << slash;
    EXPECT_EQ(above->stamps, std::vector<Nanoseconds>{1'000'000'000}) << slash;
  }
  write_raw(inner + "/times.txt", "2\n");
  EXPECT_EQ(find_cloud_times(inner)->stamps, std::vector<Nanoseconds>{2'000'000'000});
}

TEST(CloudTimes, AreTakenByNumberWhereCloudsAreMissing) {
  const CloudTimes times{"times.txt", {0, 10, 20, 30}};
  EXPECT_EQ(stamps_of({"a.bin", "b.bin", "c.bin", "d.bin"}, times), times.stamps);
  EXPECT_EQ(stamps_of({"000000.bin", "000003.bin"}, times), (std::vector<Nanoseconds>{0, 30}));
  for (const char* name : {"000004.bin", "a.bin", "99999999999999999999999.bin"})
    EXPECT_EQ(input_error([&] { (void)stamps_of({name}, times); }).find("times.txt: holds 4 times for 1 clouds"), 0U);
}

}  // namespace
}  // namespace plumbline::slam
