// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bim/errors.h"
#include "slam/io/ros2/compression.h"
#include "slam/io/ros2/mcap_chunk.h"
#include "slam/io/ros2/mcap_format.h"
#include "slam/io/ros2/ros2_writer.h"

namespace plumbline::slam {

namespace {

using mcap::Op;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t chunk_bytes = std::size_t{1} << 20U;

template <class T>
void put(Bytes& bytes, T value) {
  const auto* from = reinterpret_cast<const std::uint8_t*>(&value);
  bytes.insert(bytes.end(), from, from + sizeof(T));
}
void put_bytes(Bytes& to, std::span<const std::uint8_t> from) { to.insert(to.end(), from.begin(), from.end()); }
void put_text(Bytes& bytes, std::string_view text) {
  put(bytes, static_cast<std::uint32_t>(text.size()));
  bytes.insert(bytes.end(), text.begin(), text.end());
}
/// Entries with the number of their bytes before them.
void put_list(Bytes& bytes, const Bytes& entries) {
  put(bytes, static_cast<std::uint32_t>(entries.size()));
  put_bytes(bytes, entries);
}

Bytes record(Op op, std::span<const std::uint8_t> content) {
  Bytes bytes{static_cast<std::uint8_t>(op)};
  put(bytes, std::uint64_t{content.size()});
  put_bytes(bytes, content);
  return bytes;
}

/// Where the messages of a topic stand in the open chunk: (time, offset) each.
using Index = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

/// What is being written.
struct McapFile {
  std::string path, compression;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file{nullptr, &std::fclose};
  std::uint64_t written = 0;
  std::uint32_t data_crc = 0;
  Bytes schemas, channels;  ///< records, for the summary
  std::map<std::string, std::uint16_t> schema_ids;
  Bytes chunk;
  std::map<std::uint16_t, Index> index;  ///< of the open chunk
  std::uint64_t chunk_start = 0, chunk_end = 0;
  Bytes chunk_indexes;
  std::uint32_t chunks = 0;
  std::map<std::uint16_t, std::uint64_t> counts;
  std::uint64_t messages = 0, first_time = 0, last_time = 0;

  void emit(std::span<const std::uint8_t> bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size())
      throw EnvironmentError(path + ": cannot be written: " + std::strerror(errno));
    written += bytes.size();
    data_crc = mcap::checksum(data_crc, bytes);
  }

  void close_chunk() {
    if (index.empty()) return;
    const std::uint64_t size = chunk.size(), at = written;
    Bytes content;
    put(content, chunk_start);
    put(content, chunk_end);
    put(content, size);
    put(content, mcap::checksum(0, chunk));
    put_text(content, compression);
    const Bytes packed = pack(compression, std::exchange(chunk, {}));
    put(content, std::uint64_t{packed.size()});
    put_bytes(content, packed);
    emit(record(Op::chunk, content));
    const std::uint64_t length = written - at;

    Bytes offsets;
    const std::uint64_t indexes_at = written;
    for (const auto& [topic, entries] : index) {
      put(offsets, topic);
      put(offsets, written);
      Bytes list, one;
      for (const auto& [time, offset] : entries) {
        put(list, time);
        put(list, offset);
      }
      put(one, topic);
      put_list(one, list);
      emit(record(Op::message_index, one));
    }
    Bytes summary;
    put(summary, chunk_start);
    put(summary, chunk_end);
    put(summary, at);
    put(summary, length);
    put_list(summary, offsets);
    put(summary, written - indexes_at);
    put_text(summary, compression);
    put(summary, std::uint64_t{packed.size()});
    put(summary, size);
    put_bytes(chunk_indexes, record(Op::chunk_index, summary));
    ++chunks;
    index.clear();
  }

  [[nodiscard]] Bytes statistics() const {
    Bytes bytes, per_topic;
    put(bytes, messages);
    put(bytes, static_cast<std::uint16_t>(schema_ids.size()));
    put(bytes, static_cast<std::uint32_t>(counts.size()));
    put(bytes, std::uint32_t{0});  // attachments
    put(bytes, std::uint32_t{0});  // metadata
    put(bytes, chunks);
    put(bytes, first_time);
    put(bytes, last_time);
    for (const auto& [topic, count] : counts) {
      put(per_topic, topic);
      put(per_topic, count);
    }
    put_list(bytes, per_topic);
    return record(Op::statistics, bytes);
  }
};

class McapWriter final : public Ros2Writer {
 public:
  McapWriter(const std::string& path, std::string_view compression);
  [[nodiscard]] std::uint16_t add_topic(const Ros2Topic& topic) override;
  void write(std::uint16_t topic, Nanoseconds time, std::span<const std::uint8_t> cdr) override;
  void finish() override;

 private:
  McapFile file_;
};

McapWriter::McapWriter(const std::string& path, std::string_view compression) {
  file_.path = path;
  file_.compression = compression;
  file_.file.reset(std::fopen(path.c_str(), "wb"));
  if (!file_.file) throw EnvironmentError(path + ": cannot be written: " + std::strerror(errno));
  file_.emit(mcap::magic);
  Bytes header;
  put_text(header, "ros2");
  put_text(header, "plumbline");
  file_.emit(record(Op::header, header));
}

std::uint16_t McapWriter::add_topic(const Ros2Topic& topic) {
  McapFile& w = file_;
  Bytes definitions;
  auto schema = w.schema_ids.find(topic.type);
  if (schema == w.schema_ids.end()) {
    schema = w.schema_ids.emplace(topic.type, static_cast<std::uint16_t>(w.schema_ids.size() + 1)).first;
    Bytes content;
    put(content, schema->second);
    put_text(content, topic.type);
    put_text(content, "ros2msg");
    put_text(content, topic.definition);
    const Bytes one = record(Op::schema, content);
    put_bytes(w.schemas, one);
    put_bytes(definitions, one);
  }
  const auto id = static_cast<std::uint16_t>(w.counts.size());
  w.counts[id] = 0;
  Bytes content, metadata;
  put(content, id);
  put(content, schema->second);
  put_text(content, topic.name);
  put_text(content, "cdr");
  put_text(metadata, "offered_qos_profiles");
  put_text(metadata, topic.qos);
  put_list(content, metadata);
  const Bytes one = record(Op::channel, content);
  put_bytes(w.channels, one);
  put_bytes(definitions, one);
  put_bytes(w.chunk, definitions);  // before the topic's first message, for who reads from the start
  return id;
}

void McapWriter::write(std::uint16_t topic, Nanoseconds time, std::span<const std::uint8_t> cdr) {
  McapFile& w = file_;
  if (w.chunk.size() + cdr.size() > chunk_bytes) w.close_chunk();
  const auto t = static_cast<std::uint64_t>(time);
  if (w.index.empty()) w.chunk_start = w.chunk_end = t;
  w.chunk_start = std::min(w.chunk_start, t);
  w.chunk_end = std::max(w.chunk_end, t);
  w.index[topic].emplace_back(t, w.chunk.size());
  Bytes content;
  put(content, topic);
  put(content, std::uint32_t{0});
  put(content, t);
  put(content, t);
  put_bytes(content, cdr);
  put_bytes(w.chunk, record(Op::message, content));
  w.first_time = w.messages == 0 ? t : std::min(w.first_time, t);
  w.last_time = std::max(w.last_time, t);
  ++w.messages;
  ++w.counts[topic];
}

void McapWriter::finish() {
  McapFile& w = file_;
  w.close_chunk();
  Bytes data_end;
  put(data_end, w.data_crc);
  w.emit(record(Op::data_end, data_end));

  const std::uint64_t summary_at = w.written;
  Bytes summary, offsets;
  const auto group = [&](Op op, const Bytes& records) {
    if (records.empty()) return;
    Bytes content;
    put(content, static_cast<std::uint8_t>(op));
    put(content, summary_at + summary.size());
    put(content, std::uint64_t{records.size()});
    put_bytes(offsets, record(Op::summary_offset, content));
    put_bytes(summary, records);
  };
  group(Op::schema, w.schemas);
  group(Op::channel, w.channels);
  group(Op::statistics, w.statistics());
  group(Op::chunk_index, w.chunk_indexes);
  const std::uint64_t offsets_at = summary_at + summary.size();
  put_bytes(summary, offsets);
  Bytes footer;  // the checksum covers all of it but itself
  put(footer, static_cast<std::uint8_t>(Op::footer));
  put(footer, mcap::footer_bytes);
  put(footer, summary_at);
  put(footer, offsets_at);
  put_bytes(summary, footer);
  put(summary, mcap::checksum(0, summary));
  w.emit(summary);
  w.emit(mcap::magic);
  if (std::fclose(w.file.release()) != 0)
    throw EnvironmentError(w.path + ": cannot be written: " + std::strerror(errno));
}

}  // namespace

std::unique_ptr<Ros2Writer> make_mcap_writer(const std::string& path, std::string_view compression) {
  return std::make_unique<McapWriter>(path, compression);
}

}  // namespace plumbline::slam
