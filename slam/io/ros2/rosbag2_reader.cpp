// SPDX-License-Identifier: Apache-2.0
#include "slam/io/ros2/rosbag2_reader.h"

#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "bim/config/file_ending.h"
#include "bim/config/input_file.h"
#include "bim/config/tree.h"
#include "bim/errors.h"
#include "slam/io/ros2/bag_files.h"
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
    const InputFile file = open_input_file(path);
    bytes_ = file.bytes;
    cut_ = is_cut(file);
    sqlite3* db = nullptr;
    const int code = sqlite3_open_v2(path.c_str(), &db, SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, nullptr);
    db_.reset(db);
    if (code != SQLITE_OK) fail();
    sqlite3_db_config(db, SQLITE_DBCONFIG_DEFENSIVE, cut_ ? 0 : 1, nullptr);
    if (cut_) sqlite3_db_config(db, SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);  // it refuses fewer pages otherwise
    sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    sqlite3_db_config(db, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    sqlite3_limit(db, SQLITE_LIMIT_LENGTH, most_message_bytes);
    need_table("topics");
    need_table("messages");
    need_row_numbers();
    read_topics();
    if (cut_) find_rows();
  }

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_; }

  // The order first, of numbers alone: without an index on the time whole messages would be sorted. Those of rows,
  // since the column `id` of a table that was made by a query is no key: it may repeat, and is slow to look for.
  void select(const std::vector<std::string>& topics) override {
    wanted_.clear();
    for (const auto& [id, topic] : ids_)
      if (std::find(topics.begin(), topics.end(), topics_[topic].name) != topics.end()) wanted_.insert(id);
    last_.reset();
    next_row_ = lost_ = 0;
    order_.reset();
    if (!damaged_) order_ = prepare("SELECT rowid, timestamp, topic_id FROM messages ORDER BY timestamp, rowid");
    row_ = prepare("SELECT data FROM messages WHERE rowid = ?");
  }

  [[nodiscard]] Nanoseconds start() override {
    if (!damaged_) {
      const Statement least = prepare("SELECT timestamp FROM messages ORDER BY timestamp LIMIT 1");
      const int code = sqlite3_step(least.get());
      if (code == SQLITE_ROW) return sqlite3_column_int64(least.get(), 0);
      if (code == SQLITE_DONE) return 0;
      check_damaged(code);
      find_rows();
    }
    return rows_.front().time;
  }

  [[nodiscard]] bool next(RawMessage& message) override {
    while (const std::optional<Row> row = next_row()) {
      if (!wanted_.contains(row->topic)) continue;
      sqlite3_reset(row_.get());
      sqlite3_bind_int64(row_.get(), 1, row->number);
      const int code = sqlite3_step(row_.get());
      if (code == SQLITE_DONE) throw InputError(mark_, "is damaged: its index names a message that it does not hold");
      if (code != SQLITE_ROW) {
        check_damaged(code);
        if (!damaged_) find_rows();
        ++lost_;
        continue;
      }
      message.topic = ids_.at(row->topic);
      message.time = row->time;
      const auto* bytes = static_cast<const std::uint8_t*>(sqlite3_column_blob(row_.get(), 0));
      const auto size = static_cast<std::size_t>(sqlite3_column_bytes(row_.get(), 0));
      if (size == 0) throw InputError(mark_, "a message without bytes");
      if (zstd_ || is_zstd({bytes, size}))
        message.bytes = unpack_zstd({bytes, size});
      else
        message.bytes.assign(bytes, bytes + size);
      return true;
    }
    return false;
  }

  [[nodiscard]] std::vector<std::string> left_out() const override {
    if (!damaged_) return {};
    return {std::string("the bag is ") + (cut_ ? "cut off" : "damaged") + "; " + std::to_string(rows_.size()) +
            " of its messages could be found" +
            (lost_ == 0 ? "" : ", of which " + std::to_string(lost_) + " that are not whole are left out")};
  }

 private:
  /// Without metadata.yaml nothing else says that messages are packed. CDR begins with 0.
  [[nodiscard]] static bool is_zstd(std::span<const std::uint8_t> bytes) {
    constexpr std::array<std::uint8_t, 4> magic = {0x28, 0xB5, 0x2F, 0xFD};
    return bytes.size() >= magic.size() && std::ranges::equal(bytes.first(magic.size()), magic);
  }

  struct Row {
    Nanoseconds time = 0;
    sqlite3_int64 number = 0, topic = 0;

    [[nodiscard]] auto operator<=>(const Row&) const = default;
  };

  /// Whether it has fewer pages than its head says.
  [[nodiscard]] static bool is_cut(const InputFile& file) {
    std::array<std::uint8_t, 100> head{};
    if (std::fread(head.data(), 1, head.size(), file.stream.get()) != head.size()) return false;
    const auto number = [&](std::size_t at, std::size_t size) {
      std::uint64_t value = 0;
      for (std::size_t i = 0; i < size; ++i) value = value << 8U | head[at + i];
      return value;
    };
    const std::uint64_t page = number(16, 2) == 1 ? 65536 : number(16, 2), pages = number(28, 4);
    return number(24, 4) == number(92, 4) && file.bytes < page * pages;  // other numbers of pages are not kept
  }

  void check_damaged(int code) const {
    if ((code & 0xFF) != SQLITE_CORRUPT) fail();
  }

  /// In the order of time; nothing at the end.
  [[nodiscard]] std::optional<Row> next_row() {
    if (!damaged_ && order_) {
      const int code = sqlite3_step(order_.get());
      if (code == SQLITE_ROW) {
        last_ = Row{sqlite3_column_int64(order_.get(), 1), sqlite3_column_int64(order_.get(), 0),
                    sqlite3_column_int64(order_.get(), 2)};
        return last_;
      }
      order_.reset();  // a statement that has ended would begin again
      if (code == SQLITE_DONE) return std::nullopt;
      check_damaged(code);
      find_rows();
    }
    return next_row_ < rows_.size() ? std::optional(rows_[next_row_++]) : std::nullopt;
  }

  /// Of a damaged file: what its pages hold without its index. Behind a damaged page it is searched in leaps.
  void find_rows() {
    damaged_ = true;
    constexpr std::uint64_t least_row_bytes = 8;
    constexpr sqlite3_int64 most = std::numeric_limits<sqlite3_int64>::max();
    const Statement scan =
        prepare("SELECT timestamp, rowid, topic_id FROM messages NOT INDEXED WHERE rowid >= ? ORDER BY rowid");
    sqlite3_int64 from = 0, leap = 1;
    int code = SQLITE_CORRUPT;
    while (code != SQLITE_DONE && rows_.size() < bytes_ / least_row_bytes) {
      sqlite3_reset(scan.get());
      sqlite3_bind_int64(scan.get(), 1, from);
      while ((code = sqlite3_step(scan.get())) == SQLITE_ROW && rows_.size() < bytes_ / least_row_bytes) {
        const Row row{sqlite3_column_int64(scan.get(), 0), sqlite3_column_int64(scan.get(), 1),
                      sqlite3_column_int64(scan.get(), 2)};
        if (row.number < from || row.number == most) break;
        rows_.push_back(row);
        from = row.number + 1;
        leap = 1;
      }
      if (code != SQLITE_DONE && code != SQLITE_ROW) check_damaged(code);
      if (from > most - leap || leap > most / 2) break;
      from += leap;
      leap *= 2;
    }
    if (rows_.empty()) throw InputError(mark_, "is damaged or cut off, and holds no whole message");
    std::sort(rows_.begin(), rows_.end());
    const auto next = last_ ? std::upper_bound(rows_.begin(), rows_.end(), *last_) : rows_.begin();
    next_row_ = static_cast<std::size_t>(next - rows_.begin());
  }

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

  void need_row_numbers() const {
    sqlite3_stmt* raw = nullptr;
    const int code = sqlite3_prepare_v2(db_.get(), "SELECT rowid FROM messages", -1, &raw, nullptr);
    sqlite3_finalize(raw);
    if (code == SQLITE_OK) return;
    if (std::string_view(sqlite3_errmsg(db_.get())).find("rowid") == std::string_view::npos) fail();
    throw InputError(mark_, "its table 'messages' is WITHOUT ROWID; copy its rows to a table that has one");
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
  Statement order_{nullptr, &sqlite3_finalize}, row_{nullptr, &sqlite3_finalize};
  std::optional<Row> last_;  ///< of order_
  std::uint64_t bytes_ = 0;  ///< of the file
  bool cut_ = false, damaged_ = false;
  std::vector<Row> rows_;  ///< of a damaged file, by time
  std::size_t next_row_ = 0, lost_ = 0;
};

/// Several files of one bag, as one in the order of time. A file is begun when its first message may be the next.
class Files final : public MessageSource {
 public:
  /// said: what left_out() begins with.
  explicit Files(std::vector<std::unique_ptr<MessageSource>> files, std::vector<std::string> said = {})
      : files_(std::move(files)), said_(std::move(said)) {
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
    fronts_.clear();
    waiting_.clear();
    for (std::size_t i = 0; i < files_.size(); ++i) waiting_.emplace(files_[i]->start(), i);
  }
  [[nodiscard]] std::vector<std::string> left_out() const override {
    std::vector<std::string> all = said_;
    for (std::size_t i = 0; i < files_.size(); ++i)
      for (const std::string& said : files_[i]->left_out())
        all.push_back("file " + std::to_string(i + 1) + " of " + std::to_string(files_.size()) + ": " + said);
    return all;
  }
  [[nodiscard]] Nanoseconds start() override {
    Nanoseconds least = files_.front()->start();
    for (const auto& file : files_) least = std::min(least, file->start());
    return least;
  }
  [[nodiscard]] bool next(RawMessage& message) override {
    while (!waiting_.empty() && (fronts_.empty() || *waiting_.begin() < fronts_.begin()->first)) {
      const std::size_t file = waiting_.begin()->second;
      waiting_.erase(waiting_.begin());
      advance(file);
    }
    if (fronts_.empty()) return false;
    auto front = fronts_.extract(fronts_.begin());
    message = std::move(front.mapped());
    advance(front.key().second);
    return true;
  }

 private:
  void advance(std::size_t file) {
    RawMessage message;
    if (!files_[file]->next(message)) return;
    message.topic = topic_of_[file][message.topic];
    const std::pair key(message.time, file);
    fronts_.emplace(key, std::move(message));
  }

  std::vector<std::unique_ptr<MessageSource>> files_;
  std::vector<std::string> said_;
  std::vector<std::vector<std::size_t>> topic_of_;
  std::vector<BagTopic> topics_;
  std::set<std::pair<Nanoseconds, std::size_t>> waiting_;  ///< files that are not begun, by their start
  std::map<std::pair<Nanoseconds, std::size_t>, RawMessage> fronts_;
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
  const fs::path named = fs::path(folder) / relative;
  if (fs::exists(named) || std::distance(relative.begin(), relative.end()) < 2) return named.string();
  // Until version 3 of the metadata names began with the folder's own, as it was when the bag was recorded.
  const fs::path in_folder = fs::path(folder) / relative.lexically_relative(*relative.begin());
  return (fs::exists(in_folder) ? in_folder : named).string();
}

/// Of a folder without metadata.yaml.
std::unique_ptr<MessageSource> open_bag_files(const std::string& folder, const BagFiles& found) {
  std::vector<std::unique_ptr<MessageSource>> files;
  const auto open_bytes = std::make_shared<std::size_t>(0);
  for (const std::string& name : found.names) {
    const std::string file = folder + "/" + name;
    files.push_back(has_ending(name, ".mcap") ? open_mcap(file, open_bytes) : open_rosbag2_database(file));
  }
  std::vector<std::string> said;
  if (!found.missing.empty()) said.push_back("the bag's file '" + found.missing + "' is missing");
  return std::make_unique<Files>(std::move(files), std::move(said));
}

}  // namespace

std::unique_ptr<MessageSource> open_rosbag2_database(const std::string& path, bool zstd) {
  return std::make_unique<DatabaseReader>(path, zstd);
}

std::unique_ptr<MessageSource> open_rosbag2_folder(const std::string& folder) {
  constexpr std::uint64_t most_metadata_bytes = 16U << 20U;
  const std::string path = folder + "/metadata.yaml";
  if (const BagFiles found = find_bag_files(folder); !found.names.empty()) return open_bag_files(folder, found);
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
  const auto open_bytes = std::make_shared<std::size_t>(0);
  for (const Tree& name : need(info, "relative_file_paths").as_list()) {
    const std::string file = path_of(folder, name);
    if (!fs::exists(file)) throw InputError(name.mark, "names '" + name.as_string() + "', which is missing");
    files.push_back(storage == "mcap" ? open_mcap(file, open_bytes) : open_rosbag2_database(file, zstd));
  }
  if (files.empty()) throw InputError(info.mark, "names no file");
  return std::make_unique<Files>(std::move(files));
}

}  // namespace plumbline::slam
