// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/bag_check.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "bim/config/input_file.h"
#include "bim/errors.h"
#include "slam/io/bags/ros1_records.h"

namespace plumbline::slam {

namespace {

constexpr std::uint64_t most_connection_bytes = std::uint64_t{1} << 24U;

using ros1::Fields;
using ros1::fields_of;
using ros1::number_at;
using ros1::Op;
using ros1::op_of;
using ros1::text_of;
using ros1::value_of;

/// Where the records of a chunk begin.
struct ChunkRecords {
  std::vector<std::uint32_t> starts;  ///< in order
  std::uint32_t last_message = 0;
  bool any_message = false;

  /// rosbag reads on from an entry of the index over connections to a message.
  [[nodiscard]] bool leads_to_message(std::uint32_t offset) const {
    return any_message && offset <= last_message && std::binary_search(starts.begin(), starts.end(), offset);
  }
};

ChunkRecords records_in(std::string_view bytes) {
  ChunkRecords records;
  for (std::size_t at = 0; at < bytes.size();) {
    const ros1::Record record = ros1::record_at(bytes, at);
    records.starts.push_back(static_cast<std::uint32_t>(at));
    if (op_of(record.fields) == Op::message) {
      records.last_message = static_cast<std::uint32_t>(at);
      records.any_message = true;
    }
    at += record.bytes;
  }
  return records;
}

class Checker {
 public:
  explicit Checker(const std::string& path) : file_(open_input_file(path)) {}

  void check() {
    const Fields head = next_header();
    if (op_of(head) != Op::bag) throw InputError({}, "the first record is not that of the bag");
    if (head.contains("encryptor") && !text_of(head, "encryptor").empty())
      throw InputError({}, "an encrypted bag, which is not read");
    const auto index_at = value_of<std::uint64_t>(head, "index_pos");
    const auto connections = value_of<std::uint32_t>(head, "conn_count");
    const auto chunks = value_of<std::uint32_t>(head, "chunk_count");
    skip(data_bytes());
    if (index_at < at_ || index_at > file_.bytes) throw NoIndex({}, "a bag that was not closed or is cut off");
    while (at_ < index_at) check_record();
    if (at_ != index_at) throw InputError({}, "a record that reaches into the bag's index");
    in_index_ = true;
    for (std::uint32_t i = 0; i < connections; ++i) check_connection();
    for (std::uint32_t i = 0; i < chunks; ++i) check_chunk_info();
  }

  [[nodiscard]] bool rosbag_unpacks() const { return rosbag_unpacks_; }
  /// Of the record that is being read.
  [[nodiscard]] std::uint64_t start() const { return start_; }

 private:
  [[nodiscard]] std::uint64_t left() const { return file_.bytes - at_; }

  /// The next bytes, of a number that was checked.
  [[nodiscard]] std::string_view take(std::uint64_t bytes, std::vector<char>& buffer) {
    buffer.resize(static_cast<std::size_t>(bytes));
    const bool moved = stream_at_ == at_ || ::fseeko(file_.stream.get(), static_cast<off_t>(at_), SEEK_SET) == 0;
    if (!moved || std::fread(buffer.data(), 1, buffer.size(), file_.stream.get()) != buffer.size())
      throw InputError({}, "cannot be read");
    stream_at_ = at_ += bytes;
    return {buffer.data(), buffer.size()};
  }

  void skip(std::uint64_t bytes) { at_ += bytes; }

  std::uint64_t length(std::uint64_t most) {
    if (in_index_ && left() < 4) throw NoIndex({}, "the bag ends in the middle of its index");
    if (left() < 4) throw InputError({}, "the bag ends in the middle of a record");
    const std::uint64_t bytes = number_at<std::uint32_t>(take(4, small_), 0);
    if (in_index_ && bytes > left()) throw NoIndex({}, "the bag ends in the middle of its index");
    if (bytes > left())
      throw InputError({},
                       "a length of " + std::to_string(bytes) + " bytes where " + std::to_string(left()) + " are left");
    if (bytes > most)
      throw InputError(
          {}, "a length of " + std::to_string(bytes) + " bytes; at most " + std::to_string(most) + " are read");
    return bytes;
  }

  [[nodiscard]] Fields next_header() {
    start_ = at_;
    return fields_of(take(length(ros1::most_header_bytes), header_));
  }

  std::uint64_t data_bytes(std::uint64_t most = std::uint64_t{1} << 32U) { return length(most); }

  void check_record() {
    const std::uint64_t record = at_;
    const Fields fields = next_header();
    const Op op = op_of(fields);
    if (op == Op::chunk) {
      chunk_ = unpacked(fields);
      indexes_of_ = &indexes_[record];
      *indexes_of_ = 0;
    } else if (op == Op::index) {
      check_index(fields);
    } else {
      skip(data_bytes());
    }
  }

  /// Records of a chunk, checked.
  [[nodiscard]] ChunkRecords unpacked(const Fields& fields) {
    (void)take(data_bytes(ros1::most_chunk_bytes), packed_);
    rosbag_unpacks_ = rosbag_unpacks_ && ros1::rosbag_unpacks(fields, packed_);
    return records_in(ros1::unpack_chunk(fields, packed_, unpacked_));
  }

  void check_index(const Fields& fields) {
    constexpr std::uint64_t entry_bytes = 12;
    if (indexes_of_ == nullptr) throw InputError({}, "an index before the first chunk");
    if (value_of<std::uint32_t>(fields, "ver") != 1) throw InputError({}, "an index of another version than 1");
    (void)value_of<std::uint32_t>(fields, "conn");
    const std::uint64_t count = value_of<std::uint32_t>(fields, "count");
    const std::uint64_t bytes = data_bytes();
    if (bytes != entry_bytes * count) throw InputError({}, "an index whose length is not that of its entries");
    for (std::uint64_t i = 0; i < count; ++i)
      if (!chunk_.leads_to_message(number_at<std::uint32_t>(take(entry_bytes, small_), 8)))
        throw InputError({}, "an index that points to no message of its chunk");
    ++*indexes_of_;
  }

  void check_connection() {
    const Fields fields = next_header();
    if (op_of(fields) != Op::connection) throw InputError({}, "a record among the connections that is none");
    (void)value_of<std::uint32_t>(fields, "conn");
    (void)text_of(fields, "topic");
    const Fields said = fields_of(take(data_bytes(most_connection_bytes), small_));
    for (const char* name : {"type", "md5sum", "message_definition"}) (void)text_of(said, name);
  }

  void check_chunk_info() {
    constexpr std::uint64_t entry_bytes = 8;
    const Fields fields = next_header();
    if (op_of(fields) != Op::chunk_info || value_of<std::uint32_t>(fields, "ver") != 1)
      throw InputError({}, "a record among the chunks' places that is none of version 1");
    (void)value_of<std::uint64_t>(fields, "start_time");
    (void)value_of<std::uint64_t>(fields, "end_time");
    const auto place = indexes_.find(value_of<std::uint64_t>(fields, "chunk_pos"));
    if (place == indexes_.end()) throw InputError({}, "the place of a chunk where none is");
    const std::uint64_t count = value_of<std::uint32_t>(fields, "count");
    const std::uint64_t bytes = data_bytes();
    if (bytes != entry_bytes * count) throw InputError({}, "a chunk's place whose length is not that of its entries");
    std::set<std::uint32_t> connections;
    for (std::uint64_t i = 0; i < count; ++i)
      connections.insert(number_at<std::uint32_t>(take(entry_bytes, small_), 0));
    if (connections.size() > place->second) throw InputError({}, "a chunk with fewer indexes than connections");
  }

  InputFile file_;
  std::uint64_t at_ = ros1::first_record, start_ = ros1::first_record;
  bool in_index_ = false;  ///< behind the last chunk
  bool rosbag_unpacks_ = true;
  std::uint64_t stream_at_ = 0;  ///< seeking would empty its buffer
  std::vector<char> small_, header_, packed_, unpacked_;
  ChunkRecords chunk_;                            ///< of the last one
  std::map<std::uint64_t, std::size_t> indexes_;  ///< how many follow a chunk, by its place
  std::size_t* indexes_of_ = nullptr;             ///< that of the last chunk
};

}  // namespace

bool check_bag(const std::string& path) {
  Checker checker(path);
  const auto place = [&] { return "byte " + std::to_string(checker.start()) + ": "; };
  try {
    checker.check();
    return checker.rosbag_unpacks();
  } catch (const NoIndex& error) {
    throw NoIndex({path, 0, 0}, place() + error.what());
  } catch (const InputError& error) {
    throw InputError({path, 0, 0}, place() + error.what());
  }
}

}  // namespace plumbline::slam
