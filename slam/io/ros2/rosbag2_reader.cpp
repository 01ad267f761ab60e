// SPDX-License-Identifier: Apache-2.0
#include "slam/io/ros2/rosbag2_reader.h"

#include <sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "bim/config/input_file.h"
#include "bim/config/tree.h"
#include "bim/errors.h"
#include "slam/io/ros2/compression.h"
#include "slam/io/ros2/mcap_reader.h"

namespace plumbline::slam {

namespace {

namespace fs = std::filesystem;

constexpr int most_message_bytes = 256 << 20;

using Statement = std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)>;

class DatabaseReader final : public MessageSource {
 public:
  DatabaseReader(const std::string& path, bool zstd) : mark_{path, 0, 0}, zstd_(zstd) {
    std::error_code error;
    if (fs::file_size(path + "-wal", error) > 0 && !error)
      throw InputError(mark_, "has messages that are still in " + path + "-wal; close the bag where it was recorded");
    sqlite3* db = nullptr;
    const int code = sqlite3_open_v2(path.c_str(), &db, SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, nullptr);
    db_.reset(db);
    if (code != SQLITE_OK) fail();
    sqlite3_db_config(db, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    sqlite3_limit(db, SQLITE_LIMIT_LENGTH, most_message_bytes);
    need_table("topics");
    need_table("messages");
    read_topics();
  }

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_; }

  // By row, since an index on the time would cost a search a row; they stand as they were received.
  void select(const std::vector<std::string>& topics) override {
    wanted_.clear();
    for (const auto& [id, topic] : ids_)
      if (std::find(topics.begin(), topics.end(), topics_[topic].name) != topics.end()) wanted_.insert(id);
    rows_ = prepare("SELECT topic_id, data FROM messages ORDER BY id");
  }

  [[nodiscard]] bool next(RawMessage& message) override {
    while (rows_ && step(rows_)) {
      const sqlite3_int64 id = sqlite3_column_int64(rows_.get(), 0);
      if (!wanted_.contains(id)) continue;
      message.topic = ids_.at(id);
      const auto* bytes = static_cast<const std::uint8_t*>(sqlite3_column_blob(rows_.get(), 1));
      const auto size = static_cast<std::size_t>(sqlite3_column_bytes(rows_.get(), 1));
      if (size == 0) throw InputError(mark_, "a message without bytes");
      if (zstd_)
        message.bytes = unpack_zstd({bytes, size});
      else
        message.bytes.assign(bytes, bytes + size);
      return true;
    }
    rows_.reset();  // a statement that has ended would begin again
    return false;
  }

 private:
  [[noreturn]] void fail() const {
    throw InputError(
        mark_, std::string("is no rosbag2 that can be read: ") + (db_ ? sqlite3_errmsg(db_.get()) : "out of memory"));
  }

  [[nodiscard]] Statement prepare(const std::string& sql) const {
    sqlite3_stmt* raw = nullptr;
    if (sqlite3_prepare_v2(db_.get(), sql.c_str(), -1, &raw, nullptr) != SQLITE_OK) fail();
    return {raw, &sqlite3_finalize};
  }
  [[nodiscard]] bool step(const Statement& statement) const {
    const int code = sqlite3_step(statement.get());
    if (code != SQLITE_ROW && code != SQLITE_DONE) fail();
    return code == SQLITE_ROW;
  }
  [[nodiscard]] static std::string text(const Statement& statement, int column) {
    const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement.get(), column));
    return bytes == nullptr
               ? std::string()
               : std::string(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement.get(), column)));
  }

  void need_table(const std::string& name) const {
    const Statement found = prepare("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = '" + name + "'");
    if (!step(found)) throw InputError(mark_, "is an SQLite file, but no rosbag2: it has no table '" + name + "'");
  }

  void read_topics() {
    constexpr std::size_t most_topics = 65535;
    const Statement rows = prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
    while (step(rows)) {
      if (topics_.size() == most_topics) throw InputError(mark_, "has more than 65,535 topics");
      ids_[sqlite3_column_int64(rows.get(), 0)] = topics_.size();
      topics_.push_back(
          {text(rows, 1), plain_type(text(rows, 2)), text(rows, 3) == "cdr" ? Encoding::cdr : Encoding::unknown});
    }
  }

  Mark mark_;
  bool zstd_;
  std::unique_ptr<sqlite3, decltype(&sqlite3_close)> db_{nullptr, &sqlite3_close};
  std::vector<BagTopic> topics_;
  std::map<sqlite3_int64, std::size_t> ids_;  ///< to topics
  std::set<sqlite3_int64> wanted_;
  Statement rows_{nullptr, &sqlite3_finalize};
};

/// Several files of one bag, one after the other.
class Files final : public MessageSource {
 public:
  explicit Files(std::vector<std::unique_ptr<MessageSource>> files) : files_(std::move(files)) {
    for (const auto& file : files_) {
      std::vector<std::size_t>& to = topic_of_.emplace_back();
      for (const BagTopic& topic : file->topics()) {
        const auto found = std::find_if(topics_.begin(), topics_.end(),
                                        [&](const BagTopic& known) { return known.name == topic.name; });
        to.push_back(static_cast<std::size_t>(found - topics_.begin()));
        if (found == topics_.end()) topics_.push_back(topic);
      }
    }
  }
  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_; }
  void select(const std::vector<std::string>& topics) override {
    for (const auto& file : files_) file->select(topics);
    at_ = 0;
  }
  [[nodiscard]] bool next(RawMessage& message) override {
    for (; at_ < files_.size(); ++at_)
      if (files_[at_]->next(message)) {
        message.topic = topic_of_[at_][message.topic];
        return true;
      }
    return false;
  }

 private:
  std::vector<std::unique_ptr<MessageSource>> files_;
  std::vector<std::vector<std::size_t>> topic_of_;
  std::vector<BagTopic> topics_;
  std::size_t at_ = 0;
};

const Tree& need(const Tree& tree, const std::string& key) {
  const Tree* found = tree.is_map() ? tree.find(key) : nullptr;
  if (found == nullptr) throw InputError(tree.mark, "'" + key + "' is missing, which a rosbag2's metadata has");
  return *found;
}

std::string text_or_empty(const Tree& tree, const std::string& key) {
  const Tree* found = tree.find(key);
  return found == nullptr || found->is_null() ? std::string() : found->as_string();
}

/// A file of the folder; names from elsewhere are not followed.
std::string path_of(const std::string& folder, const Tree& name) {
  const fs::path relative = name.as_string();
  const bool leaves = std::any_of(relative.begin(), relative.end(), [](const fs::path& part) { return part == ".."; });
  if (relative.is_absolute() || leaves) throw InputError(name.mark, "a file that is not in the bag's folder");
  return (fs::path(folder) / relative).string();
}

}  // namespace

std::unique_ptr<MessageSource> open_rosbag2_database(const std::string& path, bool zstd) {
  return std::make_unique<DatabaseReader>(path, zstd);
}

std::unique_ptr<MessageSource> open_rosbag2_folder(const std::string& folder) {
  constexpr std::uint64_t most_metadata_bytes = 16U << 20U;
  const std::string path = folder + "/metadata.yaml";
  const Tree all = read_yaml(read_text_file(path, most_metadata_bytes), path);
  const Tree& info = need(all, "rosbag2_bagfile_information");
  const std::string storage = need(info, "storage_identifier").as_string();
  if (storage != "sqlite3" && storage != "mcap")
    throw InputError(info.mark, "a bag in '" + storage + "' storage; sqlite3 and mcap are read");
  std::string mode = text_or_empty(info, "compression_mode");
  std::transform(mode.begin(), mode.end(), mode.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? char(c - 32) : c; });
  if (mode == "FILE")
    throw InputError(info.mark,
                     "a bag whose files are compressed as a whole; run zstd -d on them, and take "
                     "compression_mode out of metadata.yaml");
  const bool zstd = mode == "MESSAGE";
  if (zstd && (storage != "sqlite3" || text_or_empty(info, "compression_format") != "zstd"))
    throw InputError(info.mark, "messages compressed otherwise than by zstd in sqlite3 cannot be read");
  std::vector<std::unique_ptr<MessageSource>> files;
  for (const Tree& name : need(info, "relative_file_paths").as_list()) {
    const std::string file = path_of(folder, name);
    if (!fs::exists(file)) throw InputError(name.mark, "names '" + name.as_string() + "', which is missing");
    files.push_back(storage == "mcap" ? open_mcap(file) : open_rosbag2_database(file, zstd));
  }
  if (files.empty()) throw InputError(info.mark, "names no file");
  return std::make_unique<Files>(std::move(files));
}

}  // namespace plumbline::slam
