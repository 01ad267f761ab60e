// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

namespace plumbline::slam {

/// Memory that a child process may read, too. It can neither shrink nor grow it; what it writes there is its own loss,
/// as nothing is read back. Pages take room once they are written.
class SharedMemory {
 public:
  /// bytes: a multiple of the size of pages. Without any where the system gives none.
  explicit SharedMemory(std::size_t bytes);
  ~SharedMemory();
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory(SharedMemory&&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  SharedMemory& operator=(SharedMemory&&) = delete;

  /// Its file, or -1.
  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] std::span<std::byte> bytes() const { return bytes_; }

 private:
  int descriptor_ = -1;
  std::span<std::byte> bytes_;
};

}  // namespace plumbline::slam
