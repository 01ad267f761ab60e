// SPDX-License-Identifier: Apache-2.0
#include "slam/process/spawn.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "bim/config/descriptor.h"
#include "bim/errors.h"
#include "slam/process/child.h"
#include "slam/process/search_path.h"

namespace plumbline::slam {

namespace {

constexpr int child_stream = 3, child_file = 4, child_report = 5;
constexpr int lowest_spare = 16;  ///< our copies of descriptors stand above those that the child gives away

enum class Step : int { folder, program };

/// What a child that cannot become the program says of it.
struct Report {
  Step step = Step::program;
  int error = 0;
};

/// -1 of -1.
int spare_copy(int fd) {
  const int copy = fd < 0 ? -1 : ::fcntl(fd, F_DUPFD_CLOEXEC, lowest_spare);
  if (fd >= 0 && copy < 0)
    throw EnvironmentError(std::string("a process cannot be given its descriptors: ") + std::strerror(errno));
  return copy;
}

std::vector<char*> pointers(const std::vector<std::string>& words) {
  std::vector<char*> all;
  for (const std::string& word : words) all.push_back(const_cast<char*>(word.c_str()));
  all.push_back(nullptr);
  return all;
}

/// Where a program of this name may stand, in the order of PATH.
std::vector<std::string> places_of(const std::string& program) {
  if (program.find('/') != std::string::npos) return {program};
  std::vector<std::string> places;
  for (const std::string& folder : search_path(".")) places.push_back(folder + "/" + program);
  return places;
}

/// All that the child uses, made before it is: it may not allocate.
struct Prepared {
  std::vector<std::string> places;
  std::vector<char*> argv, environment;
  const char* folder = nullptr;  ///< null: ours
  int output = -1, stream = -1, file = -1, report = -1;
  pid_t parent = -1;
};

[[noreturn]] void give_up(Step step) {
  const Report report{step, errno};
  static_cast<void>(!::write(child_report, &report, sizeof report));
  ::_exit(127);
}

/// Signals that this program handles or ignores come to the child as to any other.
void reset_signals() {
  struct sigaction usual {};
  usual.sa_handler = SIG_DFL;
  for (int signal = 1; signal < NSIG; ++signal) ::sigaction(signal, &usual, nullptr);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

[[noreturn]] void become(const Prepared& to) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != to.parent) ::_exit(127);  // it ended before the line above
  ::setsid();
  ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
  ::dup2(to.output, STDOUT_FILENO);
  ::dup2(to.output, STDERR_FILENO);
  ::dup2(to.stream, child_stream);
  if (to.file >= 0) ::dup2(to.file, child_file);
  if (to.file < 0) ::close(child_file);
  ::dup3(to.report, child_report, O_CLOEXEC);
  ::closefrom(child_report + 1);
  if (to.folder != nullptr && ::chdir(to.folder) != 0) give_up(Step::folder);
  reset_signals();
  int refused = 0;
  for (const std::string& place : to.places) {
    ::execve(place.c_str(), to.argv.data(), to.environment.data());
    if (errno != ENOENT && errno != ENOTDIR && errno != EACCES) give_up(Step::program);
    if (errno == EACCES) refused = errno;
  }
  errno = refused != 0 ? refused : ENOENT;
  give_up(Step::program);
}

/// Nothing where it has become the program.
Report read_report(int fd) {
  Report report;
  ssize_t got = -1;
  while ((got = ::read(fd, &report, sizeof report)) < 0 && errno == EINTR) continue;
  return got == static_cast<ssize_t>(sizeof report) ? report : Report{};
}

}  // namespace

pid_t spawn(const SpawnPlan& plan) {
  std::array<int, 2> ends{-1, -1};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw EnvironmentError(std::string("no connection to a process can be made: ") + std::strerror(errno));
  const Descriptor report(ends[0]);
  Descriptor said(ends[1]);
  const Descriptor output(spare_copy(plan.output)), stream(spare_copy(plan.stream)), file(spare_copy(plan.file));
  Descriptor reports(spare_copy(said.get()));
  const Prepared prepared{places_of(plan.command.front()),
                          pointers(plan.command),
                          pointers(plan.environment),
                          plan.folder.empty() ? nullptr : plan.folder.c_str(),
                          output.get(),
                          stream.get(),
                          file.get(),
                          reports.get(),
                          ::getpid()};
  sigset_t all, before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);  // a handler of ours must not run in the child
  const pid_t child = ::fork();
  if (child == 0) become(prepared);
  const int failed = errno;
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (child < 0) throw EnvironmentError(std::string("no process can be started: ") + std::strerror(failed));
  said.close_now();
  reports.close_now();
  const Report what = read_report(report.get());
  if (what.error == 0) return child;
  ::waitpid(child, nullptr, 0);
  const std::string why = std::strerror(what.error);
  if (what.step == Step::folder)
    throw ProcessFailure("cannot be started: its folder '" + plan.folder + "' cannot be entered: " + why);
  throw ProcessFailure("'" + plan.command.front() + "' cannot be started: " + why);
}

}  // namespace plumbline::slam
