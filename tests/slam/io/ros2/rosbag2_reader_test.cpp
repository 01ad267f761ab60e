// SPDX-License-Identifier: Apache-2.0
#include "slam/io/ros2/rosbag2_reader.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace plumbline::slam
