// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/ros1_unindexed.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bim/config/input_file.h"
#include "slam/io/bags/ros1_records.h"

namespace plumbline::slam {

namespace {

using ros1::Fields;
using ros1::Op;

constexpr std::size_t most_messages = 20'000'000;
constexpr std::uint64_t most_run_bytes = std::uint64_t{1}
                                         << 20U;  ///< of messages outside of chunks, unless one is more

class UnindexedBag final : public MessageSource {
 public:
  UnindexedBag(const std::string& path, EncodingOfType encoding_of, bool sound)
      : mark_{path, 0, 0}, file_(open_input_file(path)), encoding_of_(encoding_of), sound_(sound) {
    end_ = file_.bytes;
    try {
      find_messages();
    } catch (const InputError& error) {
      throw InputError(mark_, "byte " + std::to_string(record_at_) + ": " + error.what());
    }
    if (messages_.empty()) throw InputError(mark_, "a bag that was not closed or is cut off, without a whole message");
    std::stable_sort(messages_.begin(), messages_.end(),
                     [](const Message& a, const Message& b) { return a.time < b.time; });
  }

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_; }

  void select(const std::vector<std::string>& topics) override {
    wanted_.clear();
    for (const BagTopic& topic : topics_)
      wanted_.push_back(std::find(topics.begin(), topics.end(), topic.name) != topics.end());
    next_ = 0;
  }

  [[nodiscard]] bool next(RawMessage& message) override {
    for (; next_ < messages_.size(); ++next_) {
      const Message& found = messages_[next_];
      if (wanted_.empty() || !wanted_[found.topic]) continue;
      const std::string_view data = ros1::record_at(opened(found.block), found.offset).data;
      message.topic = found.topic;
      message.time = found.time;
      message.bytes.assign(data.begin(), data.end());
      ++next_;
      return true;
    }
    return false;
  }

  [[nodiscard]] Nanoseconds start() override { return messages_.front().time; }
  [[nodiscard]] std::vector<std::string> left_out() const override {
    if (!closed_ && lost_ == 0) return {not_closed(rest_, file_.bytes)};
    const std::string said = closed_ ? "the bag is damaged" : "the bag was not closed or is cut off, and is damaged";
    if (lost_ + rest_ == 0 && sound_) return {};
    if (lost_ + rest_ == 0) return {said + " in its index; all messages are read"};
    return {said + "; " + std::to_string(lost_ + rest_) + " of its " + std::to_string(file_.bytes) +
            " bytes cannot be read and are left out" + (fault_.empty() ? "" : ", the first at " + fault_)};
  }

 private:
  /// A chunk, or records that stand in the file as if in one that was not closed.
  struct Block {
    std::uint64_t at = 0, bytes = 0;  ///< as packed
    std::string header;               ///< of the chunk; empty where there is none
  };
  struct Message {
    Nanoseconds time = 0;
    std::uint32_t block = 0, offset = 0, topic = 0;
  };
  struct Open {
    std::uint32_t block = 0;
    std::vector<char> packed, unpacked;
    std::string_view records;
  };
  /// A record of the file itself.
  struct Head {
    std::string header;
    std::uint64_t data_at = 0, data_bytes = 0;
  };

  void read(std::uint64_t at, char* to, std::uint64_t bytes) {
    if (::fseeko(file_.stream.get(), static_cast<off_t>(at), SEEK_SET) != 0 ||
        std::fread(to, 1, static_cast<std::size_t>(bytes), file_.stream.get()) != bytes)
      throw InputError({}, "cannot be read");
  }

  [[nodiscard]] std::optional<std::uint64_t> length_at(std::uint64_t at) {
    if (at > file_.bytes || file_.bytes - at < 4) return std::nullopt;
    std::array<char, 4> bytes{};
    read(at, bytes.data(), bytes.size());
    const std::uint64_t length = ros1::number_at<std::uint32_t>({bytes.data(), bytes.size()}, 0);
    return length <= file_.bytes - at - 4 ? std::optional(length) : std::nullopt;
  }

  /// Nothing where no whole record follows.
  [[nodiscard]] std::optional<Head> head_at(std::uint64_t at) {
    const auto header = length_at(at);
    if (!header || *header > ros1::most_header_bytes) return std::nullopt;
    const auto data = length_at(at + 4 + *header);
    if (!data) return std::nullopt;
    Head head{std::string(static_cast<std::size_t>(*header), '\0'), at + 8 + *header, *data};
    read(at + 4, head.header.data(), *header);
    return head;
  }

  [[nodiscard]] static std::optional<Op> kind_of(const Head& head) {
    try {
      return ros1::op_of(ros1::fields_of(head.header));
    } catch (const InputError&) {
      return std::nullopt;
    }
  }

  /// The index of a bag that was closed: its connections, and where its chunks are.
  void read_index() {
    constexpr std::size_t most_places = 1'000'000;
    const auto bag = head_at(ros1::first_record);
    if (!bag || kind_of(*bag) != Op::bag) return;
    const Fields said = ros1::fields_of(bag->header);
    if (!said.contains("index_pos")) return;
    const auto index_at = ros1::value_of<std::uint64_t>(said, "index_pos");
    if (index_at <= ros1::first_record) return;
    std::uint64_t at = index_at;
    for (auto head = head_at(at); head; head = head_at(at)) {
      const std::optional<Op> kind = kind_of(*head);
      if (!kind) break;
      const std::uint64_t end = head->data_at + head->data_bytes;
      if (*kind == Op::connection) add_connection_at(at, end);
      if (*kind == Op::chunk_info && chunks_.size() < most_places)
        chunks_.insert(ros1::value_of<std::uint64_t>(ros1::fields_of(head->header), "chunk_pos"));
      at = end;
    }
    closed_ = at == file_.bytes;
    if (closed_) end_ = index_at;
  }

  void add_connection_at(std::uint64_t at, std::uint64_t end) {
    constexpr std::uint64_t most_bytes = std::uint64_t{1} << 24U;
    if (end - at > most_bytes) return;
    std::string bytes(static_cast<std::size_t>(end - at), '\0');
    read(at, bytes.data(), bytes.size());
    const ros1::Record record = ros1::record_at(bytes, 0);
    add_connection(ros1::value_of<std::uint32_t>(record.fields, "conn"), record);
  }

  /// Where the records of a chunk begin that the file ends in, if they are not packed.
  [[nodiscard]] std::optional<std::uint64_t> records_of_cut_chunk(std::uint64_t at) {
    const auto header = length_at(at);
    if (!header || *header > ros1::most_header_bytes || file_.bytes - at < 8 + *header) return std::nullopt;
    Head head{std::string(static_cast<std::size_t>(*header), '\0'), at + 8 + *header, 0};
    read(at + 4, head.header.data(), *header);
    if (kind_of(head) != Op::chunk) return std::nullopt;
    const Fields said = ros1::fields_of(head.header);
    const auto compression = said.find("compression");
    return compression != said.end() && compression->second == "none" ? std::optional(head.data_at) : std::nullopt;
  }

  void find_messages() {
    try {
      read_index();
    } catch (const InputError&) {  // what it says up to there is enough
    }
    std::uint64_t at = ros1::first_record, whole_until = at;
    while (at < end_) {
      const auto head = head_at(at);
      const std::optional<Op> kind = head ? kind_of(*head) : std::nullopt;
      if (!kind) {
        take_run();
        const std::optional<std::uint64_t> next = go_on_after(at);
        if (!next) break;
        at = *next;
        continue;
      }
      const std::uint64_t end = head->data_at + head->data_bytes;
      if (*kind == Op::message || *kind == Op::connection) {
        add_to_run(at, end);
      } else {
        take_run();
        // One that was being written has no length yet; what it holds follows as if it stood in the file.
        if (*kind == Op::chunk && head->data_bytes > 0)
          take(Block{head->data_at, head->data_bytes, head->header}, at, end);
      }
      at = whole_until = end;
    }
    take_run();
    rest_ = closed_ ? end_ - std::min(at, end_) : file_.bytes - failed_at_.value_or(whole_until);
    if (closed_) lost_ += pending_;
  }

  /// Behind what is no record.
  [[nodiscard]] std::optional<std::uint64_t> go_on_after(std::uint64_t at) {
    const auto chunk = chunks_.upper_bound(at);
    if (chunk == chunks_.end() || *chunk >= end_) return closed_ ? std::nullopt : records_of_cut_chunk(at);
    leave_out(at, *chunk, "no record");
    return *chunk;
  }

  void add_to_run(std::uint64_t at, std::uint64_t end) {
    if (run_.bytes > 0 && end - run_.at > most_run_bytes) take_run();
    if (run_.bytes == 0) run_.at = at;
    run_.bytes = end - run_.at;
  }
  void take_run() {
    if (run_.bytes == 0) return;
    const Block run = std::exchange(run_, {});
    take(run, run.at, run.at + run.bytes);
  }

  void take(Block block, std::uint64_t record_at, std::uint64_t record_end) {
    record_at_ = record_at;
    const std::size_t known = messages_.size();
    blocks_.push_back(std::move(block));
    try {
      scan(static_cast<std::uint32_t>(blocks_.size() - 1));
      lost_ += std::exchange(pending_, 0);
      failed_at_.reset();
    } catch (const InputError& error) {
      if (messages_.size() == most_messages) throw;
      messages_.resize(known);
      leave_out(record_at, record_end, error.what());
    }
  }

  void leave_out(std::uint64_t at, std::uint64_t end, const std::string& why) {
    if (fault_.empty()) fault_ = "byte " + std::to_string(at) + ": " + why;
    if (!failed_at_) failed_at_ = at;
    pending_ += end - at;
  }

  void scan(std::uint32_t block) {
    const std::string_view records = opened(block);
    for (std::size_t at = 0; at < records.size();) {
      const ros1::Record record = ros1::record_at(records, at);
      const auto connection = ros1::value_of<std::uint32_t>(record.fields, "conn");
      if (ros1::op_of(record.fields) == Op::connection) {
        add_connection(connection, record);
      } else {
        const auto topic = topic_of_.find(connection);
        if (topic == topic_of_.end()) throw InputError({}, "a message of a connection that is not told before it");
        if (messages_.size() == most_messages) throw InputError({}, "a bag of more than 20 million messages");
        const auto time = ros1::value_of<std::uint64_t>(record.fields, "time");  // ns in the upper half
        messages_.push_back({static_cast<Nanoseconds>((time & 0xFFFFFFFFU) * 1'000'000'000U + (time >> 32U)), block,
                             static_cast<std::uint32_t>(at), topic->second});
      }
      at += record.bytes;
    }
  }

  void add_connection(std::uint32_t connection, const ros1::Record& record) {
    const std::string topic(ros1::text_of(record.fields, "topic"));
    const auto told = topic_of_.find(connection);
    if (told != topic_of_.end() && topics_[told->second].name == topic) return;
    const Fields said = ros1::fields_of(record.data);
    const std::string type(ros1::text_of(said, "type"));
    const auto known =
        std::find_if(topics_.begin(), topics_.end(), [&](const BagTopic& other) { return other.name == topic; });
    topic_of_[connection] = static_cast<std::uint32_t>(known - topics_.begin());
    if (known == topics_.end()) topics_.push_back({topic, type, encoding_of_(type, ros1::text_of(said, "md5sum"))});
  }

  /// Records of a block, which stay until some others are opened.
  [[nodiscard]] std::string_view opened(std::uint32_t block) {
    constexpr std::size_t most_open = 4;
    for (const Open& open : open_)
      if (open.block == block) return open.records;
    const Block& from = blocks_[block];
    if (from.bytes > ros1::most_chunk_bytes)
      throw InputError({}, "a chunk of " + std::to_string(from.bytes) + " bytes; at most 256 MiB are read");
    Open open{block, std::vector<char>(static_cast<std::size_t>(from.bytes)), {}, {}};
    read(from.at, open.packed.data(), from.bytes);
    open.records = from.header.empty() ? std::string_view(open.packed.data(), open.packed.size())
                                       : ros1::unpack_chunk(ros1::fields_of(from.header), open.packed, open.unpacked);
    if (open.records.data() != open.packed.data()) open.packed = {};
    open_.push_back(std::move(open));  // its bytes stay where they are
    std::uint64_t held = 0;
    for (const Open& one : open_) held += one.records.size();
    for (; open_.size() > 1 && (open_.size() > most_open || held > ros1::most_chunk_bytes); open_.pop_front())
      held -= open_.front().records.size();
    return open_.back().records;
  }

  Mark mark_;
  InputFile file_;
  EncodingOfType encoding_of_;
  bool sound_ = false;
  std::vector<BagTopic> topics_;
  std::map<std::uint32_t, std::uint32_t> topic_of_;  ///< by connection
  std::vector<Block> blocks_;
  std::vector<Message> messages_;  ///< by their time
  std::deque<Open> open_;
  Block run_;
  std::set<std::uint64_t> chunks_;          ///< where they begin, as the index says
  bool closed_ = false;                     ///< the index is whole
  std::uint64_t end_ = 0;                   ///< of the records outside of the index
  std::uint64_t record_at_ = 0;             ///< of the block being read, for messages
  std::optional<std::uint64_t> failed_at_;  ///< since when nothing could be read
  std::uint64_t pending_ = 0;               ///< bytes left out since then
  std::uint64_t lost_ = 0, rest_ = 0;       ///< bytes left out before the last whole block, and behind it
  std::string fault_;                       ///< the first, and where
  std::vector<bool> wanted_;                ///< of the topics
  std::size_t next_ = 0;
};

}  // namespace

std::unique_ptr<MessageSource> open_unindexed_bag(const std::string& path, EncodingOfType encoding_of, bool sound) {
  return std::make_unique<UnindexedBag>(path, encoding_of, sound);
}

}  // namespace plumbline::slam
