// SPDX-License-Identifier: Apache-2.0
#include "slam/io/ros2/rosbag2_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "bim/config/input_file.h"
#include "slam/io/ros2/compression.h"
#include "slam/io/ros2/ros2_writer.h"
#include "tests/bag_database.h"
#include "tests/folder.h"
#include "tests/input_error.h"

namespace plumbline::slam {
namespace {

// As a query or a tool that edits bags makes it: no key, and numbers that repeat.
TEST(Rosbag2Reader, MessagesAreFoundByTheirRows) {
  const Folder folder;
  {
    const auto writer = make_rosbag2_writer(folder / "walk", "walk");
    const auto topic = writer->add_topic({"/odom", "nav_msgs/msg/Odometry", "x", ""});
    for (const int i : {1, 2, 3}) writer->write(topic, i, std::vector<std::uint8_t>{static_cast<std::uint8_t>(i)});
    writer->finish();
  }
  const std::string database = folder / "walk/walk_0.db3";
  const auto messages = [&] {
    const auto source = open_rosbag2_database(database);
    source->select({"/odom"});
    std::vector<int> found;
    for (RawMessage message; source->next(message);) found.push_back(message.bytes.at(0));
    return found;
  };
  const std::vector<int> expected = {1, 2, 3};
  EXPECT_EQ(messages(), expected);
  run_sql(database, "ALTER TABLE messages RENAME TO m; CREATE TABLE messages AS SELECT * FROM m; DROP TABLE m;");
  EXPECT_EQ(messages(), expected);
  run_sql(database, "UPDATE messages SET id = 1;");
  EXPECT_EQ(messages(), expected);
  run_sql(database,
          "DROP TABLE messages; CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, "
          "data BLOB) WITHOUT ROWID;");
  const std::string complaint = input_error([&] { (void)messages(); });
  EXPECT_EQ(complaint.rfind(database + ": its table 'messages' is WITHOUT ROWID", 0), 0U) << complaint;
}

/// A bag of one message at each of these times, as SQLite.
void write_database(const std::string& folder, const std::string& name, std::vector<int> times) {
  const auto writer = make_rosbag2_writer(folder, name);
  const auto topic = writer->add_topic({"/odom", "nav_msgs/msg/Odometry", "x", ""});
  for (const int time : times)
    writer->write(topic, time, std::vector<std::uint8_t>{0, static_cast<std::uint8_t>(time)});
  writer->finish();
}

std::vector<Nanoseconds> times_in(MessageSource& source) {
  source.select({"/odom"});
  std::vector<Nanoseconds> times;
  for (RawMessage message; source.next(message);) times.push_back(message.time);
  return times;
}

TEST(Rosbag2Reader, FilesWithRunningNumbersAreOneBagWithoutMetadata) {
  namespace fs = std::filesystem;
  const Folder folder;
  write_database(folder / "a", "walk", {2, 5});
  write_database(folder / "b", "walk", {1, 7});
  fs::remove(folder / "a/metadata.yaml");
  EXPECT_EQ(times_in(*open_rosbag2_folder(folder / "a")), (std::vector<Nanoseconds>{2, 5}));
  fs::rename(folder / "b/walk_0.db3", folder / "a/walk_10.db3");
  const auto both = open_rosbag2_folder(folder / "a");
  EXPECT_EQ(times_in(*both), (std::vector<Nanoseconds>{1, 2, 5, 7}));
  ASSERT_EQ(both->left_out().size(), 1U);
  EXPECT_EQ(both->left_out().front(), "the bag's file 'walk_1.db3' is missing");
}

// As up to ROS 2 Eloquent, when names of files began with the folder's own.
TEST(Rosbag2Reader, FilesMayBeNamedFromOutsideOfTheFolder) {
  const Folder folder;
  write_database(folder / "a", "walk", {2, 5});
  const std::string path = folder / "a/metadata.yaml";
  std::string metadata = read_text_file(path);
  const std::size_t at = metadata.find("walk_0.db3");
  ASSERT_NE(at, std::string::npos);
  std::ofstream(path) << metadata.insert(at, "first_name/");
  EXPECT_EQ(times_in(*open_rosbag2_folder(folder / "a")), (std::vector<Nanoseconds>{2, 5}));
}

TEST(Rosbag2Reader, MessagesArePackedWhereTheyLookSo) {
  const Folder folder;
  const std::vector<std::uint8_t> packed = pack("zstd", std::vector<std::uint8_t>(300, 7));
  {
    const auto writer = make_rosbag2_writer(folder / "a", "walk");
    const auto topic = writer->add_topic({"/odom", "nav_msgs/msg/Odometry", "x", ""});
    writer->write(topic, 1, packed);
    writer->finish();
  }
  const auto source = open_rosbag2_database(folder / "a/walk_0.db3");
  source->select({"/odom"});
  RawMessage message;
  ASSERT_TRUE(source->next(message));
  EXPECT_EQ(message.bytes, std::vector<std::uint8_t>(300, 7));
}

/// A bag of `count` messages, each on pages of its own, and the bytes of its file.
std::string long_database(const Folder& folder, int count) {
  const auto writer = make_rosbag2_writer(folder / "long", "walk");
  const auto topic = writer->add_topic({"/odom", "nav_msgs/msg/Odometry", "x", ""});
  for (int i = 0; i < count; ++i)
    writer->write(topic, i + 1, std::vector<std::uint8_t>(10'000, static_cast<std::uint8_t>(i)));
  writer->finish();
  return read_text_file(folder / "long/walk_0.db3");
}

struct Read {
  std::vector<Nanoseconds> times;
  std::string left_out;
};
Read read_database(const Folder& folder, const std::string& bytes) {
  std::ofstream(folder / "spoilt.db3", std::ios::binary) << bytes;
  const auto source = open_rosbag2_database(folder / "spoilt.db3");
  Read read;
  for (int pass = 0; pass < 2; ++pass) read.times = times_in(*source);
  for (const std::string& said : source->left_out()) read.left_out += said;
  EXPECT_EQ(source->start(), 1);
  return read;
}

TEST(Rosbag2Reader, ACutFileGivesTheMessagesThatItHolds) {
  const Folder folder;
  constexpr int count = 400;
  const std::string all = long_database(folder, count);
  for (const std::size_t share : {3U, 5U, 9U}) {
    const std::size_t size = all.size() * share / 10;
    const Read cut = read_database(folder, all.substr(0, size));
    const std::size_t whole = size / 12'500;  // three pages each, and the tree's
    EXPECT_GT(cut.times.size(), whole * 9 / 10);
    for (std::size_t i = 0; i < cut.times.size(); ++i) EXPECT_EQ(cut.times[i], static_cast<Nanoseconds>(i + 1));
    EXPECT_EQ(cut.left_out.find("the bag is cut off; "), 0U) << cut.left_out;
  }
  EXPECT_NE(input_error([&] { (void)read_database(folder, all.substr(0, 5 * 4096)); }).find("holds no whole message"),
            std::string::npos);
}

// A spoilt leaf of the tree, a spoilt chain of a message's bytes, and a spoilt index.
TEST(Rosbag2Reader, WhatDamagedPagesHeldIsLeftOut) {
  const Folder folder;
  constexpr int count = 400;
  const std::string all = long_database(folder, count);
  EXPECT_EQ(read_database(folder, all).times.size(), static_cast<std::size_t>(count));
  EXPECT_EQ(read_database(folder, all).left_out, "");
  std::size_t damaged = 0;
  for (std::size_t page = 10; page < all.size() / 4096; page += 37) {
    std::string bytes = all;
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(page * 4096), 4096, '\xff');
    const Read spoilt = read_database(folder, bytes);
    damaged += spoilt.left_out.empty() ? 0 : 1;
    EXPECT_GT(spoilt.times.size(), static_cast<std::size_t>(count) - 20) << page;
    EXPECT_TRUE(std::is_sorted(spoilt.times.begin(), spoilt.times.end())) << page;
    EXPECT_TRUE(spoilt.left_out.empty() || spoilt.left_out.starts_with("the bag is damaged; ")) << spoilt.left_out;
  }
  EXPECT_GT(damaged, 10U);
}

}  // namespace
}  // namespace plumbline::slam
