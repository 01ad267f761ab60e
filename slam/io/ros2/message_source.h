// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "slam/io/records.h"
#include "slam/io/second.h"

namespace plumbline::slam {

/// How the bytes of messages are laid out: as ROS 1 does, or CDR (XCDR1), as ROS 2 does.
enum class Encoding { ros1, cdr, unknown };

struct BagTopic {
  std::string name;
  std::string type;  ///< "sensor_msgs/PointCloud2", in ROS 2 too
  Encoding encoding = Encoding::unknown;
};

struct RawMessage {
  std::size_t topic = 0;  ///< index in topics()
  Nanoseconds time = 0;   ///< when it was recorded, not its header's stamp
  std::vector<std::uint8_t> bytes;
};

/// Whether a message can have been recorded then: differences of such times do not overflow.
[[nodiscard]] inline bool is_possible_time(Nanoseconds recorded) {
  return recorded > -furthest_stamp && recorded < furthest_stamp;
}

/// "1 of 31 messages were recorded more than 126 years from 1970"
[[nodiscard]] inline std::string untimed_messages(std::int64_t some, std::int64_t all) {
  return std::to_string(some) + " of " + std::to_string(all) + " messages were recorded more than 126 years from 1970";
}

/// Messages of a bag, of whatever kind it is. Functions throw InputError where it is damaged.
class MessageSource {
 public:
  virtual ~MessageSource() = default;
  [[nodiscard]] virtual const std::vector<BagTopic>& topics() const = 0;
  /// Goes back to the beginning; next() then gives messages of these topics alone.
  virtual void select(const std::vector<std::string>& topics) = 0;
  /// The next message in the order in which they were recorded, of one time in that of the file; false at the end.
  [[nodiscard]] virtual bool next(RawMessage& message) = 0;
  /// No message was recorded earlier.
  [[nodiscard]] virtual Nanoseconds start() = 0;
  /// What of the file could not be read, a sentence each.
  [[nodiscard]] virtual std::vector<std::string> left_out() const { return {}; }
};

/// What to say of a bag that was not closed, and of its last bytes.
[[nodiscard]] inline std::string not_closed(std::uint64_t left_out, std::uint64_t all) {
  const std::string said = "the bag was not closed or is cut off; ";
  if (left_out == 0) return said + "all that it holds is read";
  return said + "its last " + std::to_string(left_out) + " of " + std::to_string(all) +
         " bytes hold no whole record and are left out";
}

/// A type's name as ROS 1 writes it: without "msg/" in the middle.
[[nodiscard]] inline std::string plain_type(std::string_view type) {
  const std::size_t at = type.find("/msg/");
  return at == std::string_view::npos ? std::string(type)
                                      : std::string(type.substr(0, at)) + std::string(type.substr(at + 4));
}

}  // namespace plumbline::slam
