// SPDX-License-Identifier: Apache-2.0
#include "slam/io/stopwatch.h"

#include <ctime>

namespace plumbline::slam {

namespace {

double read(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

double thread_cpu_s() { return read(CLOCK_THREAD_CPUTIME_ID); }
double process_cpu_s() { return read(CLOCK_PROCESS_CPUTIME_ID); }
double process_cpu_s(int pid) {
  clockid_t clock{};
  return clock_getcpuclockid(pid, &clock) == 0 ? read(clock) : 0.0;
}
double wall_s() { return read(CLOCK_MONOTONIC); }

}  // namespace plumbline::slam
