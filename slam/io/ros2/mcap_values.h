// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>

#include "bim/errors.h"
#include "slam/io/ros2/mcap_format.h"

namespace plumbline::slam::mcap {

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

[[nodiscard]] inline Head head_of(std::span<const std::uint8_t> bytes) {
  Values values(bytes);
  const auto op = values.number<std::uint8_t>();
  return {static_cast<Op>(op), values.number<std::uint64_t>()};
}

/// The record that begins there.
[[nodiscard]] inline std::pair<Head, std::span<const std::uint8_t>> record_in(std::span<const std::uint8_t> bytes,
                                                                              std::uint64_t at) {
  const auto rest = bytes.subspan(at);
  const Head head = head_of(rest);
  if (head.size > rest.size() - head_bytes) throw InputError({}, "a record that goes beyond what it stands in");
  return {head, rest.subspan(head_bytes, head.size)};
}

}  // namespace plumbline::slam::mcap
