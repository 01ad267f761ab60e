// SPDX-License-Identifier: Apache-2.0
#include "slam/io/ros2/mcap_reader.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <span>

#include "bim/config/input_file.h"
#include "bim/errors.h"
#include "slam/io/ros2/mcap_chunk.h"
#include "slam/io/ros2/mcap_format.h"
#include "slam/io/ros2/mcap_losses.h"
#include "slam/io/ros2/mcap_values.h"

namespace plumbline::slam {

namespace {

using mcap::first_time;
using mcap::Head;
using mcap::head_of;
using mcap::Op;
using mcap::record_in;
using mcap::time_of;
using mcap::Values;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t most_name_bytes = 4096;
constexpr std::size_t most_open_bytes = std::size_t{1} << 30U;

class McapReader final : public MessageSource {
 public:
  McapReader(const std::string& path, std::shared_ptr<std::size_t> open_bytes)
      : mark_{path, 0, 0}, file_(open_input_file(path)), open_bytes_(std::move(open_bytes)) {
    guarded([&] {
      std::fseek(file_.stream.get(), 0, SEEK_END);
      size_ = static_cast<std::uint64_t>(std::ftell(file_.stream.get()));
      read_ends();
      const bool known = read_summary();
      find_blocks();
      if (!known) read_all_channels();
    });
  }

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_; }

  void select(const std::vector<std::string>& topics) override {
    wanted_.clear();
    for (const auto& [id, topic] : channels_)
      if (std::find(topics.begin(), topics.end(), topics_[topic].name) != topics.end()) wanted_.insert(id);
    for (const auto& [key, block] : open_) *open_bytes_ -= block.bytes.size();
    open_.clear();
    next_block_ = 0;
  }

  [[nodiscard]] bool next(RawMessage& message) override {
    bool found = false;
    guarded([&] { found = find_next(message); });
    return found;
  }

  [[nodiscard]] std::vector<std::string> left_out() const override { return losses_.lines(size_); }

  [[nodiscard]] Nanoseconds start() override { return blocks_.empty() ? 0 : blocks_.front().start; }

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

  /// Magic at both ends, and the footer, which a file that was not closed lacks.
  void read_ends() {
    const std::uint64_t least = 2 * mcap::magic.size() + mcap::head_bytes + mcap::footer_bytes;
    const auto is_magic = [&](std::uint64_t at) {
      return std::ranges::equal(read(at, mcap::magic.size()), mcap::magic);
    };
    if (size_ < mcap::magic.size() || !is_magic(0)) throw InputError(mark_, "is no MCAP file");
    if (size_ < least || !is_magic(size_ - mcap::magic.size())) {
      losses_.unclosed = true;
      data_end_ = size_;
      return;
    }
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

  /// False where there is none that could be used, or types of channels are missing.
  bool read_summary() {
    if (summary_at_ == 0 || summary_at_ == footer_at_) return false;
    record_at_ = summary_at_;
    constexpr std::uint64_t most_summary = std::uint64_t{1} << 28U;
    if (footer_at_ - summary_at_ > most_summary) throw InputError({}, "a summary of more than 256 MiB");
    const std::uint64_t checked = footer_at_ + mcap::head_bytes + mcap::footer_bytes - 4 - summary_at_;
    const Bytes bytes = read(summary_at_, checked);
    if (summary_crc_ != 0 && mcap::checksum(0, bytes) != summary_crc_)
      throw InputError({}, "a summary whose checksum is wrong");
    for (std::uint64_t at = 0; at < footer_at_ - summary_at_;) {
      record_at_ = summary_at_ + at;
      const auto [head, content] = record_in(std::span(bytes).first(footer_at_ - summary_at_), at);
      take_definition(head.op, content);
      if (head.op == Op::chunk_index) take_chunk_index(content);
      at += mcap::head_bytes + head.size;
    }
    return !channels_.empty() && untyped_.empty();
  }

  /// Chunks, and messages that stand outside of any, in runs.
  void find_blocks() {
    std::uint64_t at = mcap::magic.size();
    bool ended = false;
    while (!ended && at + mcap::head_bytes <= data_end_) {
      record_at_ = at;
      const Head head = head_of(read(at, mcap::head_bytes));
      const bool is_whole = head.size <= data_end_ - at - mcap::head_bytes;
      if (losses_.unclosed && (!is_whole || head.op == Op::none)) {
        if (head.op == Op::chunk) add_cut_chunk(at);
        break;
      }
      if (!is_whole) throw InputError({}, "a record that goes beyond the data's end");
      ended = head.op == Op::data_end;
      if (ended) break;
      losses_.chunks += head.op == Op::chunk ? 1 : 0;
      if (head.op == Op::chunk || head.op == Op::message) add_block(head, at);
      const std::uint64_t content_at = at + mcap::head_bytes;
      at = content_at + head.size;
      if (head.op == Op::schema || head.op == Op::channel) take_definition(head.op, read(content_at, head.size));
    }
    if (losses_.unclosed) leave_out_rest(ended ? size_ : at);
    // What the index has and the data does not is lost.
    if (!chunk_channels_.empty() && losses_.chunks != chunk_channels_.size())
      throw InputError(
          {}, std::to_string(losses_.chunks) + " chunks where the index has " + std::to_string(chunk_channels_.size()));
    for (Block& block : blocks_)
      if (block.chunk && block.start == 0)
        block.start = first_time(whole_bytes_of(block));  // some writers leave it out
    std::stable_sort(blocks_.begin(), blocks_.end(), [](const Block& a, const Block& b) { return a.start < b.start; });
  }

  /// Of a file that was not closed; its last chunk may have its length and not all of its bytes.
  void leave_out_rest(std::uint64_t whole_until) {
    if (!blocks_.empty() && blocks_.back().chunk) {
      try {
        static_cast<void>(first_time(bytes_of(blocks_.back())));
      } catch (const InputError&) {
        whole_until = blocks_.back().at;
        blocks_.pop_back();
      }
    }
    if (blocks_.empty()) throw InputError(mark_, "an MCAP file that was not closed and holds no whole message");
    losses_.rest_bytes = size_ - whole_until;
  }

  void add_block(const Head& head, std::uint64_t at) {
    constexpr std::uint64_t run_bytes = 4U << 20U, time_at = 6;  // after channel and number of a message
    const bool chunk = head.op == Op::chunk;
    if (!chunk && !chunk_channels_.empty())
      throw InputError({}, "a message outside of the chunks that the file's index has");
    const Bytes front = read(at + mcap::head_bytes, std::min<std::uint64_t>(head.size, 16));
    Values values(front);
    if (!chunk) static_cast<void>(values.take(time_at));
    const auto start = static_cast<Nanoseconds>(values.number<std::uint64_t>());
    const std::uint64_t end = at + mcap::head_bytes + head.size;
    if (!chunk && !blocks_.empty() && !blocks_.back().chunk && blocks_.back().end == at &&
        end - blocks_.back().at <= run_bytes) {
      blocks_.back().end = end;
      blocks_.back().start = std::min(blocks_.back().start, start);
    } else {
      blocks_.push_back({at, end, start, chunk, false});
    }
  }

  /// That the file ends in; nothing where no message of it is whole.
  void add_cut_chunk(std::uint64_t at) {
    constexpr std::uint64_t most_bytes = std::uint64_t{1} << 30U;
    if (size_ - at > most_bytes) return;
    try {
      Block block{at, size_, 0, true, true};
      losses_.messages_of_cut = mcap::count_messages(bytes_of(block));
      block.start = first_time(bytes_of(block));
      if (losses_.messages_of_cut > 0) blocks_.push_back(block);
    } catch (const InputError&) {  // not even its head
    }
  }

  /// A file that was written as a stream says nothing at its end.
  void read_all_channels() {
    for (const Block& block : blocks_)
      if (block.chunk) static_cast<void>(read_block(block));
    losses_.refuse_if_all_is_damaged();
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
      std::erase_if(untyped_, [&](const auto& channel) {
        if (channel.second == id) topics_[channels_.at(channel.first)].type = plain_type(schemas_[id]);
        return channel.second == id;
      });
    } else if (op == Op::channel) {
      const auto id = values.number<std::uint16_t>(), schema = values.number<std::uint16_t>();
      BagTopic topic;
      topic.name = short_text();
      const std::string encoding = short_text();
      if (const auto type = schemas_.find(schema); type != schemas_.end()) topic.type = plain_type(type->second);
      topic.encoding = encoding == "cdr" ? Encoding::cdr : encoding == "ros1" ? Encoding::ros1 : Encoding::unknown;
      if (const auto known = channels_.find(id); known != channels_.end()) {
        if (topics_[known->second].name != topic.name)
          throw InputError({}, "channel " + std::to_string(id) + " is of two topics");
        if (topics_[known->second].type.empty()) topics_[known->second].type = topic.type;
        return;
      }
      if (schema != 0 && !schemas_.contains(schema)) untyped_[id] = schema;
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

  struct Block {
    std::uint64_t at = 0, end = 0;  ///< bytes of the file
    Nanoseconds start = 0;          ///< of its first message
    bool chunk = false;
    bool cut = false;  ///< the file ends in it
  };

  /// What is left of a block.
  struct OpenBlock {
    Bytes bytes;
    std::vector<std::pair<Nanoseconds, std::size_t>> messages;  ///< that are asked for, by time; where they stand
    std::size_t next = 0;
  };

  bool find_next(RawMessage& message) {
    // Of messages of one time the earlier in the file comes first: where all have one, one block is open.
    const auto is_due = [&](const Block& block) {
      return open_.empty() || std::pair(block.start, block.at) < open_.begin()->first;
    };
    for (; next_block_ < blocks_.size() && is_due(blocks_[next_block_]); ++next_block_)
      if (!may_skip(blocks_[next_block_].at)) open_block(blocks_[next_block_]);
    if (open_.empty()) losses_.refuse_if_all_is_damaged();
    if (open_.empty()) return false;
    auto front = open_.extract(open_.begin());
    OpenBlock& block = front.mapped();
    take_message(record_in(block.bytes, block.messages[block.next].second).second, message);
    if (++block.next == block.messages.size()) {
      *open_bytes_ -= block.bytes.size();
      return true;
    }
    front.key().first = block.messages[block.next].first;
    open_.insert(std::move(front));
    return true;
  }

  void open_block(const Block& from) {
    OpenBlock block = read_block(from);
    if (block.messages.empty()) return;
    *open_bytes_ += block.bytes.size();
    if (*open_bytes_ > block.bytes.size() && *open_bytes_ > most_open_bytes)
      throw InputError({}, "messages that are out of the order of time over more than 1 GiB; `mcap sort` mends that");
    const std::pair key(block.messages.front().first, from.at);
    open_.emplace(key, std::move(block));
  }

  [[nodiscard]] Bytes bytes_of(const Block& from) {
    record_at_ = from.at;
    if (!from.chunk) return read(from.at, from.end - from.at);
    const Bytes content = read(from.at + mcap::head_bytes, from.end - from.at - mcap::head_bytes);
    return from.cut ? mcap::records_of_cut_chunk(content) : mcap::records_of_chunk(content);
  }

  /// Nothing of a chunk that is damaged.
  [[nodiscard]] Bytes whole_bytes_of(const Block& from) {
    try {
      Bytes bytes = bytes_of(from);
      static_cast<void>(mcap::count_messages(bytes));  // every record ends where the next begins
      losses_.any_whole = true;
      return bytes;
    } catch (const InputError& error) {
      if (!from.chunk) throw;
      losses_.add_damaged(from.at, from.end - from.at, error);
      return {};
    }
  }

  [[nodiscard]] OpenBlock read_block(const Block& from) {
    OpenBlock block;
    block.bytes = whole_bytes_of(from);
    for (std::size_t at = 0; at < block.bytes.size();) {
      const auto [head, content] = record_in(block.bytes, at);
      if (head.op == Op::message) {
        const Nanoseconds time = time_of(content);
        if (wanted_.contains(Values(content).number<std::uint16_t>())) block.messages.emplace_back(time, at);
      }
      take_definition(head.op, content);
      at += mcap::head_bytes + head.size;
    }
    std::stable_sort(block.messages.begin(), block.messages.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    return block;
  }

  void take_message(std::span<const std::uint8_t> content, RawMessage& message) const {
    Values values(content);
    message.topic = channels_.at(values.number<std::uint16_t>());
    static_cast<void>(values.number<std::uint32_t>());
    message.time = static_cast<Nanoseconds>(values.number<std::uint64_t>());
    static_cast<void>(values.number<std::uint64_t>());
    message.bytes.assign(values.rest().begin(), values.rest().end());
  }

  Mark mark_;
  InputFile file_;
  std::uint64_t size_ = 0, footer_at_ = 0, summary_at_ = 0, data_end_ = 0;
  std::uint32_t summary_crc_ = 0;
  mcap::Losses losses_;
  std::vector<BagTopic> topics_;
  std::map<std::uint16_t, std::string> schemas_;                     ///< names of types
  std::map<std::uint16_t, std::size_t> channels_;                    ///< to topics
  std::map<std::uint16_t, std::uint16_t> untyped_;                   ///< channels, to their schemas, not yet known
  std::map<std::uint64_t, std::set<std::uint16_t>> chunk_channels_;  ///< by where the chunk begins
  std::set<std::uint16_t> wanted_;
  std::uint64_t record_at_ = 0;  ///< of the one being read, for messages
  std::vector<Block> blocks_;    ///< by their start
  std::size_t next_block_ = 0;
  std::map<std::pair<Nanoseconds, std::uint64_t>, OpenBlock> open_;  ///< by the next message's time, then by place
  std::shared_ptr<std::size_t> open_bytes_;  ///< in `open_`, and in that of the bag's other files
};

}  // namespace

std::unique_ptr<MessageSource> open_mcap(const std::string& path, std::shared_ptr<std::size_t> open_bytes) {
  if (!open_bytes) open_bytes = std::make_shared<std::size_t>(0);
  return std::make_unique<McapReader>(path, std::move(open_bytes));
}

}  // namespace plumbline::slam
