// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/process.h"

#include <fcntl.h>
#include <malloc.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "bim/digest/float_mode.h"

namespace plumbline::scenarios {

namespace {

constexpr const char* tunables_variable = "GLIBC_TUNABLES";
constexpr const char* guard_variable = "PLUMBLINE_REEXECUTED";

std::string_view environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string_view() : std::string_view(value);
}

}  // namespace

std::string with_hwcaps(std::string_view tunables) {
  if (tunables.find(hwcaps_tunable) != std::string_view::npos) return std::string(tunables);
  return (tunables.empty() ? "" : std::string(tunables) + ":") + std::string(hwcaps_tunable);
}

void reexecute_with_tunables(char** argv) {
  const std::string_view set = environment(tunables_variable);
  if (set.find(hwcaps_tunable) != std::string_view::npos) return;
  if (environment(guard_variable).empty()) {
    setenv(tunables_variable, with_hwcaps(set).c_str(), 1);
    setenv(guard_variable, "1", 1);
    execv("/proc/self/exe", argv);
  }
  std::fprintf(stderr,
               "plumbline: warning: could not start again with GLIBC_TUNABLES (%s); last bits may depend on the CPU\n",
               std::strerror(errno));
}

void settle_process() {
  for (int fd = 0; fd <= 2; ++fd)
    if (fcntl(fd, F_GETFD) == -1 && errno == EBADF) static_cast<void>(open("/dev/null", fd == 0 ? O_RDONLY : O_WRONLY));
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
  // Scans are made and dropped ten times a simulated second: their memory stays with the program in between.
  constexpr int largest = 32 << 20;
  mallopt(M_MMAP_THRESHOLD, largest);
  mallopt(M_TRIM_THRESHOLD, 4 * largest);
  set_float_mode();
}

int allowed_cpus() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof(set), &set) != 0) return 1;
  return std::max(1, CPU_COUNT(&set));
}

}  // namespace plumbline::scenarios
