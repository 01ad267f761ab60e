// SPDX-License-Identifier: Apache-2.0
#include "slam/io/ros2/mcap_reader.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <span>

#include "bim/config/input_file.h"
#include "bim/errors.h"
#include "slam/io/ros2/compression.h"
#include "slam/io/ros2/mcap_format.h"

namespace plumbline::slam {

namespace {

using mcap::Op;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t most_name_bytes = 4096;

std::uint32_t checksum(std::uint32_t before, std::span<const std::uint8_t> bytes) {
  return static_cast<std::uint32_t>(::crc32_z(before, bytes.data(), bytes.size()));
}

/// Values one after the other, of a record.
class Values {
 public:
  explicit Values(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  std::span<const std::uint8_t> take(std::uint64_t size) {
    if (size > rest_.size()) throw InputError({}, "a record that says more than it holds");
    const auto front = rest_.first(size);
    rest_ = rest_.subspan(size);
    return front;
  }
  template <class T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  std::string text() {
    const auto bytes = take(number<std::uint32_t>());
    return {bytes.begin(), bytes.end()};
  }
  [[nodiscard]] std::span<const std::uint8_t> rest() const { return rest_; }

 private:
  std::span<const std::uint8_t> rest_;
};

struct Head {
  Op op{};
  std::uint64_t size = 0;
};

Head head_of(std::span<const std::uint8_t> bytes) {
  Values values(bytes);
  const auto op = values.number<std::uint8_t>();
  return {static_cast<Op>(op), values.number<std::uint64_t>()};
}

class McapReader final : public MessageSource {
 public:
  explicit McapReader(const std::string& path) : mark_{path, 0, 0}, file_(open_input_file(path)) {
    guarded([&] {
      std::fseek(file_.stream.get(), 0, SEEK_END);
      size_ = static_cast<std::uint64_t>(std::ftell(file_.stream.get()));
      read_ends();
      if (!read_summary()) read_all_channels();
    });
  }

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_; }

  void select(const std::vector<std::string>& topics) override {
    wanted_.clear();
    for (const auto& [id, topic] : channels_)
      if (std::find(topics.begin(), topics.end(), topics_[topic].name) != topics.end()) wanted_.insert(id);
    at_ = mcap::magic.size();
    chunk_.clear();
    in_chunk_ = 0;
    chunks_seen_ = 0;
  }

  [[nodiscard]] bool next(RawMessage& message) override {
    bool found = false;
    guarded([&] { found = find_next(message); });
    return found;
  }

 private:
  template <class F>
  void guarded(const F& function) {
    try {
      function();
    } catch (const InputError& error) {
      if (std::string_view(error.what()).starts_with(mark_.file)) throw;
      throw InputError(mark_, "byte " + std::to_string(record_at_) + ": " + error.what());
    }
  }

  Bytes read(std::uint64_t at, std::uint64_t size) {
    if (at > size_ || size > size_ - at) throw InputError({}, "a record that goes beyond the file's end");
    Bytes bytes(size);
    std::fseek(file_.stream.get(), static_cast<long>(at), SEEK_SET);
    if (std::fread(bytes.data(), 1, size, file_.stream.get()) != size) throw InputError({}, "cannot be read");
    return bytes;
  }

  /// Magic at both ends, and the footer.
  void read_ends() {
    const std::uint64_t least = 2 * mcap::magic.size() + mcap::head_bytes + mcap::footer_bytes;
    const auto is_magic = [&](std::uint64_t at) {
      return std::ranges::equal(read(at, mcap::magic.size()), mcap::magic);
    };
    if (size_ < least || !is_magic(size_ - mcap::magic.size()))
      throw InputError(mark_, "an MCAP file that was not closed or is cut off; `mcap recover` may save it");
    if (!is_magic(0)) throw InputError(mark_, "is no MCAP file");
    record_at_ = size_ - mcap::magic.size() - mcap::footer_bytes - mcap::head_bytes;
    const Bytes footer = read(record_at_, mcap::head_bytes + mcap::footer_bytes);
    const Head head = head_of(footer);
    if (head.op != Op::footer || head.size != mcap::footer_bytes)
      throw InputError({}, "no footer where an MCAP file ends");
    Values values(std::span<const std::uint8_t>(footer).subspan(mcap::head_bytes));
    summary_at_ = values.number<std::uint64_t>();
    static_cast<void>(values.number<std::uint64_t>());
    summary_crc_ = values.number<std::uint32_t>();
    footer_at_ = record_at_;
    if (summary_at_ > footer_at_) throw InputError({}, "a summary that begins beyond the file's end");
    data_end_ = summary_at_ == 0 ? footer_at_ : summary_at_;
  }

  /// False where there is none that could be used.
  bool read_summary() {
    if (summary_at_ == 0 || summary_at_ == footer_at_) return false;
    record_at_ = summary_at_;
    constexpr std::uint64_t most_summary = std::uint64_t{1} << 28U;
    if (footer_at_ - summary_at_ > most_summary) throw InputError({}, "a summary of more than 256 MiB");
    const std::uint64_t checked = footer_at_ + mcap::head_bytes + mcap::footer_bytes - 4 - summary_at_;
    const Bytes bytes = read(summary_at_, checked);
    if (summary_crc_ != 0 && checksum(0, bytes) != summary_crc_)
      throw InputError({}, "a summary whose checksum is wrong");
    for (std::uint64_t at = 0; at < footer_at_ - summary_at_;) {
      record_at_ = summary_at_ + at;
      const auto [head, content] = record_in(std::span(bytes).first(footer_at_ - summary_at_), at);
      take_definition(head.op, content);
      if (head.op == Op::chunk_index) take_chunk_index(content);
      at += mcap::head_bytes + head.size;
    }
    return !channels_.empty();
  }

  /// A file that was written as a stream says nothing at its end.
  void read_all_channels() {
    RawMessage message;
    at_ = mcap::magic.size();
    while (find_next(message)) continue;
  }

  static std::pair<Head, std::span<const std::uint8_t>> record_in(std::span<const std::uint8_t> bytes,
                                                                  std::uint64_t at) {
    const auto rest = bytes.subspan(at);
    const Head head = head_of(rest);
    if (head.size > rest.size() - mcap::head_bytes) throw InputError({}, "a record that goes beyond what it stands in");
    return {head, rest.subspan(mcap::head_bytes, head.size)};
  }

  void take_definition(Op op, std::span<const std::uint8_t> content) {
    Values values(content);
    const auto short_text = [&] {
      std::string text = values.text();
      if (text.size() > most_name_bytes) throw InputError({}, "a name of more than 4 KiB");
      return text;
    };
    if (op == Op::schema) {
      const auto id = values.number<std::uint16_t>();
      schemas_[id] = short_text();
    } else if (op == Op::channel) {
      const auto id = values.number<std::uint16_t>(), schema = values.number<std::uint16_t>();
      BagTopic topic;
      topic.name = short_text();
      const std::string encoding = short_text();
      topic.type = plain_type(schemas_[schema]);
      topic.encoding = encoding == "cdr" ? Encoding::cdr : encoding == "ros1" ? Encoding::ros1 : Encoding::unknown;
      if (const auto known = channels_.find(id); known != channels_.end()) {
        if (topics_[known->second].name != topic.name)
          throw InputError({}, "channel " + std::to_string(id) + " is of two topics");
        return;
      }
      channels_[id] = topics_.size();
      topics_.push_back(std::move(topic));
    }
  }

  void take_chunk_index(std::span<const std::uint8_t> content) {
    Values values(content);
    static_cast<void>(values.take(16));
    const auto at = values.number<std::uint64_t>();
    static_cast<void>(values.number<std::uint64_t>());
    Values offsets(values.take(values.number<std::uint32_t>()));
    std::set<std::uint16_t>& channels = chunk_channels_[at];
    while (!offsets.rest().empty()) {
      channels.insert(offsets.number<std::uint16_t>());
      static_cast<void>(offsets.number<std::uint64_t>());
    }
  }

  /// Whether the summary says that a chunk holds nothing that is asked for.
  [[nodiscard]] bool may_skip(std::uint64_t chunk_at) const {
    const auto found = chunk_channels_.find(chunk_at);
    return found != chunk_channels_.end() && !found->second.empty() &&
           std::none_of(found->second.begin(), found->second.end(),
                        [&](std::uint16_t id) { return wanted_.contains(id); });
  }

  bool find_next(RawMessage& message) {
    for (;;) {
      while (in_chunk_ < chunk_.size()) {
        const auto [head, content] = record_in(chunk_, in_chunk_);
        in_chunk_ += mcap::head_bytes + head.size;
        if (head.op == Op::message && take_message(content, message)) return true;
        take_definition(head.op, content);
      }
      if (at_ + mcap::head_bytes > data_end_) return at_end();
      record_at_ = at_;
      const Head head = head_of(read(at_, mcap::head_bytes));
      if (head.size > data_end_ - at_ - mcap::head_bytes)
        throw InputError({}, "a record that goes beyond the data's end");
      const std::uint64_t content_at = at_ + mcap::head_bytes;
      at_ = content_at + head.size;
      if (head.op == Op::data_end) return at_end();
      chunks_seen_ += head.op == Op::chunk ? 1 : 0;
      if (head.op == Op::chunk && !may_skip(record_at_)) open_chunk(read(content_at, head.size));
      if (head.op == Op::message && !chunk_channels_.empty())
        throw InputError({}, "a message outside of the chunks that the file's index has");
      if (head.op == Op::schema || head.op == Op::channel || head.op == Op::message) {
        const Bytes content = read(content_at, head.size);
        if (head.op == Op::message && take_message(content, message)) return true;
        take_definition(head.op, content);
      }
    }
  }

  /// What the index has and the data does not is lost.
  [[nodiscard]] bool at_end() const {
    if (!chunk_channels_.empty() && chunks_seen_ != chunk_channels_.size())
      throw InputError(
          {}, std::to_string(chunks_seen_) + " chunks where the index has " + std::to_string(chunk_channels_.size()));
    return false;
  }

  bool take_message(std::span<const std::uint8_t> content, RawMessage& message) {
    Values values(content);
    const auto id = values.number<std::uint16_t>();
    static_cast<void>(values.take(4 + 8 + 8));
    if (!wanted_.contains(id)) return false;
    message.topic = channels_.at(id);
    message.bytes.assign(values.rest().begin(), values.rest().end());
    return true;
  }

  void open_chunk(const Bytes& content) {
    Values values(content);
    static_cast<void>(values.take(16));
    const auto size = values.number<std::uint64_t>();
    const auto crc = values.number<std::uint32_t>();
    const std::string compression = values.text();
    chunk_ = unpack(compression, values.take(values.number<std::uint64_t>()), size);
    in_chunk_ = 0;
    if (crc != 0 && checksum(0, chunk_) != crc) throw InputError({}, "a chunk whose checksum is wrong");
  }

  Mark mark_;
  InputFile file_;
  std::uint64_t size_ = 0, footer_at_ = 0, summary_at_ = 0, data_end_ = 0;
  std::uint32_t summary_crc_ = 0;
  std::vector<BagTopic> topics_;
  std::map<std::uint16_t, std::string> schemas_;                     ///< names of types
  std::map<std::uint16_t, std::size_t> channels_;                    ///< to topics
  std::map<std::uint64_t, std::set<std::uint16_t>> chunk_channels_;  ///< by where the chunk begins
  std::set<std::uint16_t> wanted_;
  std::uint64_t at_ = 0;  ///< of the next record of the data
  std::size_t chunks_seen_ = 0;
  std::uint64_t record_at_ = 0;  ///< of the one being read, for messages
  Bytes chunk_;
  std::size_t in_chunk_ = 0;
};

}  // namespace

std::unique_ptr<MessageSource> open_mcap(const std::string& path) { return std::make_unique<McapReader>(path); }

}  // namespace plumbline::slam
