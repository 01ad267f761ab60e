// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace plumbline {

/// A file descriptor of this process, closed on every way out. Negative: none.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() { close_now(); }
  Descriptor(Descriptor&& other) noexcept;
  Descriptor& operator=(Descriptor&& other) noexcept;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int get() const { return fd_; }
  /// What close() returns; 0 of none.
  int close_now();

 private:
  int fd_ = -1;
};

/// False where not all could be written; errno says why.
[[nodiscard]] bool write_all(int fd, std::string_view bytes);

}  // namespace plumbline
