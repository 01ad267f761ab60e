// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <string>

/// Records of a ROS 1 bag as bytes, of a test that spoils them.
namespace plumbline::slam::ros1_bytes {

template <class T>
std::string raw(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}
inline std::string u32(std::uint64_t value) { return raw(static_cast<std::uint32_t>(value)); }
inline std::string u64(std::uint64_t value) { return raw(value); }

inline std::string field(const std::string& name, const std::string& value) {
  return u32(name.size() + 1 + value.size()) + name + "=" + value;
}
inline std::string record(const std::string& header, const std::string& data) {
  return u32(header.size()) + header + u32(data.size()) + data;
}
inline std::string op(char code) { return field("op", std::string(1, code)); }

}  // namespace plumbline::slam::ros1_bytes
