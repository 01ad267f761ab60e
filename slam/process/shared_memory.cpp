// SPDX-License-Identifier: Apache-2.0
#include "slam/process/shared_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace plumbline::slam {

SharedMemory::SharedMemory(std::size_t bytes) {
  descriptor_ = ::memfd_create("plumbline", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (descriptor_ < 0) return;
  // Else a child could cut it off under our writes.
  constexpr int seals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;
  void* at = MAP_FAILED;
  if (::ftruncate(descriptor_, static_cast<off_t>(bytes)) == 0 && ::fcntl(descriptor_, F_ADD_SEALS, seals) == 0)
    at = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
  if (at != MAP_FAILED) {
    bytes_ = {static_cast<std::byte*>(at), bytes};
    return;
  }
  ::close(descriptor_);
  descriptor_ = -1;
}

SharedMemory::~SharedMemory() {
  if (descriptor_ < 0) return;
  ::munmap(bytes_.data(), bytes_.size());
  ::close(descriptor_);
}

}  // namespace plumbline::slam
