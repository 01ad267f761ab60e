// SPDX-License-Identifier: Apache-2.0
#include "slam/io/packets/data_senders.h"

#include "slam/io/lidar_model.h"
#include "slam/io/packets/vlp16.h"

namespace plumbline::slam {

namespace {
constexpr std::size_t most_named = 8;
}

bool is_velodyne_data(const UdpDatagram& datagram) {
  const auto& bytes = datagram.payload;
  return bytes.size() == vlp16::payload_bytes && bytes[0] == 0xff && bytes[1] == 0xee &&
         velodyne_model(bytes.back()) != nullptr;
}

bool DataSenders::take(const UdpDatagram& datagram, unsigned port) {
  const Sender sender{datagram.source, datagram.source_port, datagram.port};
  const bool to_port = datagram.port == port;
  if (to_port && !read_) read_ = sender;
  if (to_port && *read_ == sender) return true;
  if (!to_port && !is_velodyne_data(datagram)) return false;
  if (others_.size() < most_named || others_.contains(sender))
    ++others_[sender];
  else
    ++more_;
  return false;
}

std::string DataSenders::text(const Sender& sender) {
  std::string address;
  for (unsigned shift = 32; shift > 0; shift -= 8)
    address += (address.empty() ? "" : ".") + std::to_string((sender.address >> (shift - 8)) & 0xffU);
  return address + ":" + std::to_string(sender.from_port) + " to port " + std::to_string(sender.to_port);
}

std::vector<std::string> DataSenders::left_out() const {
  std::vector<std::string> said;
  const std::string why = read_ ? "; those from " + text(*read_) + " are read" : "";
  for (const auto& [sender, count] : others_)
    said.push_back(std::to_string(count) + " data packets left out: from " + text(sender) + why);
  if (more_ > 0) said.push_back(std::to_string(more_) + " data packets left out: from further senders" + why);
  return said;
}

}  // namespace plumbline::slam
