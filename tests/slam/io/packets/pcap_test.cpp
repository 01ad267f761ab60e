// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/pcap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "bim/errors.h"
#include "tests/data.h"
#include "tests/folder.h"
#include "tests/input_error.h"
#include "tests/slam/io/packets/foreign_capture.h"
#include "tests/slam/io/packets/packets.h"

namespace plumbline::slam {
namespace {

namespace fs = std::filesystem;

class PcapTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::string file(const std::string& name) const { return folder_ / name; }

 private:
  Folder folder_;
};

std::vector<Vlp16Packet> some_packets() {
  std::vector<Vlp16Packet> packets;
  for (int p = 0; p < 10; ++p) {
    std::array<Vlp16Firing, 24> firings;
    for (std::size_t f = 0; f < 24; ++f) {
      firings[f].azimuth_cdeg = static_cast<std::uint16_t>(40 * (12 * static_cast<std::size_t>(p) + f / 2));
      firings[f].distance.fill(static_cast<std::uint16_t>(100 + p));
    }
    // Across a full hour, with nanoseconds that a capture in microseconds would lose.
    packets.push_back(encode_packet(3'599'999'000'123 + p * 24 * vlp16::firing_period_ns, firings));
  }
  return packets;
}

/// All that is read of a capture and said of it, a line each.
struct Read {
  std::vector<Vlp16Packet> packets;
  std::string said, assumed;
};

Read all_of(const std::string& path) {
  PcapReader reader(path);
  Read read;
  for (Vlp16Packet packet; reader.next(packet);) read.packets.push_back(packet);
  for (const std::string& line : reader.left_out()) read.said += line + "\n";
  for (const std::string& line : reader.assumed()) read.assumed += line + "\n";
  return read;
}

/// Changes the frames of the data packets of a capture of ours, each with its number.
template <class Change>
void change_data_frames(const std::string& path, Change&& change) {
  std::ifstream in(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::size_t number = 0;
  for (std::size_t at = 24; at < bytes.size();) {
    const std::size_t size = at + 16 + 1248 <= bytes.size() && bytes[at + 8] == '\xe0' ? 1248 : 554;
    if (size == 1248) change(number++, &bytes[at + 16]);
    at += 16 + size;
  }
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST_F(PcapTest, GivesBackWhatWasWritten) {
  const std::vector<Vlp16Packet> packets = some_packets();
  write_pcap(file("a.pcap"), packets);
  const std::vector<Vlp16Packet> again = read_pcap(file("a.pcap"));
  ASSERT_EQ(again.size(), packets.size());
  for (std::size_t i = 0; i < packets.size(); ++i) {
    EXPECT_EQ(again[i].stamp, packets[i].stamp);
    EXPECT_EQ(again[i].payload, packets[i].payload);
  }
  EXPECT_EQ(fs::file_size(file("a.pcap")), 24 + 10 * (16 + 1248) + 2 * (16 + 554));  // two position packets
  EXPECT_FALSE(fs::exists(file("a.pcap.part")));
}

TEST_F(PcapTest, ForeignStampsComeFromThePacketsOwnClockAcrossTheHour) {
  std::vector<Vlp16Packet> packets = some_packets();
  for (Vlp16Packet& packet : packets) packet.stamp += 77'123'456'789;  // arrival times of another clock
  write_pcap(file("foreign.pcap"), packets);
  const std::vector<Vlp16Packet> again = read_pcap(file("foreign.pcap"));
  ASSERT_EQ(again.size(), packets.size());
  for (std::size_t i = 0; i < again.size(); ++i)
    EXPECT_NEAR(static_cast<double>(again[i].stamp), static_cast<double>(i) * 24 * 55296, 1'000.0);
}

void expect_steady_packets(const std::vector<Vlp16Packet>& packets) {
  ASSERT_EQ(packets.size(), 293U);
  EXPECT_EQ(packets.front().stamp, 0);
  for (std::size_t i = 1; i < packets.size(); ++i)
    EXPECT_NEAR(static_cast<double>(packets[i].stamp - packets[i - 1].stamp), 1'327'500.0, 1'000.0);
}

TEST_F(PcapTest, ReadsTheCaptureOfAnotherProgram) {
  std::ofstream(file("hall.pcap"), std::ios::binary) << foreign_capture(293);
  const std::vector<Vlp16Packet> packets = read_pcap(file("hall.pcap"));
  expect_steady_packets(packets);
  PcapReader reader(file("hall.pcap"));
  Vlp16Packet first;
  ASSERT_TRUE(reader.next(first));
  EXPECT_EQ(reader.origin(), 946'684'800'000'000'000);
  const Scan scan = decode_message(packets);
  ASSERT_EQ(scan.size(), 293U * 24U * 16U);
  std::size_t returns = 0;
  for (std::size_t slot = 0; slot < scan.size(); ++slot) {
    if (scan.range_m[slot] == 0.0) continue;
    ++returns;
    const Eigen::Vector3d beyond = scan.point_L[slot].cwiseAbs() - Eigen::Vector3d(hall_x_m, hall_y_m, hall_z_m);
    // Ranges are rounded to 2 mm, azimuths of the firings to 0.01 degrees and in between.
    EXPECT_NEAR(beyond.maxCoeff(), 0.0, 0.003) << slot;
  }
  EXPECT_EQ(returns, scan.size() / 3 * 2);
}

TEST_F(PcapTest, ReadsTheCaptureOfARealSensor) {
  const std::string sample = "vlp16/sample_velodyne_vlp16_gps.pcap";
  if (const std::string why = data_missing(sample); !why.empty()) GTEST_SKIP() << why;
  const std::vector<Vlp16Packet> packets = read_pcap(data_path(sample));
  expect_steady_packets(packets);
  const Scan scan = decode_message(packets);
  std::size_t returns = 0;
  std::size_t odd = 0;
  for (std::size_t slot = 0; slot < scan.size(); ++slot) {
    if (scan.range_m[slot] == 0.0) continue;
    ++returns;
    odd += static_cast<std::size_t>(std::lround(scan.range_m[slot] / 0.002)) % 2;
    EXPECT_GE(scan.range_m[slot], 0.49);
    EXPECT_LE(scan.range_m[slot], 2.85);
  }
  // Measured once on this capture: 34.7 % zero ranges, half of the others odd multiples of 2 mm.
  EXPECT_NEAR(static_cast<double>(returns) / static_cast<double>(scan.size()), 0.653, 0.001);
  EXPECT_NEAR(static_cast<double>(odd) / static_cast<double>(returns), 0.5, 0.05);
}

// As UDP gives them, and captures of two interfaces.
TEST_F(PcapTest, CopiesAreLeftOutAndNeighboursPutInOrder) {
  // Across the full hour of the packets' own clock.
  const std::vector<Vlp16Packet> packets = turning_packets(60, 3'599'960'000'000);
  std::vector<Vlp16Packet> arrived = packets;
  std::swap(arrived[10], arrived[11]);
  std::swap(arrived[29], arrived[30]);
  std::rotate(arrived.begin() + 40, arrived.begin() + 41, arrived.begin() + 43);  // two late
  arrived.insert(arrived.begin() + 50, arrived[49]);
  arrived.insert(arrived.begin() + 20, arrived[18]);
  write_pcap(file("udp.pcap"), arrived);
  PcapReader reader(file("udp.pcap"));
  std::vector<Vlp16Packet> again;
  for (Vlp16Packet packet; reader.next(packet);) again.push_back(packet);
  ASSERT_EQ(again.size(), packets.size());
  for (std::size_t i = 0; i < again.size(); ++i) {
    EXPECT_EQ(again[i].stamp, packets[i].stamp) << i;
    EXPECT_EQ(again[i].payload, packets[i].payload) << i;
  }
  ASSERT_EQ(reader.left_out().size(), 2U);
  EXPECT_EQ(reader.left_out()[0], "2 packets left out: copies of others");
  write_pcap(file("good.pcap"), packets);
  PcapReader good(file("good.pcap"));
  for (Vlp16Packet packet; good.next(packet);) continue;
  EXPECT_TRUE(good.left_out().empty());
}

TEST_F(PcapTest, APacketThatIsFarOutOfOrderIsRefused) {
  std::vector<Vlp16Packet> packets = turning_packets(60);
  std::rotate(packets.begin() + 20, packets.begin() + 21, packets.begin() + 30);
  write_pcap(file("late.pcap"), packets);
  const std::string complaint = input_error([&] { (void)read_pcap(file("late.pcap")); });
  EXPECT_NE(complaint.find("us before that of the packet before it"), std::string::npos) << complaint;
  packets = turning_packets(60, 1'000'000'000);
  const std::vector<Vlp16Packet> earlier = turning_packets(60);
  packets.insert(packets.end(), earlier.begin(), earlier.end());
  write_pcap(file("two.pcap"), packets);
  EXPECT_NE(input_error([&] { (void)read_pcap(file("two.pcap")); }).find("before that of the packet before it"),
            std::string::npos);
}

TEST_F(PcapTest, RefusesWhatIsNoCapture) {
  EXPECT_THROW((void)read_pcap(file("missing.pcap")), InputError);
  EXPECT_THROW((void)read_pcap(fs::temp_directory_path().string()), InputError);
  std::ofstream(file("empty.pcap")).close();
  EXPECT_THROW((void)read_pcap(file("empty.pcap")), InputError);
  std::ofstream(file("text.pcap")) << "this is a text, not a capture of packets";
  EXPECT_THROW((void)read_pcap(file("text.pcap")), InputError);
  write_pcap(file("none.pcap"), {});
  EXPECT_THROW((void)read_pcap(file("none.pcap")), InputError);
}

TEST_F(PcapTest, RefusesACaptureCutOffBeforeItsFirstDataPacket) {
  write_pcap(file("whole.pcap"), some_packets());
  for (const std::uintmax_t size : {std::uintmax_t{10}, std::uintmax_t{30}, std::uintmax_t{600}, std::uintmax_t{700}}) {
    fs::copy_file(file("whole.pcap"), file("cut.pcap"), fs::copy_options::overwrite_existing);
    fs::resize_file(file("cut.pcap"), size);
    EXPECT_THROW((void)read_pcap(file("cut.pcap")), InputError) << size;
  }
}

TEST_F(PcapTest, ACaptureCutOffInAPacketIsReadAsFarAsItIsWhole) {
  write_pcap(file("whole.pcap"), some_packets());
  for (const std::uintmax_t less : {1U, 1240U, 1250U}) {
    fs::copy_file(file("whole.pcap"), file("cut.pcap"), fs::copy_options::overwrite_existing);
    fs::resize_file(file("cut.pcap"), fs::file_size(file("whole.pcap")) - less);
    EXPECT_EQ(read_pcap(file("cut.pcap")).size(), 9U) << less;
    EXPECT_EQ(all_of(file("cut.pcap")).said, "the capture is cut off; read as far as it is whole\n");
  }
}

TEST_F(PcapTest, ACaptureThatIsDamagedOtherwiseIsRefused) {
  write_pcap(file("bad.pcap"), some_packets());
  std::fstream stream(file("bad.pcap"), std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(24 + 16 + 554 + 5 * (16 + 1248) + 16 + 554 + 8);  // the length of the sixth data packet
  stream.write("\xff\xff\xff\x7f", 4);
  stream.close();
  EXPECT_NE(input_error([&] { (void)read_pcap(file("bad.pcap")); }).find("damaged capture"), std::string::npos);
}

TEST_F(PcapTest, OfTwoSensorsTheFirstIsReadAndTheOtherNamed) {
  const std::vector<Vlp16Packet> first = turning_packets(40), second = turning_packets(40, 500'000);
  std::vector<Vlp16Packet> both;
  for (std::size_t i = 0; i < first.size(); ++i) both.insert(both.end(), {first[i], second[i]});
  write_pcap(file("two.pcap"), both);
  for (const std::ptrdiff_t byte : {29, 35, 37}) {  // address, port of the sender; port of the receiver
    fs::copy_file(file("two.pcap"), file("other.pcap"), fs::copy_options::overwrite_existing);
    change_data_frames(file("other.pcap"), [&](std::size_t k, char* frame) { frame[byte] += k % 2 == 1 ? 1 : 0; });
    const Read read = all_of(file("other.pcap"));
    ASSERT_EQ(read.packets.size(), first.size()) << byte;
    for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(read.packets[i].payload, first[i].payload) << i;
    EXPECT_EQ(read.said, "40 data packets left out: from 192.168.1." + std::string(byte == 29 ? "202" : "201") + ":" +
                             (byte == 35 ? "2369" : "2368") + " to port " + (byte == 37 ? "2369" : "2368") +
                             "; those from 192.168.1.201:2368 to port 2368 are read\n");
  }
}

TEST_F(PcapTest, APortThatAloneGetsDataPacketsIsTaken) {
  const std::vector<Vlp16Packet> packets = turning_packets(40);
  write_pcap(file("port.pcap"), packets);
  const auto send_to = [&](int first, int second) {
    change_data_frames(file("port.pcap"), [&](std::size_t k, char* frame) {
      const int port = k % 2 == 0 ? first : second;
      frame[36] = static_cast<char>(port >> 8);
      frame[37] = static_cast<char>(port);
    });
  };
  send_to(2370, 2370);
  EXPECT_EQ(read_pcap(file("port.pcap")).size(), packets.size());
  const Read read = all_of(file("port.pcap"));
  EXPECT_EQ(read.said, "");
  EXPECT_EQ(read.assumed, "no data packets come to port 2368; those to port 2370 are read\n");
  send_to(2370, 2371);
  EXPECT_NE(input_error([&] { (void)read_pcap(file("port.pcap")); }).find("data packets to ports 2370, 2371"),
            std::string::npos);
  send_to(2370, 2370);
  change_data_frames(file("port.pcap"), [](std::size_t, char* frame) { frame[42 + 1205] = 0x41; });
  EXPECT_NE(input_error([&] { (void)read_pcap(file("port.pcap")); }).find("there is traffic to port 2370"),
            std::string::npos);
}

TEST_F(PcapTest, UnwritablePlaceIsAnEnvironmentError) {
  EXPECT_THROW(write_pcap(file("no/such/folder.pcap"), some_packets()), EnvironmentError);
}

}  // namespace
}  // namespace plumbline::slam
