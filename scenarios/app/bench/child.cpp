// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/bench/child.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "bim/errors.h"

namespace plumbline::scenarios {

namespace {

constexpr const char* self = "/proc/self/exe";

/// The file actions of a child that writes nowhere.
class Silence {
 public:
  Silence() {
    posix_spawn_file_actions_init(&actions_);
    for (const int fd : {STDOUT_FILENO, STDERR_FILENO})
      posix_spawn_file_actions_addopen(&actions_, fd, "/dev/null", O_WRONLY, 0);
  }
  ~Silence() { posix_spawn_file_actions_destroy(&actions_); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

double seconds(const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); }

}  // namespace

ChildCost run_self(const std::vector<std::string>& arguments) {
  std::vector<std::string> texts = {"plumbline"};
  texts.insert(texts.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& text : texts) argv.push_back(text.data());
  argv.push_back(nullptr);

  const Silence silence;
  pid_t child = 0;
  const int failure = posix_spawn(&child, self, silence.get(), nullptr, argv.data(), environ);
  if (failure != 0) throw EnvironmentError(std::string("bench: cannot start this program: ") + std::strerror(failure));
  int status = 0;
  rusage usage{};
  while (wait4(child, &status, 0, &usage) == -1)
    if (errno != EINTR) throw EnvironmentError(std::string("bench: lost the child: ") + std::strerror(errno));
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    throw EnvironmentError("bench: 'plumbline " + (arguments.empty() ? std::string() : arguments.front()) + "' failed");
  return {seconds(usage.ru_utime) + seconds(usage.ru_stime), 1024e-6 * static_cast<double>(usage.ru_maxrss)};
}

}  // namespace plumbline::scenarios
