// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/children.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <map>
#include <string_view>
#include <utility>

#include "bim/config/descriptor.h"
#include "bim/errors.h"
#include "scenarios/host/interrupt.h"

namespace plumbline::scenarios {

namespace {

constexpr int environment_failed = 3, could_not_start = 127, first_signal = 128;

/// Signals that the program catches end the child as they would any other, also those that came before this.
void stop_catching(const sigset_t& before) {
  for (const int caught : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    ::sigaction(caught, nullptr, &action);
    if (action.sa_handler != SIG_IGN) static_cast<void>(::signal(caught, SIG_DFL));
  }
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

/// In the child: nothing here may allocate.
[[noreturn]] void become(const char* program, char* const* argv, int log, pid_t parent, const sigset_t& mask) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  stop_catching(mask);
  if (::getppid() != parent) ::_exit(could_not_start);
  const int nowhere = ::open("/dev/null", O_RDWR);
  ::dup2(nowhere, STDIN_FILENO);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  ::execv(program, argv);
  ::_exit(could_not_start);
}

/// Of what a child wrote to its log.
std::string last_line(int log) {
  std::array<char, 8192> bytes{};
  const off_t end = ::lseek(log, 0, SEEK_END);
  const off_t from = std::max<off_t>(0, end - static_cast<off_t>(bytes.size()));
  const ssize_t got = ::pread(log, bytes.data(), bytes.size(), from);
  std::string_view text(bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(0, got)));
  while (text.ends_with('\n')) text.remove_suffix(1);
  return std::string(text.substr(text.rfind('\n') + 1));
}

/// Readable once the child has ended; negative where the system has none, as before Linux 5.3.
int end_descriptor(pid_t child) { return static_cast<int>(::syscall(SYS_pidfd_open, child, 0)); }

/// The children that run, stopped with this object.
class Running {
 public:
  Running() = default;
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  /// A child that is asked to stop ends its methods and all that those started; a killed one only the methods.
  ~Running() {
    constexpr int tries = 500, pause_ms = 10;
    for (const auto& [pid, child] : children_) ::kill(pid, SIGTERM);
    for (int i = 0; i < tries && !children_.empty(); ++i) {
      std::erase_if(children_, [](const auto& child) { return ::waitpid(child.first, nullptr, WNOHANG) != 0; });
      if (!children_.empty()) ::poll(nullptr, 0, pause_ms);
    }
    for (const auto& [pid, child] : children_) ::kill(pid, SIGKILL);
    for (const auto& [pid, child] : children_) ::waitpid(pid, nullptr, 0);
  }

  [[nodiscard]] std::size_t size() const { return children_.size(); }

  void start(const std::string& program, std::size_t index, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "plumbline");
    std::vector<char*> argv;
    for (std::string& text : arguments) argv.push_back(text.data());
    argv.push_back(nullptr);
    Descriptor log(::memfd_create("log", MFD_CLOEXEC));
    if (log.get() < 0)
      throw EnvironmentError(std::string("sweep: no memory for a run's messages: ") + std::strerror(errno));
    const pid_t parent = ::getpid();
    sigset_t all, before;
    sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);  // a handler of ours must not run in the child
    const pid_t child = ::fork();
    if (child == 0) become(program.c_str(), argv.data(), log.get(), parent, before);
    const int failure = errno;
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    if (child < 0) throw EnvironmentError(std::string("sweep: cannot start a run: ") + std::strerror(failure));
    children_.emplace(child, Child{index, std::move(log), Descriptor(end_descriptor(child))});
  }

  /// Waits for one of them to end.
  [[nodiscard]] std::pair<std::size_t, ChildEnd> wait() {
    while (true) {
      check_interrupt();
      int status = 0;
      const pid_t child = ::waitpid(-1, &status, WNOHANG);
      if (child < 0 && errno != EINTR)
        throw EnvironmentError(std::string("sweep: lost a run: ") + std::strerror(errno));
      if (child == 0) wait_for_news();
      const auto found = children_.find(child);
      if (found == children_.end()) continue;
      const std::size_t index = found->second.index;
      const std::string said = last_line(found->second.log.get());
      children_.erase(found);
      return {index, {WIFEXITED(status) ? WEXITSTATUS(status) : first_signal + WTERMSIG(status), said}};
    }
  }

 private:
  struct Child {
    std::size_t index = 0;
    Descriptor log;
    Descriptor end;  ///< end_descriptor()
  };

  /// Until a child ends or a signal comes, of which none is lost that comes before.
  void wait_for_news() const {
    constexpr int look_ms = 100;
    std::vector<pollfd> news = {{interrupt_descriptor(), POLLIN, 0}};
    for (const auto& [pid, child] : children_) news.push_back({child.end.get(), POLLIN, 0});
    const bool all = std::all_of(news.begin(), news.end(), [](const pollfd& one) { return one.fd >= 0; });
    ::poll(news.data(), news.size(), all ? -1 : look_ms);
  }

  std::map<pid_t, Child> children_;
};

}  // namespace

bool is_of_environment(const ChildEnd& end) {
  return end.code == environment_failed && !end.last_line.starts_with("plumbline: internal error");
}

bool broke(const ChildEnd& end) {
  constexpr std::array<int, 5> own = {SIGSEGV, SIGABRT, SIGFPE, SIGILL, SIGTRAP};
  if (end.code == environment_failed) return !is_of_environment(end) && !end.last_line.ends_with("std::bad_alloc");
  return std::find(own.begin(), own.end(), end.code - first_signal) != own.end();
}

std::string without_place(const std::string& last_line, const std::string& folder) {
  if (!last_line.starts_with(folder)) return last_line;
  const std::size_t end = last_line.find(": ");
  return end == std::string::npos ? last_line : last_line.substr(end + 2);
}

void run_children(std::size_t count, int jobs, const std::function<std::vector<std::string>(std::size_t)>& arguments,
                  const std::function<void(std::size_t, const ChildEnd&)>& ended, const std::string& program) {
  Running running;
  std::size_t next = 0;
  while (next < count || running.size() > 0) {
    check_interrupt();
    if (next < count && running.size() < static_cast<std::size_t>(std::max(jobs, 1))) {
      running.start(program, next, arguments(next));
      ++next;
      continue;
    }
    const auto [index, end] = running.wait();
    if (end.code == could_not_start)
      throw EnvironmentError(program == this_program ? "sweep: this program cannot start itself"
                                                     : program + ": cannot be started");
    ended(index, end);
  }
}

}  // namespace plumbline::scenarios
