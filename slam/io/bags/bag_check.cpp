// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/bag_check.h"

#include <bzlib.h>
#include <roslz4/lz4s.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "bim/config/input_file.h"
#include "bim/errors.h"

namespace plumbline::slam {

namespace {

constexpr std::uint64_t first_record = 13;  ///< after "#ROSBAG V2.0\n"
constexpr std::uint64_t most_header_bytes = std::uint64_t{1} << 20U;
constexpr std::uint64_t most_connection_bytes = std::uint64_t{1} << 24U;
constexpr std::uint64_t most_chunk_bytes = std::uint64_t{1} << 28U;

/// Kinds of records.
enum class Op : unsigned char { message = 2, bag = 3, index = 4, chunk = 5, chunk_info = 6, connection = 7 };

using Fields = std::map<std::string, std::string_view, std::less<>>;

template <class T>
T number_at(std::string_view bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof(T));  // little endian, as every CPU that this is built for
  return value;
}

/// "name=value" each, its length before it.
Fields fields_of(std::string_view header) {
  Fields fields;
  while (!header.empty()) {
    if (header.size() < 4) throw InputError({}, "a header that ends in the middle of a field");
    const auto length = number_at<std::uint32_t>(header, 0);
    header.remove_prefix(4);
    const std::string_view field = header.substr(0, length);
    const std::size_t equals = field.find('=');
    if (field.size() != length || equals == std::string_view::npos)
      throw InputError({}, "a header with a field that is longer than the header, or is none");
    fields.insert_or_assign(std::string(field.substr(0, equals)), field.substr(equals + 1));
    header.remove_prefix(length);
  }
  return fields;
}

std::string_view text_of(const Fields& fields, std::string_view name) {
  const auto found = fields.find(name);
  if (found == fields.end()) throw InputError({}, "a header without '" + std::string(name) + "'");
  return found->second;
}

template <class T>
T value_of(const Fields& fields, std::string_view name) {
  const std::string_view text = text_of(fields, name);
  if (text.size() != sizeof(T)) throw InputError({}, "a header whose '" + std::string(name) + "' has another length");
  return number_at<T>(text, 0);
}

Op op_of(const Fields& fields) { return static_cast<Op>(value_of<unsigned char>(fields, "op")); }

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
    const std::string_view rest = bytes.substr(at);
    const auto fail = [] { throw InputError({}, "a chunk with a record that is longer than the chunk"); };
    if (rest.size() < 8) fail();
    const std::uint64_t header = number_at<std::uint32_t>(rest, 0);
    if (header > rest.size() - 8) fail();
    const std::uint64_t data = number_at<std::uint32_t>(rest, 4 + header);
    if (data > rest.size() - 8 - header) fail();
    const Fields fields = fields_of(rest.substr(4, header));
    const Op op = op_of(fields);
    if (op != Op::message && op != Op::connection)
      throw InputError({}, "a chunk with a record of another kind than messages");
    (void)value_of<std::uint32_t>(fields, "conn");
    records.starts.push_back(static_cast<std::uint32_t>(at));
    if (op == Op::message) {
      (void)value_of<std::uint64_t>(fields, "time");
      records.last_message = static_cast<std::uint32_t>(at);
      records.any_message = true;
    } else {
      (void)text_of(fields, "topic");
    }
    at += 8 + header + data;
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
    if (index_at < at_ || index_at > file_.bytes)
      throw InputError({}, "a bag that was not closed or is cut off; rosbag reindex may save it");
    while (at_ < index_at) check_record();
    if (at_ != index_at) throw InputError({}, "a record that reaches into the bag's index");
    for (std::uint32_t i = 0; i < connections; ++i) check_connection();
    for (std::uint32_t i = 0; i < chunks; ++i) check_chunk_info();
  }

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
    if (left() < 4) throw InputError({}, "the bag ends in the middle of a record");
    const std::uint64_t bytes = number_at<std::uint32_t>(take(4, small_), 0);
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
    return fields_of(take(length(most_header_bytes), header_));
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
    const std::string compression(text_of(fields, "compression"));
    const std::uint64_t size = value_of<std::uint32_t>(fields, "size");
    const std::uint64_t packed = data_bytes(most_chunk_bytes);
    if (size > most_chunk_bytes)
      throw InputError({}, "a chunk of " + std::to_string(size) + " bytes; at most " +
                               std::to_string(most_chunk_bytes) + " are read");
    constexpr std::uint64_t most_lz4 = 255;  // times smaller
    if ((compression == "none" && size != packed) || (compression == "lz4" && size > most_lz4 * packed))
      throw InputError({},
                       "a chunk of " + std::to_string(packed) + " bytes that says it holds " + std::to_string(size));
    const std::string_view data = take(packed, packed_);
    return records_in(compression == "none" ? data : unpack(compression, size));
  }

  [[nodiscard]] std::string_view unpack(const std::string& compression, std::uint64_t size) {
    unpacked_.resize(static_cast<std::size_t>(size));
    auto got = static_cast<unsigned>(size);
    const auto from = static_cast<unsigned>(packed_.size());
    bool good = false;
    if (compression == "lz4")
      good = roslz4_buffToBuffDecompress(packed_.data(), from, unpacked_.data(), &got) == ROSLZ4_OK;
    else if (compression == "bz2")
      good = BZ2_bzBuffToBuffDecompress(unpacked_.data(), &got, packed_.data(), from, 0, 0) == BZ_OK;
    else
      throw InputError({}, "a chunk packed by '" + compression.substr(0, 40) + "'; lz4, bz2 or none would be right");
    if (!good || got != size) throw InputError({}, "a chunk that cannot be unpacked");
    return {unpacked_.data(), unpacked_.size()};
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
  std::uint64_t at_ = first_record, start_ = first_record;
  std::uint64_t stream_at_ = 0;  ///< seeking would empty its buffer
  std::vector<char> small_, header_, packed_, unpacked_;
  ChunkRecords chunk_;                            ///< of the last one
  std::map<std::uint64_t, std::size_t> indexes_;  ///< how many follow a chunk, by its place
  std::size_t* indexes_of_ = nullptr;             ///< that of the last chunk
};

}  // namespace

void check_bag(const std::string& path) {
  Checker checker(path);
  try {
    checker.check();
  } catch (const InputError& error) {
    throw InputError({path, 0, 0}, "byte " + std::to_string(checker.start()) + ": " + error.what());
  }
}

}  // namespace plumbline::slam
