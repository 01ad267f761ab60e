// SPDX-License-Identifier: Apache-2.0
#include "slam/process/child.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/timerfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "bim/config/utf8.h"
#include "bim/errors.h"
#include "slam/io/stopwatch.h"
#include "slam/process/spawn.h"

extern char** environ;

namespace plumbline::slam {

namespace {

constexpr std::size_t printed_max = 4096;
constexpr int look_ms = 100;  ///< between two looks at whether the process is there, and we shall go on
constexpr int reap_ms = 10;   ///< between two looks at whether a process has ended

std::string error_text(int error) { return std::strerror(error); }

/// Two connected descriptors that no other child inherits.
std::array<int, 2> pipe_or_socket(bool socket) {
  std::array<int, 2> ends{-1, -1};
  const int made =
      socket ? ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) : ::pipe2(ends.data(), O_CLOEXEC);
  if (made != 0) throw EnvironmentError("no connection to a process can be made: " + error_text(errno));
  return ends;
}

/// The last line of printed bytes that may begin within a character. A progress bar ends its lines by \r.
std::string last_line(std::string_view printed) {
  constexpr std::string_view ends = "\r\n";
  printed = printed.substr(0, printed.find_last_not_of(ends) + 1);
  printed.remove_prefix(printed.find_last_of(ends) + 1);
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; };
  while (!printed.empty() && continues(printed.front())) printed.remove_prefix(1);
  return utf8_of_bytes(printed);
}

/// This process's environment with some variables set.
std::vector<std::string> environment_with(const std::vector<std::string>& variables) {
  std::vector<std::string> all = variables;
  for (char** at = environ; *at != nullptr; ++at) {
    const std::string one = *at;
    const std::string name = one.substr(0, one.find('=') + 1);
    const bool given = std::any_of(variables.begin(), variables.end(),
                                   [&](const std::string& variable) { return variable.starts_with(name); });
    if (!given) all.push_back(one);
  }
  return all;
}

/// A variable that no other process has set, of this program or another one.
std::string new_mark() {
  static std::atomic<int> count = 0;
  return "PLUMBLINE_PROCESS=" + std::to_string(::getpid()) + "." + std::to_string(slam::wall_s()) + "." +
         std::to_string(++count);
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// What the links of open descriptors say of this one: "pipe:[4711]".
std::string link_of(const std::filesystem::path& descriptor) {
  std::error_code error;
  return std::filesystem::read_symlink(descriptor, error).string();
}

bool holds_any(const std::filesystem::path& process, const std::vector<std::string>& links) {
  std::error_code error;
  for (std::filesystem::directory_iterator at(process / "fd", error), end; !error && at != end; at.increment(error))
    if (std::find(links.begin(), links.end(), link_of(at->path())) != links.end()) return true;
  return false;
}

/// Running processes that descend from `root`, are of its session, have the mark in their environment or hold one of
/// the links, and what descends from those. Other children of this process may hold the links until they are programs.
std::set<pid_t> with_descendants(pid_t root, pid_t session, const std::string& mark,
                                 const std::vector<std::string>& links) {
  const pid_t own = ::getpid();
  std::map<pid_t, pid_t> parents;
  std::set<pid_t> found;
  std::error_code error;
  for (std::filesystem::directory_iterator at("/proc", error), end; !error && at != end; at.increment(error)) {
    const pid_t process = static_cast<pid_t>(std::atoi(at->path().filename().c_str()));
    if (process <= 0 || process == own) continue;
    const std::string status = text_of(at->path() / "stat");  // pid (name) state parent group session
    const std::size_t name_end = status.rfind(')');
    char state = 'Z';
    int parent = 0, group = 0, its_session = 0;
    if (name_end == std::string::npos ||
        std::sscanf(status.c_str() + name_end + 1, " %c %d %d %d", &state, &parent, &group, &its_session) != 4 ||
        state == 'Z')
      continue;
    parents[process] = parent;
    std::string environment(1, '\0');
    environment += text_of(at->path() / "environ");
    if (process == root || its_session == session || environment.find('\0' + mark + '\0') != std::string::npos ||
        (parent != own && holds_any(at->path(), links)))
      found.insert(process);
  }
  for (bool more = true; more;) {
    more = false;
    for (const auto& [process, parent] : parents)
      if (found.contains(parent)) more = found.insert(process).second || more;
  }
  return found;
}

void close_if_open(int& descriptor) {
  if (descriptor >= 0) ::close(descriptor);
  descriptor = -1;
}

}  // namespace

Child::Child(const std::vector<std::string>& command, const std::string& folder,
             const std::vector<std::string>& variables, std::function<void(std::string_view)> printed, int inherited,
             std::function<void()> go_on)
    : mark_(new_mark()), on_printed_(std::move(printed)), go_on_(std::move(go_on)) {
  const auto [own_stream, its_stream] = pipe_or_socket(true);
  const auto [own_output, its_output] = pipe_or_socket(false);
  stream_ = own_stream;
  output_ = own_output;
  timer_ = ::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK);
  const int no_timer = errno;
  ::fcntl(stream_, F_SETFL, O_NONBLOCK);
  // A whole scan goes through in few turns; the system may allow less.
  constexpr int scan_bytes = 4 << 20;
  ::setsockopt(stream_, SOL_SOCKET, SO_SNDBUF, &scan_bytes, sizeof scan_bytes);
  ::fcntl(output_, F_SETFL, O_NONBLOCK);

  std::vector<std::string> marked = variables;
  marked.push_back(mark_);
  try {
    if (timer_ < 0) throw EnvironmentError("no deadline of a process can be set: " + error_text(no_timer));
    pid_ = spawn({command, folder, environment_with(marked), its_output, its_stream, inherited});
  } catch (...) {
    for (const int descriptor : {its_stream, its_output}) ::close(descriptor);
    for (int* descriptor : {&stream_, &output_, &timer_}) close_if_open(*descriptor);
    throw;
  }
  for (const int descriptor : {its_stream, its_output}) {
    const std::string link = link_of("/proc/self/fd/" + std::to_string(descriptor));
    if (!link.empty()) links_.push_back(link);
    ::close(descriptor);
  }
}

Child::~Child() {
  close_if_open(stream_);
  kill_all();
  if (!ended_) ::waitpid(pid_, &status_, 0);
  close_if_open(output_);
  close_if_open(timer_);
}

// What was started while the others were found is found the next time.
void Child::kill_all() const {
  constexpr int tries = 100;
  std::set<pid_t> killed;
  for (int i = 0; i < tries; ++i) {
    const std::set<pid_t> all = with_descendants(ended_ ? 0 : pid_, ended_ ? -1 : pid_, mark_, links_);
    bool any = false;
    for (const pid_t process : all) any = killed.insert(process).second || any;
    for (const pid_t process : all) ::kill(process, SIGKILL);
    if (!any) break;
  }
  // Where /proc is missing. The number of one that has ended may be another group's.
  std::error_code error;
  if (!ended_ || !std::filesystem::exists("/proc/self/stat", error)) ::kill(-pid_, SIGKILL);
}

void Child::set_deadline(double seconds) {
  printing_ = 0;
  deadline_s_ = seconds;
  constexpr std::int64_t second_ns = 1'000'000'000;
  const std::int64_t ns = std::max<std::int64_t>(1, std::llround(1e9 * seconds));  // 0 would stop the timer
  itimerspec time{};
  time.it_value.tv_sec = ns / second_ns;
  time.it_value.tv_nsec = ns % second_ns;
  if (::timerfd_settime(timer_, 0, &time, nullptr) != 0)
    throw EnvironmentError("no deadline of a process can be set: " + error_text(errno));
}

void Child::send(const void* bytes, std::size_t size) {
  const char* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t sent = ::send(stream_, at, size, MSG_NOSIGNAL);
    if (sent > 0) {
      at += sent;
      size -= static_cast<std::size_t>(sent);
    } else if (sent < 0 && (errno == EAGAIN || errno == EINTR)) {
      const Ready ready = wait_for(POLLOUT);
      if (ready == Ready::over) throw ProcessFailure("took more than its time to read what it was sent");
      if (ready == Ready::ended) fail_as_it_ended();
    } else {
      fail_as_it_ended();
    }
  }
}

void Child::receive(void* bytes, std::size_t size) {
  char* at = static_cast<char*>(bytes);
  while (size > 0) {
    const ssize_t got = ::recv(stream_, at, size, 0);
    if (got > 0) {
      at += got;
      size -= static_cast<std::size_t>(got);
    } else if (got < 0 && (errno == EAGAIN || errno == EINTR)) {
      const Ready ready = wait_for(POLLIN);
      if (ready == Ready::ended) fail_as_it_ended();
      if (ready == Ready::over) fail_as_late();
    } else {
      fail_as_it_ended();
    }
  }
}

// What it started may hold the stream open after its end: the last answers are there then, and no more will come.
Child::Ready Child::wait_for(short events) {
  for (;;) {
    std::array<pollfd, 3> waits{{{stream_, events, 0}, {timer_, POLLIN, 0}, {output_, POLLIN, 0}}};
    if (go_on_) go_on_();
    const bool gone = reap();
    // Another thread may have got the signal, or it came just before: an interrupted poll alone would not tell.
    if (::poll(waits.data(), waits.size(), gone ? 0 : look_ms) < 0) {
      if (errno != EINTR) throw EnvironmentError("no process can be waited for: " + error_text(errno));
      continue;
    }
    if (waits[2].revents != 0) read_printed();
    if (waits[0].revents != 0) return Ready::stream;
    if (gone) return Ready::ended;
    if (waits[1].revents != 0) return Ready::over;
  }
}

void Child::read_printed() {
  std::array<char, 65536> text;
  const ssize_t got = ::read(output_, text.data(), text.size());
  if (got > 0) {
    if (on_printed_) on_printed_({text.data(), static_cast<std::size_t>(got)});
    printed_.append(text.data(), static_cast<std::size_t>(got));
    if (printed_.size() > printed_max) printed_.erase(0, printed_.size() - printed_max);
    printing_ += static_cast<std::size_t>(got);
    if (printing_ > printing_most_)
      throw ProcessFailure("printed more than " + std::to_string(printing_most_ >> 20U) + " MiB for one answer");
  } else if (got == 0) {
    close_if_open(output_);  // poll() passes over -1
  }
}

bool Child::time_is_over() const {
  if (go_on_) go_on_();
  pollfd timer{timer_, POLLIN, 0};
  return ::poll(&timer, 1, 0) > 0;
}

// It may write for as long as it is read.
bool Child::close_and_wait(bool nothing_more) {
  ::shutdown(stream_, SHUT_WR);
  std::array<char, 65536> passed_over;
  for (;;) {
    const ssize_t got = ::recv(stream_, passed_over.data(), passed_over.size(), 0);
    if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) break;
    if (got > 0) {
      sent_more_ = true;
      if (nothing_more || time_is_over()) return false;
      continue;
    }
    const Ready ready = wait_for(POLLIN);
    if (ready == Ready::over) return false;
    if (ready == Ready::ended) break;
  }
  // It may go on without the stream, and print.
  while (!reap()) {
    if (go_on_) go_on_();
    std::array<pollfd, 2> waits{{{timer_, POLLIN, 0}, {output_, POLLIN, 0}}};
    if (::poll(waits.data(), waits.size(), reap_ms) <= 0) continue;
    if (waits[1].revents != 0) read_printed();
    if (waits[0].revents != 0) return false;
  }
  return ended_ && WIFEXITED(status_) && WEXITSTATUS(status_) == 0;
}

bool Child::reap() {
  if (!ended_) ended_ = ::waitpid(pid_, &status_, WNOHANG) == pid_;
  return ended_;
}

double Child::cpu_ms() const { return ended_ ? 0.0 : 1e3 * process_cpu_s(pid_); }

void Child::check_time() const {
  if (time_is_over()) fail_as_late();
}

void Child::fail_as_late() const {
  char text[32];
  std::snprintf(text, sizeof text, "%g s", deadline_s_);
  throw ProcessFailure("gave no answer within " + std::string(text));
}

void Child::fail_as_it_ended() {
  const std::string how = how_it_ended();
  if (output_ >= 0) read_printed();
  const std::string last = last_line(printed_);
  throw ProcessFailure(how + (last.empty() ? "" : "; the last it printed: " + last));
}

// It may have closed the stream and gone on.
std::string Child::how_it_ended() {
  constexpr int tries = 100;
  for (int i = 0; i < tries && !reap(); ++i) ::poll(nullptr, 0, reap_ms);
  if (!ended_) return "closed the connection";
  if (WIFSIGNALED(status_)) return "was ended by signal " + std::to_string(WTERMSIG(status_));
  return "exited with " + std::to_string(WEXITSTATUS(status_));
}

}  // namespace plumbline::slam
