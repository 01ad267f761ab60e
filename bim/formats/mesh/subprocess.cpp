// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/mesh/subprocess.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <utility>

#include "bim/config/descriptor.h"
#include "bim/errors.h"

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define PLUMBLINE_SHADOW_MEMORY
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define PLUMBLINE_SHADOW_MEMORY
#endif

namespace plumbline::bim {

namespace {

constexpr char done = '\1';  ///< last byte of a whole answer

void limit(int resource, rlim_t soft, rlim_t hard) {
  const rlimit both{soft, hard};
  (void)::setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

/// Address space in use, bytes.
std::uint64_t address_space() {
  unsigned long long pages = 0;
  if (std::FILE* file = std::fopen("/proc/self/statm", "re")) {
    if (std::fscanf(file, "%llu", &pages) != 1) pages = 0;
    std::fclose(file);
  }
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

void bound(const SubprocessLimits& config) {
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_CPU, config.cpu_s, config.cpu_s + 1);  // at the first SIGXCPU, which tells the reason; then SIGKILL
  itimerval wall{};
  wall.it_value.tv_sec = static_cast<time_t>(config.wall_s);
  wall.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (config.wall_s - std::floor(config.wall_s)));
  (void)::setitimer(ITIMER_REAL, &wall, nullptr);  // SIGALRM ends the process
#ifndef PLUMBLINE_SHADOW_MEMORY                    // which alone takes terabytes of addresses
  const rlim_t most = address_space() + config.memory;
  limit(RLIMIT_AS, most, most);
#endif
}

[[noreturn]] void child(int pipe, const std::function<std::string()>& task, const SubprocessLimits& config) {
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGILL, SIGBUS, SIGINT, SIGTERM, SIGPIPE, SIGXCPU, SIGALRM})
    (void)std::signal(signal, SIG_DFL);
  struct sigaction hangup {};
  (void)::sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) (void)std::signal(SIGHUP, SIG_DFL);
  sigset_t none;
  ::sigemptyset(&none);
  (void)::sigprocmask(SIG_SETMASK, &none, nullptr);
  // The caller reports the failure; messages of the crashing library are dropped.
  const int silence = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (silence >= 0) {
    (void)::dup2(silence, STDOUT_FILENO);
    (void)::dup2(silence, STDERR_FILENO);
  }
  bound(config);
  bool ok = false;
  try {
    const std::string answer = task();
    ok = write_all(pipe, answer) && write_all(pipe, {&done, 1});
  } catch (...) {
  }
  ::_exit(ok ? 0 : 1);
}

/// All that comes through the pipe, or none when it is longer than allowed.
std::optional<std::string> read_all(int pipe, std::size_t longest) {
  std::string text;
  std::array<char, 1U << 16U> buffer{};
  while (true) {
    const ssize_t count = ::read(pipe, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    if (text.size() + static_cast<std::size_t>(count) > longest) return std::nullopt;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace

SubprocessLimits subprocess_limits(std::size_t bytes, const SubprocessLimits& least) {
  constexpr std::size_t bytes_a_second = std::size_t{2} << 20U, memory_a_byte = 32;
  constexpr double wall_a_cpu = 20.0;  // as many others may want the processor
  SubprocessLimits bounds = least;
  bounds.cpu_s += static_cast<unsigned>(bytes / bytes_a_second);
  bounds.wall_s += wall_a_cpu * static_cast<double>(bytes / bytes_a_second);
  bounds.memory += memory_a_byte * bytes;
  return bounds;
}

SubprocessResult run_in_subprocess(const std::function<std::string()>& task, const SubprocessLimits& config) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw EnvironmentError(std::string("cannot make a pipe: ") + std::strerror(errno));
  Descriptor from(ends[0]), to(ends[1]);
  sigset_t all, before;
  ::sigfillset(&all);
  (void)::pthread_sigmask(SIG_SETMASK, &all, &before);  // a handler of the caller's must not run in the child
  const pid_t pid = ::fork();
  if (pid != 0) (void)::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (pid < 0) throw EnvironmentError(std::string("cannot make a process: ") + std::strerror(errno));
  if (pid == 0) child(to.get(), task, config);
  to.close_now();
  std::optional<std::string> answer = read_all(from.get(), config.answer);
  from.close_now();  // a child that still writes ends
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  if (signal == SIGALRM) return {SubprocessEnd::out_of_wall_time, {}};
  if (signal == SIGXCPU) return {SubprocessEnd::out_of_cpu_time, {}};
  const bool whole = answer && !answer->empty() && answer->back() == done;
  if (!whole || !WIFEXITED(status) || WEXITSTATUS(status) != 0) return {};
  answer->pop_back();
  return {SubprocessEnd::answered, std::move(answer)};
}

}  // namespace plumbline::bim
