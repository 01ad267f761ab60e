// SPDX-License-Identifier: Apache-2.0
#include <sqlite3.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "slam/io/ros2/ros2_writer.h"

namespace plumbline::slam {

namespace {

namespace fs = std::filesystem;
using Statement = std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)>;

constexpr int metadata_version = 5;  ///< Humble's

void write_text(const std::string& path, const std::string& text) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"), &std::fclose);
  if (!file || std::fwrite(text.data(), 1, text.size(), file.get()) != text.size())
    throw EnvironmentError(path + ": cannot be written: " + std::strerror(errno));
}

/// What is being written.
struct Rosbag2Files {
  std::string folder, file;
  std::unique_ptr<sqlite3, decltype(&sqlite3_close)> db{nullptr, &sqlite3_close};
  Statement insert{nullptr, &sqlite3_finalize};
  std::vector<Ros2Topic> topics;
  std::vector<std::int64_t> counts;
  Nanoseconds first = 0, last = 0;
  std::int64_t messages = 0;

  [[noreturn]] void fail() const {
    throw EnvironmentError(folder + ": cannot be written: " + (db ? sqlite3_errmsg(db.get()) : "out of memory"));
  }
  void run(const char* sql) const {
    if (sqlite3_exec(db.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail();
  }
  [[nodiscard]] Statement prepare(const char* sql) const {
    sqlite3_stmt* raw = nullptr;
    if (sqlite3_prepare_v2(db.get(), sql, -1, &raw, nullptr) != SQLITE_OK) fail();
    return {raw, &sqlite3_finalize};
  }

  [[nodiscard]] std::string metadata() const {
    Tree list = Tree::list();
    for (std::size_t i = 0; i < topics.size(); ++i)
      list.push(Tree::map()
                    .set("topic_metadata", Tree::map()
                                               .set("name", topics[i].name)
                                               .set("type", topics[i].type)
                                               .set("serialization_format", "cdr")
                                               .set("offered_qos_profiles", topics[i].qos))
                    .set("message_count", counts[i]));
    const auto start = Tree::map().set("nanoseconds_since_epoch", first);
    const auto duration = Tree::map().set("nanoseconds", last - first);
    Tree one = Tree::map();
    one.set("path", file).set("starting_time", start).set("duration", duration).set("message_count", messages);
    Tree info = Tree::map();
    info.set("version", metadata_version)
        .set("storage_identifier", "sqlite3")
        .set("duration", duration)
        .set("starting_time", start)
        .set("message_count", messages)
        .set("topics_with_message_count", std::move(list))
        .set("compression_format", "")
        .set("compression_mode", "")
        .set("relative_file_paths", Tree::list().push(file))
        .set("files", Tree::list().push(std::move(one)));
    return write_yaml(Tree::map().set("rosbag2_bagfile_information", std::move(info)));
  }
};

class Rosbag2Writer final : public Ros2Writer {
 public:
  Rosbag2Writer(const std::string& folder, const std::string& name);
  [[nodiscard]] std::uint16_t add_topic(const Ros2Topic& topic) override;
  void write(std::uint16_t topic, Nanoseconds time, std::span<const std::uint8_t> cdr) override;
  void finish() override;

 private:
  Rosbag2Files file_;
};

Rosbag2Writer::Rosbag2Writer(const std::string& folder, const std::string& name) {
  Rosbag2Files& w = file_;
  w.folder = folder;
  w.file = name + "_0.db3";
  std::error_code error;
  fs::create_directory(folder, error);
  if (error) throw EnvironmentError(folder + ": cannot be made: " + error.message());
  sqlite3* db = nullptr;
  const int code = sqlite3_open((folder + "/" + w.file).c_str(), &db);
  w.db.reset(db);
  if (code != SQLITE_OK) w.fail();
  // One writer, and the folder is moved into place when it is whole: no journal.
  w.run(
      "PRAGMA page_size = 4096; PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;"
      "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);"
      "INSERT INTO schema VALUES (3, 'humble');"
      "CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);"
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
      " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,"
      " data BLOB NOT NULL); BEGIN;");
  w.insert = w.prepare("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)");
}

std::uint16_t Rosbag2Writer::add_topic(const Ros2Topic& topic) {
  Rosbag2Files& w = file_;
  const Statement row = w.prepare("INSERT INTO topics VALUES (?, ?, ?, 'cdr', ?)");
  const auto id = static_cast<std::uint16_t>(w.topics.size());
  sqlite3_bind_int(row.get(), 1, id + 1);
  const std::string* texts[] = {&topic.name, &topic.type, &topic.qos};
  for (int i = 0; i < 3; ++i)
    sqlite3_bind_text(row.get(), i + 2, texts[i]->c_str(), static_cast<int>(texts[i]->size()), SQLITE_TRANSIENT);
  if (sqlite3_step(row.get()) != SQLITE_DONE) w.fail();
  w.topics.push_back(topic);
  w.counts.push_back(0);
  return id;
}

void Rosbag2Writer::write(std::uint16_t topic, Nanoseconds time, std::span<const std::uint8_t> cdr) {
  Rosbag2Files& w = file_;
  sqlite3_reset(w.insert.get());
  sqlite3_bind_int(w.insert.get(), 1, topic + 1);
  sqlite3_bind_int64(w.insert.get(), 2, time);
  sqlite3_bind_blob64(w.insert.get(), 3, cdr.data(), cdr.size(), SQLITE_STATIC);
  if (sqlite3_step(w.insert.get()) != SQLITE_DONE) w.fail();
  w.first = w.messages == 0 ? time : std::min(w.first, time);
  w.last = std::max(w.last, time);
  ++w.messages;
  ++w.counts[topic];
}

void Rosbag2Writer::finish() {
  Rosbag2Files& w = file_;
  w.insert.reset();
  const std::string metadata = w.metadata();
  {
    const Statement row = w.prepare("INSERT INTO metadata(metadata_version, metadata) VALUES (?, ?)");
    sqlite3_bind_int(row.get(), 1, metadata_version);
    sqlite3_bind_text(row.get(), 2, metadata.c_str(), static_cast<int>(metadata.size()), SQLITE_TRANSIENT);
    if (sqlite3_step(row.get()) != SQLITE_DONE) w.fail();
  }
  w.run("CREATE INDEX timestamp_idx ON messages (timestamp ASC); COMMIT;");
  if (sqlite3_close(w.db.release()) != SQLITE_OK) throw EnvironmentError(w.folder + ": cannot be closed");
  write_text(w.folder + "/metadata.yaml", metadata);
}

}  // namespace

std::unique_ptr<Ros2Writer> make_rosbag2_writer(const std::string& folder, const std::string& name) {
  return std::make_unique<Rosbag2Writer>(folder, name);
}

}  // namespace plumbline::slam
