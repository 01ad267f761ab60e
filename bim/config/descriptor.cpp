// SPDX-License-Identifier: Apache-2.0
#include "bim/config/descriptor.h"

#include <unistd.h>

#include <cerrno>
#include <utility>

namespace plumbline {

Descriptor::Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

int Descriptor::close_now() { return fd_ >= 0 ? ::close(std::exchange(fd_, -1)) : 0; }

bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace plumbline
