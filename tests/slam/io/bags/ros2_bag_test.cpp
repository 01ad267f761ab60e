// SPDX-License-Identifier: Apache-2.0
// ROS 2 bags hold what ROS 1 bags hold, and nothing in them is believed.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "bim/errors.h"
#include "slam/io/bags/ros2_definitions.h"
#include "slam/io/ros2/compression.h"
#include "slam/io/ros2/mcap_reader.h"
#include "slam/io/ros2/ros2_writer.h"
#include "slam/io/ros2/rosbag2_reader.h"
#include "tests/bag_database.h"
#include "tests/data.h"
#include "tests/folder.h"
#include "tests/input_error.h"
#include "tests/slam/io/bags/bag_of_four_scans.h"

namespace plumbline::slam {
namespace {

namespace fs = std::filesystem;

std::string bytes(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}
void write_bytes(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
}

std::vector<SensorFrame> read_all(const std::string& path, const BagTopics& topics = {}) {
  const auto recording = open_bag(path, topics, nullptr);
  std::vector<SensorFrame> frames;
  for (SensorFrame frame; recording->next(frame);) frames.push_back(frame);
  return frames;
}

void expect_same(const std::vector<SensorFrame>& a, const std::vector<SensorFrame>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].scan.stamp, b[i].scan.stamp);
    EXPECT_EQ(a[i].scan.range_m, b[i].scan.range_m);
    EXPECT_EQ(a[i].scan.point_L, b[i].scan.point_L);
    EXPECT_EQ(a[i].scan.offset_ns, b[i].scan.offset_ns);
    EXPECT_EQ(a[i].scan.reflectivity, b[i].scan.reflectivity);
    ASSERT_EQ(a[i].odometry.size(), b[i].odometry.size());
    for (std::size_t k = 0; k < a[i].odometry.size(); ++k) {
      EXPECT_EQ(a[i].odometry[k].stamp, b[i].odometry[k].stamp);
      EXPECT_EQ(a[i].odometry[k].X_OR.t, b[i].odometry[k].X_OR.t);
      EXPECT_EQ(a[i].odometry[k].X_OR.q.coeffs(), b[i].odometry[k].X_OR.q.coeffs());
    }
    ASSERT_EQ(a[i].covariances.size(), b[i].covariances.size());
    for (std::size_t k = 0; k < a[i].covariances.size(); ++k)
      EXPECT_EQ(a[i].covariances[k].covariance, b[i].covariances[k].covariance);
    ASSERT_EQ(a[i].imu.size(), b[i].imu.size());
    for (std::size_t k = 0; k < a[i].imu.size(); ++k)
      EXPECT_EQ(a[i].imu[k].angular_velocity_R, b[i].imu[k].angular_velocity_R);
  }
}

class Ros2Bag : public ::testing::Test {
 protected:
  [[nodiscard]] std::string file(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::string complaint(const std::string& path) const {
    return input_error([&] { static_cast<void>(read_all(path)); });
  }
  void expect_complaint(const std::string& path, const std::string& words) const {
    EXPECT_NE(complaint(path).find(words), std::string::npos) << complaint(path);
    EXPECT_EQ(complaint(path).rfind(path, 0), 0U) << complaint(path);
  }

 private:
  Folder folder_;
};

TEST_F(Ros2Bag, EveryKindOfOneWalkReadsAsTheSame) {
  write_walk(file("a.bag"), BagFormat::ros1);
  const std::vector<SensorFrame> expected = read_all(file("a.bag"));
  ASSERT_EQ(expected.size(), 4U);
  for (const std::string compression : {"", "zstd", "lz4"}) {
    write_walk(file("a" + compression + ".mcap"), BagFormat::mcap, compression);
    EXPECT_TRUE(is_bag(file("a" + compression + ".mcap")));
    expect_same(read_all(file("a" + compression + ".mcap")), expected);
  }
  write_walk(file("walk"), BagFormat::rosbag2);
  EXPECT_TRUE(is_bag(file("walk")) && is_bag(file("walk/walk_0.db3")));
  expect_same(read_all(file("walk")), expected);
  expect_same(read_all(file("walk/walk_0.db3")), expected);
}

TEST_F(Ros2Bag, AnImuInGIsTakenAsSuch) {
  std::vector<SensorFrame> frames = walk_of_four_scans();
  for (SensorFrame& frame : frames)
    for (Imu& imu : frame.imu) imu.linear_acceleration_R /= 9.80665;
  BagWriter writer(file("g.mcap"), bag_profiles[0], {}, BagFormat::mcap);
  for (const SensorFrame& frame : frames) writer.add(frame.scan, frame.odometry, frame.imu);
  writer.finish();
  EXPECT_NEAR(read_all(file("g.mcap"))[1].imu[0].linear_acceleration_R.z(), 9.81, 1e-12);
}

TEST_F(Ros2Bag, TheSameRecordsGiveTheSameBytes) {
  for (const std::string name : {"a", "b"}) {
    write_walk(file(name + ".mcap"), BagFormat::mcap);
    fs::create_directory(file(name));
    write_walk(file(name + "/walk"), BagFormat::rosbag2);
  }
  EXPECT_TRUE(bytes(file("a.mcap")) == bytes(file("b.mcap")));
  EXPECT_FALSE(fs::exists(file("a.mcap.part")));
  for (const std::string inner : {"/walk/walk_0.db3", "/walk/metadata.yaml"})
    EXPECT_TRUE(bytes(file("a" + inner)) == bytes(file("b" + inner))) << inner;
  // The layout of a file without compression is ours alone; a change must be meant.
  EXPECT_EQ(bytes(file("a/walk/metadata.yaml")).find("rosbag2_bagfile_information:"), 0U);
}

// A byte that is spoilt is found, or changes nothing.
TEST_F(Ros2Bag, NoByteOfAnMcapIsBelieved) {
  {
    const auto writer = make_mcap_writer(file("small.mcap"), "");
    const auto topic = writer->add_topic({"/odom", "nav_msgs/msg/Odometry", "x", ""});
    for (const int i : {1, 2, 3}) writer->write(topic, i, ros::write_clock(i, Encoding::cdr));
    writer->finish();
  }
  const auto messages = [&](const std::string& name) {
    const auto source = open_mcap(file(name));
    source->select({"/odom"});
    std::vector<ros::Bytes> all;
    for (RawMessage message; source->next(message);) all.push_back(message.bytes);
    return all;
  };
  const std::vector<ros::Bytes> expected = messages("small.mcap");
  ASSERT_EQ(expected.size(), 3U);
  const std::string whole = bytes(file("small.mcap"));
  int found = 0;
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const char flip : {'\x01', '\x02', '\x04', '\x80', '\xff'}) {
      std::string spoilt = whole;
      spoilt[i] = static_cast<char>(spoilt[i] ^ flip);
      write_bytes(file("spoilt.mcap"), spoilt);
      try {
        EXPECT_EQ(messages("spoilt.mcap"), expected) << "byte " << i << " of " << whole.size();
      } catch (const InputError&) {
        ++found;
      }
    }
  EXPECT_GT(found, static_cast<int>(whole.size()));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write_bytes(file("cut.mcap"), whole.substr(0, size));
    try {
      const std::vector<ros::Bytes> some = messages("cut.mcap");
      ASSERT_LE(some.size(), expected.size()) << size;
      EXPECT_TRUE(std::equal(some.begin(), some.end(), expected.begin())) << size;
    } catch (const InputError&) {
      EXPECT_LT(size, whole.size() - 8) << "all but the end";
    }
  }
}

// Chunks of 1 MiB that overlap, and messages out of order within them.
TEST_F(Ros2Bag, MessagesComeInTheOrderOfTime) {
  constexpr std::array<int, 8> times = {1, 4, 2, 8, 6, 3, 7, 5};
  const auto write = [&](Ros2Writer& writer, std::size_t from, std::size_t to) {
    const auto topic = writer.add_topic({"/odom", "nav_msgs/msg/Odometry", "x", ""});
    for (std::size_t i = from; i < to; ++i)
      writer.write(topic, times.at(i), ros::Bytes(700'000, static_cast<std::uint8_t>(times.at(i))));
    writer.finish();
  };
  const auto order = [](MessageSource& source) {
    std::vector<int> found;
    for (int again = 0; again < 2; ++again) {
      found.clear();
      source.select({"/odom"});
      for (RawMessage message; source.next(message);) {
        EXPECT_EQ(message.time, message.bytes[0]);
        found.push_back(message.bytes[0]);
      }
    }
    return found;
  };
  const std::vector<int> sorted = {1, 2, 3, 4, 5, 6, 7, 8};
  write(*make_mcap_writer(file("a.mcap"), "zstd"), 0, times.size());
  EXPECT_EQ(order(*open_mcap(file("a.mcap"))), sorted);
  // The files of a split bag, the later one first.
  write(*make_rosbag2_writer(file("one"), "one"), 0, 4);
  write(*make_rosbag2_writer(file("two"), "two"), 4, times.size());
  fs::copy_file(file("two/two_0.db3"), file("one/one_1.db3"));
  std::string metadata = bytes(file("one/metadata.yaml"));
  metadata.replace(metadata.find("[one_0.db3]"), 11, "[one_1.db3, one_0.db3]");
  write_bytes(file("one/metadata.yaml"), metadata);
  EXPECT_EQ(order(*open_rosbag2_folder(file("one"))), sorted);
}

TEST_F(Ros2Bag, ALidarThatIsNotJoinedToTheRobotIsRefused) {
  write_walk(file("walk"), BagFormat::rosbag2);
  const std::string database = file("walk/walk_0.db3");
  EXPECT_EQ(open_bag(database, {}, nullptr)->taken().mount, MountSource::tf_static);
  const ros::Transform other{0, "base_link", "mast", Pose{}};
  std::string hex;
  for (const std::uint8_t byte : ros::write_transforms({&other, 1}, Encoding::cdr)) {
    char text[3];
    std::snprintf(text, sizeof text, "%02x", byte);
    hex += text;
  }
  const std::string which = " WHERE topic_id = (SELECT id FROM topics WHERE name = '/tf_static');";
  run_sql(database, "UPDATE messages SET data = x'" + hex + "'" + which);
  expect_complaint(database, "/velodyne_points is in frame 'velodyne', which /tf_static does not join to 'base_link'");
  const RecordingInfo described;
  EXPECT_EQ(open_bag(database, {}, &described)->taken().mount, MountSource::description);
  run_sql(database, "DELETE FROM messages" + which);
  EXPECT_EQ(open_bag(database, {}, nullptr)->taken().mount, MountSource::unknown);
}

TEST_F(Ros2Bag, ABagWithoutCloudsIsSaidToHoldWhatItHolds) {
  write_walk(file("walk"), BagFormat::rosbag2);
  const std::string database = file("walk/walk_0.db3");
  const auto with_type = [&](const std::string& type) {
    run_sql(database, "UPDATE topics SET type = '" + type + "' WHERE name = '/velodyne_points';");
  };
  with_type("sensor_msgs/msg/LaserScan");
  expect_complaint(database, "/velodyne_points (sensor_msgs/LaserScan)");
  with_type("velodyne_msgs/msg/VelodyneScan");
  expect_complaint(database, "; /velodyne_points holds packets (velodyne_msgs/VelodyneScan)");
  with_type("");
  expect_complaint(database, "/velodyne_points (no type)");
}

TEST_F(Ros2Bag, AFlippedByteInAChunkIsFound) {
  write_walk(file("a.mcap"), BagFormat::mcap);
  std::string spoilt = bytes(file("a.mcap"));
  spoilt[spoilt.size() / 2] = static_cast<char>(spoilt[spoilt.size() / 2] ^ 4);
  write_bytes(file("b.mcap"), spoilt);
  const auto recording = open_bag(file("b.mcap"), {}, nullptr);
  std::size_t scans = 0;
  for (SensorFrame frame; recording->next(frame);) ++scans;
  EXPECT_GT(scans, 0U);
  EXPECT_LT(scans, 4U);
  const std::vector<std::string> said = recording->left_out();
  ASSERT_EQ(said.size(), 1U);
  EXPECT_EQ(said[0].rfind("damaged chunks are left out: 1 of ", 0), 0U) << said[0];
}

TEST_F(Ros2Bag, BombsAreRefusedBeforeTheyAreUnpacked) {
  const std::vector<std::uint8_t> few(100);
  for (const std::string compression : {"zstd", "lz4"}) {
    EXPECT_NE(input_error([&] { (void)unpack(compression, few, std::uint64_t{1} << 30U); }).find("cannot hold so much"),
              std::string::npos);
    EXPECT_NE(input_error([&] { (void)unpack(compression, few, std::uint64_t{1} << 40U); }).find("at most 1 GiB"),
              std::string::npos);
    EXPECT_NE(input_error([&] { (void)unpack(compression, few, 1000); }).find("damaged"), std::string::npos);
    const std::vector<std::uint8_t> zeros(3'000'000), packed = pack(compression, zeros);
    EXPECT_EQ(unpack(compression, packed, zeros.size()), zeros);
    EXPECT_THROW((void)unpack(compression, packed, zeros.size() - 1), InputError);
    EXPECT_THROW((void)unpack(compression, packed, zeros.size() + 1), InputError);
  }
  EXPECT_NE(input_error([&] { (void)unpack("xz", few, 100); }).find("'xz'"), std::string::npos);
}

TEST_F(Ros2Bag, WhatIsWrongWithARosbag2IsSaid) {
  write_walk(file("walk"), BagFormat::rosbag2);
  const std::string metadata = bytes(file("walk/metadata.yaml"));
  const auto with = [&](const std::string& from, const std::string& to, const std::string& words) {
    std::string text = metadata;
    ASSERT_NE(text.find(from), std::string::npos) << text;
    text.replace(text.find(from), from.size(), to);
    write_bytes(file("walk/metadata.yaml"), text);
    EXPECT_NE(complaint(file("walk")).find(words), std::string::npos) << complaint(file("walk"));
  };
  with("storage_identifier: sqlite3", "storage_identifier: leveldb", "'leveldb' storage");
  with("[walk_0.db3]", "[../walk_0.db3]", "not in the bag's folder");
  with("[walk_0.db3]", "[walk_1.db3]", "which is missing");
  with("compression_mode: \"\"", "compression_mode: FILE", "zstd -d");
  write_bytes(file("walk/metadata.yaml"), metadata);

  const std::string database = file("walk/walk_0.db3");
  write_bytes(database + "-wal", "x");
  expect_complaint(database, "close the bag where it was recorded");
  fs::remove(database + "-wal");
  const std::string whole = bytes(database);
  write_bytes(file("cut.db3"), whole.substr(0, 50));  // not even its header; rosbag2_reader_test cuts it elsewhere
  EXPECT_NE(complaint(file("cut.db3")), "no error");
  // What looks like a table may be a program.
  fs::copy_file(database, file("view.db3"));
  run_sql(file("view.db3"), "ALTER TABLE messages RENAME TO m; CREATE VIEW messages AS SELECT * FROM m;");
  expect_complaint(file("view.db3"), "it has no table 'messages'");
  fs::copy_file(database, file("none.db3"));
  run_sql(file("none.db3"), "DELETE FROM messages;");
  expect_complaint(file("none.db3"), "a bag without messages on /velodyne_points");
  fs::copy_file(database, file("short.db3"));
  run_sql(file("short.db3"), "UPDATE messages SET data = x'00010000' WHERE id = 20;");
  expect_complaint(file("short.db3"), "ends too early");
}

TEST_F(Ros2Bag, CompressedMessagesAreRead) {
  write_walk(file("walk"), BagFormat::rosbag2);
  const std::vector<SensorFrame> expected = read_all(file("walk"));
  {
    sqlite3* db = nullptr;
    ASSERT_EQ(sqlite3_open(file("walk/walk_0.db3").c_str(), &db), SQLITE_OK);
    const auto compress = [](sqlite3_context* context, int, sqlite3_value** values) {
      const auto* data = static_cast<const std::uint8_t*>(sqlite3_value_blob(values[0]));
      const auto packed = pack("zstd", {data, data + sqlite3_value_bytes(values[0])});
      sqlite3_result_blob(context, packed.data(), static_cast<int>(packed.size()), SQLITE_TRANSIENT);
    };
    sqlite3_create_function(db, "z", 1, SQLITE_UTF8, nullptr, compress, nullptr, nullptr);
    EXPECT_EQ(sqlite3_exec(db, "UPDATE messages SET data = z(data)", nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(db);
  }
  std::string metadata = bytes(file("walk/metadata.yaml"));
  metadata.replace(metadata.find("compression_format: \"\""), 22, "compression_format: zstd");
  metadata.replace(metadata.find("compression_mode: \"\""), 20, "compression_mode: MESSAGE");
  write_bytes(file("walk/metadata.yaml"), metadata);
  expect_same(read_all(file("walk")), expected);
}

// Without our code: node's packages for MCAP and CDR, and Python's own SQLite.
TEST_F(Ros2Bag, OthersReadThem) {
  write_walk(file("walk"), BagFormat::rosbag2);
  std::ofstream(file("read.py")) << R"(import sqlite3, struct, sys
db = sqlite3.connect(sys.argv[1])
topics = {i: (n, t) for i, n, t in db.execute("SELECT id, name, type FROM topics")}
assert ("/velodyne_points", "sensor_msgs/msg/PointCloud2") in topics.values(), topics
counts = {}
for topic, time, data in db.execute("SELECT topic_id, timestamp, data FROM messages ORDER BY timestamp, id"):
    name, kind = topics[topic]
    counts[name] = counts.get(name, 0) + 1
    assert data[:4] == b"\0\1\0\0"
    if name == "/velodyne_points":
        sec, nanosec, length = struct.unpack_from("<iII", data, 4)
        assert data[16:16 + length] == b"velodyne\0", data[16:40]
        height, width, fields = struct.unpack_from("<III", data, 4 + (12 + length + 3) // 4 * 4)
        assert (width, fields) == (16, 6), (height, width, fields)
assert counts["/velodyne_points"] == 4 and counts["/tf_static"] == 1, counts
assert db.execute("SELECT schema_version FROM schema").fetchone() == (3,)
assert "message_count" in db.execute("SELECT metadata FROM metadata").fetchone()[0]
)";
  EXPECT_EQ(std::system(("/usr/bin/python3 " + file("read.py") + " " + file("walk/walk_0.db3")).c_str()), 0);

  const char* modules = std::getenv("PLUMBLINE_NODE_MODULES");
  if (modules == nullptr) GTEST_SKIP() << "PLUMBLINE_NODE_MODULES names no folder with @mcap/core and its like";
  for (const std::string compression : {"", "zstd", "lz4"}) {
    write_walk(file("a.mcap"), BagFormat::mcap, compression);
    const std::string reader = project_file("tests/slam/io/bags/read_mcap.mjs");
    EXPECT_EQ(std::system(("node " + reader + " " + modules + " " + file("a.mcap")).c_str()), 0) << compression;
    fs::remove(file("a.mcap"));
  }
}

}  // namespace
}  // namespace plumbline::slam
