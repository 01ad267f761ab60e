// SPDX-License-Identifier: Apache-2.0
#include "slam/io/pcap.h"

#include <pcap/pcap.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>

#include "bim/errors.h"

namespace plumbline::slam {

namespace {

constexpr std::size_t ethernet_bytes = 14;
constexpr std::size_t ip_bytes = 20;
constexpr std::size_t udp_bytes = 8;
constexpr std::size_t header_bytes = ethernet_bytes + ip_bytes + udp_bytes;
constexpr std::size_t frame_bytes = header_bytes + vlp16::payload_bytes;
constexpr unsigned data_port = 2368;
constexpr std::int64_t hour_us = 3'600'000'000;

using Frame = std::array<std::uint8_t, frame_bytes>;

struct ClosePcap {
  void operator()(pcap_t* p) const { pcap_close(p); }
};
struct CloseDump {
  void operator()(pcap_dumper_t* p) const { pcap_dump_close(p); }
};
using Pcap = std::unique_ptr<pcap_t, ClosePcap>;

unsigned big16(const std::uint8_t* p) { return (static_cast<unsigned>(p[0]) << 8U) | p[1]; }

/// UDP payload of an IPv4 frame sent to the data port, or nothing.
std::optional<std::span<const std::uint8_t>> data_payload(std::span<const std::uint8_t> frame) {
  if (frame.size() < header_bytes || big16(&frame[12]) != 0x0800 || frame[14] >> 4U != 4) return std::nullopt;
  const std::size_t udp = ethernet_bytes + 4 * (frame[14] & 0x0fU);
  if (frame[23] != 17 || frame.size() < udp + udp_bytes || big16(&frame[udp + 2]) != data_port) return std::nullopt;
  return frame.subspan(udp + udp_bytes);
}

std::int64_t payload_us(const Vlp16Packet& packet) {
  std::int64_t us = 0;
  for (std::size_t i = 4; i-- > 0;) us = (us << 8) | packet.payload[1200 + i];
  return us;
}

/// Stamps of a foreign capture: the packets' own clock from the first packet on, which restarts every hour.
void restamp(std::vector<Vlp16Packet>& packets) {
  std::int64_t hours = 0;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    const std::int64_t before = i == 0 ? payload_us(packets[0]) : payload_us(packets[i - 1]);
    if (payload_us(packets[i]) + hour_us / 2 < before) ++hours;
    packets[i].stamp = (payload_us(packets[i]) + hours * hour_us - payload_us(packets[0])) * 1000;
  }
}

/// True when the capture's stamps are the packets' own, as write_pcap leaves them.
bool stamped_by_us(const std::vector<Vlp16Packet>& packets) {
  return std::all_of(packets.begin(), packets.end(),
                     [](const Vlp16Packet& packet) { return packet.stamp / 1000 % hour_us == payload_us(packet); });
}

std::uint16_t ip_checksum(const Frame& frame) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < ip_bytes; i += 2) sum += big16(&frame[ethernet_bytes + i]);
  while (sum > 0xffffU) sum = (sum & 0xffffU) + (sum >> 16U);
  return static_cast<std::uint16_t>(~sum);
}

/// The frame a VLP-16 in its factory setting (192.168.1.201) broadcasts.
Frame make_frame(const Vlp16Packet& packet) {
  constexpr std::array<std::uint8_t, header_bytes> header = {
      0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x60, 0x76, 0x88, 0x00, 0x00, 0x00, 0x08, 0x00,          // Ethernet
      0x45, 0x00, 0x04, 0xd2, 0x00, 0x00, 0x40, 0x00, 0xff, 0x11, 0x00, 0x00, 192,  168,  1, 201,  // IPv4
      0xff, 0xff, 0xff, 0xff, 0x09, 0x40, 0x09, 0x40, 0x04, 0xbe, 0x00, 0x00};                     // UDP
  Frame frame{};
  std::copy(header.begin(), header.end(), frame.begin());
  const std::uint16_t checksum = ip_checksum(frame);
  frame[24] = static_cast<std::uint8_t>(checksum >> 8U);
  frame[25] = static_cast<std::uint8_t>(checksum & 0xffU);
  std::copy(packet.payload.begin(), packet.payload.end(), frame.begin() + header_bytes);
  return frame;
}

[[noreturn]] void fail_write(const std::string& path, const std::string& temporary) {
  const std::string reason = std::strerror(errno);
  std::remove(temporary.c_str());
  throw EnvironmentError(path + ": cannot be written: " + reason);
}

}  // namespace

std::vector<Vlp16Packet> read_pcap(const std::string& path) {
  const Mark mark{path, 0, 0};
  if (!std::filesystem::is_regular_file(path)) throw InputError(mark, "no such file; a pcap capture would be right");
  std::array<char, PCAP_ERRBUF_SIZE> error{};
  const Pcap capture(pcap_open_offline_with_tstamp_precision(path.c_str(), PCAP_TSTAMP_PRECISION_NANO, error.data()));
  if (capture == nullptr) throw InputError(mark, std::string("no pcap capture: ") + error.data());
  if (pcap_datalink(capture.get()) != DLT_EN10MB) throw InputError(mark, "link type is not Ethernet, as it should be");

  std::vector<Vlp16Packet> packets;
  pcap_pkthdr* header = nullptr;
  const std::uint8_t* bytes = nullptr;
  int status = 0;
  while ((status = pcap_next_ex(capture.get(), &header, &bytes)) == 1) {
    const auto payload = data_payload({bytes, header->caplen});
    if (!payload) continue;
    if (payload->size() < vlp16::payload_bytes)
      throw InputError(mark, "data packet " + std::to_string(packets.size()) + " has " +
                                 std::to_string(payload->size()) + " bytes; 1206 would be right");
    Vlp16Packet& packet = packets.emplace_back();
    packet.stamp = std::int64_t{header->ts.tv_sec} * 1'000'000'000 + header->ts.tv_usec;
    std::copy_n(payload->begin(), packet.payload.size(), packet.payload.begin());
  }
  if (status == PCAP_ERROR) throw InputError(mark, std::string("damaged capture: ") + pcap_geterr(capture.get()));
  if (packets.empty()) throw InputError(mark, "no VLP-16 data packets (UDP port 2368) in the capture");
  if (!stamped_by_us(packets)) restamp(packets);
  return packets;
}

void write_pcap(const std::string& path, std::span<const Vlp16Packet> packets) {
  const Pcap link(pcap_open_dead_with_tstamp_precision(DLT_EN10MB, 65535, PCAP_TSTAMP_PRECISION_NANO));
  if (link == nullptr) throw EnvironmentError("libpcap cannot open a capture for writing");
  const std::string temporary = path + ".part";
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (file == nullptr) fail_write(path, temporary);
  std::unique_ptr<pcap_dumper_t, CloseDump> dump(pcap_dump_fopen(link.get(), file));
  if (dump == nullptr) {
    std::fclose(file);
    fail_write(path, temporary);
  }
  for (const Vlp16Packet& packet : packets) {
    pcap_pkthdr header{};
    header.ts.tv_sec = packet.stamp / 1'000'000'000;
    header.ts.tv_usec = packet.stamp % 1'000'000'000;
    header.caplen = header.len = static_cast<bpf_u_int32>(frame_bytes);
    const Frame frame = make_frame(packet);
    pcap_dump(reinterpret_cast<u_char*>(dump.get()), &header, frame.data());
  }
  if (pcap_dump_flush(dump.get()) != 0 || std::ferror(file) != 0 || ::fsync(::fileno(file)) != 0)
    fail_write(path, temporary);
  dump.reset();
  if (std::rename(temporary.c_str(), path.c_str()) != 0) fail_write(path, temporary);
}

}  // namespace plumbline::slam
