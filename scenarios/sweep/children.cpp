// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/children.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <map>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "scenarios/host/interrupt.h"

namespace plumbline::scenarios {

namespace {

constexpr int could_not_start = 127;

/// In the child: nothing here may allocate.
[[noreturn]] void become(char* const* argv, int log, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(could_not_start);
  const int nowhere = ::open("/dev/null", O_RDWR);
  ::dup2(nowhere, STDIN_FILENO);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  ::execv("/proc/self/exe", argv);
  ::_exit(could_not_start);
}

/// The children that run, stopped with this object.
class Running {
 public:
  Running() = default;
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  /// A child that is asked to stop ends its methods and all that those started; a killed one only the methods.
  ~Running() {
    constexpr int tries = 500, pause_ms = 10;
    for (const auto& [pid, index] : children_) ::kill(pid, SIGTERM);
    for (int i = 0; i < tries && !children_.empty(); ++i) {
      std::erase_if(children_, [](const auto& child) { return ::waitpid(child.first, nullptr, WNOHANG) != 0; });
      if (!children_.empty()) ::poll(nullptr, 0, pause_ms);
    }
    for (const auto& [pid, index] : children_) ::kill(pid, SIGKILL);
    for (const auto& [pid, index] : children_) ::waitpid(pid, nullptr, 0);
  }

  [[nodiscard]] std::size_t size() const { return children_.size(); }

  void start(std::size_t index, std::vector<std::string> arguments, const std::string& log_path) {
    arguments.insert(arguments.begin(), "plumbline");
    std::vector<char*> argv;
    for (std::string& text : arguments) argv.push_back(text.data());
    argv.push_back(nullptr);
    const int log = ::open(log_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (log < 0) throw EnvironmentError(log_path + ": cannot be written: " + std::strerror(errno));
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child == 0) become(argv.data(), log, parent);
    const int failure = errno;
    ::close(log);
    if (child < 0) throw EnvironmentError(std::string("sweep: cannot start a run: ") + std::strerror(failure));
    children_.emplace(child, index);
  }

  /// Waits for one of them to end.
  [[nodiscard]] std::pair<std::size_t, int> wait() {
    while (true) {
      int status = 0;
      const pid_t child = ::waitpid(-1, &status, 0);
      check_interrupt();
      if (child < 0 && errno == EINTR) continue;
      if (child < 0) throw EnvironmentError(std::string("sweep: lost a run: ") + std::strerror(errno));
      const auto found = children_.find(child);
      if (found == children_.end()) continue;
      const std::size_t index = found->second;
      children_.erase(found);
      return {index, WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status)};
    }
  }

 private:
  std::map<pid_t, std::size_t> children_;
};

std::string last_line(const std::string& path) {
  std::string text;
  try {
    text = read_text_file(path);
  } catch (const InputError&) {
    return "";
  }
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

void run_children(std::size_t count, int jobs, const std::function<std::vector<std::string>(std::size_t)>& arguments,
                  const std::function<std::string(std::size_t)>& log,
                  const std::function<void(std::size_t, const ChildEnd&)>& ended) {
  Running running;
  std::size_t next = 0;
  while (next < count || running.size() > 0) {
    check_interrupt();
    if (next < count && running.size() < static_cast<std::size_t>(std::max(jobs, 1))) {
      running.start(next, arguments(next), log(next));
      ++next;
      continue;
    }
    const auto [index, code] = running.wait();
    if (code == could_not_start) throw EnvironmentError("sweep: this program cannot start itself");
    ended(index, {code, last_line(log(index))});
  }
}

}  // namespace plumbline::scenarios
