// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <string>

namespace plumbline {

/// Changes a database, as that of a rosbag2.
inline void run_sql(const std::string& path, const std::string& sql) {
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
  sqlite3_close(db);
}

/// Exchanges rows `at` and `at` + 1 of a topic of a rosbag2: order alone, since each keeps its time.
inline void swap_rows(const std::string& database, const std::string& topic, int at) {
  const auto nth = [&](int n) {
    return "(SELECT id FROM messages WHERE topic_id = (SELECT id FROM topics WHERE name = '" + topic +
           "') ORDER BY id LIMIT 1 OFFSET " + std::to_string(n) + ")";
  };
  run_sql(database, "CREATE TEMP TABLE two AS SELECT " + nth(at) + " AS a, " + nth(at + 1) +
                        " AS b; UPDATE messages SET id = -1 WHERE id = (SELECT a FROM two); UPDATE messages SET id = "
                        "(SELECT a FROM two) WHERE id = (SELECT b FROM two); UPDATE messages SET id = (SELECT b FROM "
                        "two) WHERE id = -1; DROP TABLE two;");
}

/// Exchanges what was recorded as message `at` of a topic, from 0 on, with the one after it.
inline void swap_messages(const std::string& database, const std::string& topic, int at) {
  const auto nth = [&](int n) {
    return "(SELECT id FROM messages WHERE topic_id = (SELECT id FROM topics WHERE name = '" + topic +
           "') ORDER BY timestamp, id LIMIT 1 OFFSET " + std::to_string(n) + ")";
  };
  run_sql(database, "CREATE TEMP TABLE two AS SELECT id, data FROM messages WHERE id IN (" + nth(at) + ", " +
                        nth(at + 1) +
                        "); UPDATE messages SET data = (SELECT data FROM two WHERE two.id <> messages.id) WHERE id IN "
                        "(SELECT id FROM two); DROP TABLE two;");
}

}  // namespace plumbline
