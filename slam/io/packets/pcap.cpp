// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/pcap.h"

#include <pcap/pcap.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <deque>
#include <exception>
#include <optional>
#include <set>

#include "bim/config/input_file.h"
#include "bim/errors.h"
#include "slam/io/packets/data_senders.h"
#include "slam/io/packets/position_packet.h"
#include "slam/io/packets/udp_frame.h"
#include "slam/io/second.h"

namespace plumbline::slam {

namespace {

constexpr std::size_t ethernet_bytes = 14;
constexpr std::size_t ip_bytes = 20;
constexpr std::size_t udp_bytes = 8;
constexpr std::size_t header_bytes = ethernet_bytes + ip_bytes + udp_bytes;
constexpr std::size_t frame_bytes = header_bytes + vlp16::payload_bytes;
constexpr unsigned data_port = 2368;
constexpr unsigned position_port = 8308;
constexpr std::int64_t data_packets_per_position = 5;  // about as real units send them, docs/methods/lidar_model.md

using Frame = std::array<std::uint8_t, frame_bytes>;

struct ClosePcap {
  void operator()(pcap_t* p) const { pcap_close(p); }
};
struct CloseDump {
  void operator()(pcap_dumper_t* p) const { pcap_dump_close(p); }
};
using Pcap = std::unique_ptr<pcap_t, ClosePcap>;

unsigned big16(const std::uint8_t* p) { return (static_cast<unsigned>(p[0]) << 8U) | p[1]; }

std::optional<Link> link_of(int type) {
  switch (type) {
    case DLT_EN10MB:
      return Link::ethernet;
    case DLT_LINUX_SLL:
      return Link::linux_cooked;
    case DLT_LINUX_SLL2:
      return Link::linux_cooked_2;
    case DLT_RAW:
    case DLT_IPV4:
      return Link::raw_ip;
    default:
      return std::nullopt;
  }
}

Pcap open_capture(const std::string& path, const Mark& mark, Link& link) {
  InputFile file = open_input_file(path);
  if (!file.regular) throw InputError(mark, "is no file; a pcap capture would be right");
  std::array<char, PCAP_ERRBUF_SIZE> error{};
  Pcap capture(pcap_fopen_offline_with_tstamp_precision(file.stream.get(), PCAP_TSTAMP_PRECISION_NANO, error.data()));
  if (capture == nullptr) throw InputError(mark, std::string("no pcap capture: ") + error.data());
  static_cast<void>(file.stream.release());  // closed with the capture
  const std::optional<Link> known = link_of(pcap_datalink(capture.get()));
  if (!known) throw InputError(mark, "frames of a link type that is not known; Ethernet would be right");
  link = *known;
  return capture;
}

std::uint16_t ip_checksum(const Frame& frame) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < ip_bytes; i += 2) sum += big16(&frame[ethernet_bytes + i]);
  while (sum > 0xffffU) sum = (sum & 0xffffU) + (sum >> 16U);
  return static_cast<std::uint16_t>(~sum);
}

void put_big16(Frame& frame, std::size_t i, std::size_t value) {
  frame[i] = static_cast<std::uint8_t>(value >> 8U);
  frame[i + 1] = static_cast<std::uint8_t>(value & 0xffU);
}

/// The frame in which a VLP-16 in its factory setting (192.168.1.201) broadcasts a payload; its first bytes count.
Frame make_frame(unsigned port, std::span<const std::uint8_t> payload) {
  constexpr std::array<std::uint8_t, header_bytes> header = {
      0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x60, 0x76, 0x88, 0x00, 0x00, 0x00, 0x08, 0x00,          // Ethernet
      0x45, 0x00, 0x00, 0x00, 0x00, 0x00, 0x40, 0x00, 0xff, 0x11, 0x00, 0x00, 192,  168,  1, 201,  // IPv4
      0xff, 0xff, 0xff, 0xff, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00};                     // UDP
  Frame frame{};
  std::copy(header.begin(), header.end(), frame.begin());
  put_big16(frame, 16, header_bytes - ethernet_bytes + payload.size());
  put_big16(frame, 34, port);
  put_big16(frame, 36, port);
  put_big16(frame, 38, udp_bytes + payload.size());
  put_big16(frame, 24, ip_checksum(frame));
  std::copy(payload.begin(), payload.end(), frame.begin() + header_bytes);
  return frame;
}

}  // namespace

struct PcapReader::Impl {
  /// A data packet that was read and not yet given out.
  struct Waiting {
    Vlp16Packet packet;
    Nanoseconds captured = 0;
    std::int64_t frame = 0;
  };
  static constexpr std::size_t window = 4;               ///< packets in which copies and swaps are looked for
  static constexpr std::int64_t most_early_us = 20'000;  ///< of a swapped packet; beyond it a clock was set back

  Mark mark;
  Pcap capture;
  Link link = Link::ethernet;
  std::int64_t frames = 0;         ///< read so far, of any kind
  std::deque<Waiting> waiting;     ///< in the order of the file
  std::deque<Vlp16Packet> recent;  ///< the last that were read
  bool ended = false;
  std::exception_ptr broken;  ///< what ended it, to be thrown after what was read before
  std::int64_t taken = 0, copies = 0, swaps = 0;
  std::set<unsigned> other_ports;  ///< destinations of other datagrams, the first few
  std::set<unsigned> data_ports;   ///< those of data packets, where none is the usual one
  unsigned port = data_port;       ///< the one that is read
  DataSenders senders;
  bool cut_off = false;
  bool any = false;           ///< a data packet has come
  bool ours = false;          ///< stamps are the capture's own
  std::int64_t first_us = 0;  ///< clock of the first packet, of the last one
  std::int64_t last_us = 0;
  std::int64_t hours = 0;
  Nanoseconds last_stamp = 0;
  Nanoseconds origin = 0;

  [[noreturn]] void fail(std::int64_t frame, const std::string& what) const {
    throw InputError(mark, "frame " + std::to_string(frame) + ": " + what);
  }

  static std::string listed(const std::set<unsigned>& ports) {
    std::string list;
    for (const unsigned one : ports) list += (list.empty() ? "" : ", ") + std::to_string(one);
    return list;
  }

  [[noreturn]] void fail_empty() const {
    throw InputError(mark, "no Velodyne data packets (UDP port 2368) in the capture" +
                               (data_ports.size() > 1
                                    ? "; there are data packets to ports " + listed(data_ports) + ": keep one of them"
                                : other_ports.empty() ? ""
                                                      : "; there is traffic to port " + listed(other_ports)));
  }

  /// Takes the port that alone gets data packets, where nothing comes to the usual one.
  void find_port(const std::string& path) {
    constexpr std::size_t most_ports = 4;
    Link link_again{};
    const Pcap again = open_capture(path, mark, link_again);
    pcap_pkthdr* header = nullptr;
    const std::uint8_t* bytes = nullptr;
    while (data_ports.size() < most_ports && pcap_next_ex(again.get(), &header, &bytes) == 1) {
      const std::optional<UdpDatagram> datagram = find_udp({bytes, header->caplen}, link);
      if (!datagram) continue;
      if (datagram->port == data_port) {
        data_ports.clear();
        return;
      }
      if (is_velodyne_data(*datagram)) data_ports.insert(datagram->port);
    }
    if (data_ports.size() == 1) port = *data_ports.begin();
  }

  /// Data payload of a frame, or nothing where the frame is something else.
  std::optional<std::span<const std::uint8_t>> data_payload(std::span<const std::uint8_t> frame) {
    const std::optional<UdpDatagram> datagram = find_udp(frame, link);
    if (!datagram) return std::nullopt;
    if (senders.take(*datagram, port)) return datagram->payload;
    if (datagram->port != position_port && other_ports.size() < 4) other_ports.insert(datagram->port);
    return std::nullopt;
  }

  /// Reads the next data packet of the file; false at the end.
  bool read(Waiting& out) {
    pcap_pkthdr* header = nullptr;
    const std::uint8_t* bytes = nullptr;
    int status = 0;
    while ((status = pcap_next_ex(capture.get(), &header, &bytes)) == 1) {
      out.frame = ++frames;
      const auto payload = data_payload({bytes, header->caplen});
      if (!payload) continue;
      if (payload->size() != vlp16::payload_bytes)
        fail(frames, "a data packet of " + std::to_string(payload->size()) + " bytes; 1206 would be right");
      std::copy_n(payload->begin(), out.packet.payload.size(), out.packet.payload.begin());
      if (header->ts.tv_sec < 0 || header->ts.tv_sec > 4'500'000'000) fail(frames, "its time of capture is no time");
      out.captured = std::int64_t{header->ts.tv_sec} * second_ns + header->ts.tv_usec;
      ++taken;
      return true;
    }
    if (status != PCAP_ERROR) return false;
    const std::string what = pcap_geterr(capture.get());
    cut_off = taken > 0 && what.starts_with("truncated");
    if (!cut_off) throw InputError(mark, "damaged capture: " + what);
    return false;
  }

  [[nodiscard]] bool is_copy(const Vlp16Packet& packet) const {
    return std::any_of(recent.begin(), recent.end(), [&](const Vlp16Packet& r) { return r.payload == packet.payload; });
  }

  /// Fills the window.
  void look_ahead() {
    try {
      while (!ended && waiting.size() < window) {
        Waiting next;
        ended = !read(next);
        if (ended) break;
        if (is_copy(next.packet)) {
          ++copies;
          continue;
        }
        recent.push_back(next.packet);
        if (recent.size() > window) recent.pop_front();
        waiting.push_back(next);
      }
    } catch (const InputError&) {
      ended = true;
      broken = std::current_exception();
    }
  }

  /// Of the packets in the window the first by their own time; at least one waits.
  Waiting take_first() {
    const auto early_us = [&](const Waiting& one) {  // than the front, across the hour
      const std::int64_t by = time_in_payload_us(waiting.front().packet) - time_in_payload_us(one.packet);
      return by < -hour_us / 2 ? by + hour_us : by;
    };
    auto first = waiting.begin();
    for (auto it = waiting.begin(); it != waiting.end(); ++it)
      if (early_us(*it) > early_us(*first) && early_us(*it) < most_early_us) first = it;
    if (first != waiting.begin()) ++swaps;
    Waiting out = *first;
    waiting.erase(first);
    return out;
  }

  /// Stamp of a data packet, in time order.
  Nanoseconds stamp_of(const Waiting& read) {
    const auto& [packet, captured, frame] = read;
    const auto fail_here = [this, number = frame](const std::string& what) { fail(number, what); };
    const std::int64_t us = time_in_payload_us(packet);
    if (us >= hour_us) fail_here("its time, " + std::to_string(us) + " us, is beyond the hour");
    if (!any) {
      ours = captured / 1000 % hour_us == us;
      origin = ours ? 0 : captured;
      first_us = last_us = us;
    }
    if (us + hour_us / 2 < last_us) ++hours;
    last_us = us;
    if (ours && captured / 1000 % hour_us != us) fail_here("its time of capture and its own time do not agree");
    const Nanoseconds stamp = ours ? captured : (us + hours * hour_us - first_us) * 1000;
    if (any && stamp <= last_stamp)
      fail_here("its time lies " + std::to_string((last_stamp - stamp) / 1000) +
                " us before that of the packet before it");
    if (any && stamp - last_stamp > max_gap)
      fail_here("the clock leaps by " + std::to_string((stamp - last_stamp) / 1'000'000) + " ms; at most " +
                std::to_string(max_gap / 1'000'000) + " would be right, cut the capture there");
    return stamp;
  }
};

PcapReader::PcapReader(const std::string& path) : impl_(std::make_unique<Impl>()) {
  impl_->mark = {path, 0, 0};
  impl_->capture = open_capture(path, impl_->mark, impl_->link);
  impl_->find_port(path);
}

PcapReader::~PcapReader() = default;

Nanoseconds PcapReader::origin() const { return impl_->origin; }

std::vector<std::string> PcapReader::left_out() const {
  std::vector<std::string> said;
  if (impl_->copies > 0) said.push_back(std::to_string(impl_->copies) + " packets left out: copies of others");
  if (impl_->swaps > 0) said.push_back(std::to_string(impl_->swaps) + " packets that came late put in their order");
  for (std::string& other : impl_->senders.left_out()) said.push_back(std::move(other));
  if (impl_->cut_off) said.emplace_back("the capture is cut off; read as far as it is whole");
  return said;
}

std::vector<std::string> PcapReader::assumed() const {
  if (impl_->port == data_port) return {};
  const std::string port = std::to_string(impl_->port);
  return {"no data packets come to port 2368; those to port " + port + " are read"};
}

bool PcapReader::is_cut_off() const { return impl_->cut_off; }

bool PcapReader::next(Vlp16Packet& packet) {
  impl_->look_ahead();
  if (impl_->waiting.empty()) {
    if (impl_->broken) std::rethrow_exception(impl_->broken);
    if (!impl_->any) impl_->fail_empty();
    return false;
  }
  const Impl::Waiting first = impl_->take_first();
  const Nanoseconds stamp = impl_->stamp_of(first);
  packet = first.packet;
  packet.stamp = impl_->last_stamp = stamp;
  impl_->any = true;
  return true;
}

struct PcapWriter::Impl {
  std::string path;
  std::string temporary;
  Pcap link;
  std::FILE* file = nullptr;  ///< owned by dump
  std::unique_ptr<pcap_dumper_t, CloseDump> dump;

  std::int64_t packets = 0;

  [[noreturn]] void fail() const { throw EnvironmentError(path + ": cannot be written: " + std::strerror(errno)); }

  void write(Nanoseconds stamp, unsigned port, std::span<const std::uint8_t> payload) {
    pcap_pkthdr header{};
    header.ts.tv_sec = stamp / second_ns;
    header.ts.tv_usec = stamp % second_ns;
    header.caplen = header.len = static_cast<bpf_u_int32>(header_bytes + payload.size());
    const Frame frame = make_frame(port, payload);
    pcap_dump(reinterpret_cast<u_char*>(dump.get()), &header, frame.data());
    if (std::ferror(file) != 0) fail();
  }
};

PcapWriter::PcapWriter(const std::string& path) : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  impl_->temporary = path + ".part";
  impl_->link.reset(pcap_open_dead_with_tstamp_precision(DLT_EN10MB, 65535, PCAP_TSTAMP_PRECISION_NANO));
  if (impl_->link == nullptr) throw EnvironmentError("libpcap cannot open a capture for writing");
  impl_->file = std::fopen(impl_->temporary.c_str(), "wb");
  if (impl_->file == nullptr) impl_->fail();
  impl_->dump.reset(pcap_dump_fopen(impl_->link.get(), impl_->file));
  if (impl_->dump != nullptr) return;
  std::fclose(impl_->file);
  impl_->fail();
}

PcapWriter::~PcapWriter() {
  if (impl_->dump == nullptr) return;
  impl_->dump.reset();
  std::remove(impl_->temporary.c_str());
}

void PcapWriter::add(const Vlp16Packet& packet) {
  if (impl_->packets++ % data_packets_per_position == 0)
    impl_->write(packet.stamp, position_port, position_payload(packet.stamp));
  impl_->write(packet.stamp, data_port, packet.payload);
}

void PcapWriter::finish() {
  if (pcap_dump_flush(impl_->dump.get()) != 0 || std::ferror(impl_->file) != 0 || ::fsync(::fileno(impl_->file)) != 0)
    impl_->fail();
  impl_->dump.reset();
  if (std::rename(impl_->temporary.c_str(), impl_->path.c_str()) == 0) return;
  const int error = errno;
  std::remove(impl_->temporary.c_str());
  errno = error;
  impl_->fail();
}

}  // namespace plumbline::slam
