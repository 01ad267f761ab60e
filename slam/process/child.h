// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline::slam {

/// A process that does not do what it should; what() says what it did.
class ProcessFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A child process and a stream to it, which is its file descriptor 3. Its standard input is empty; what it prints is
/// kept, the last of it. It dies with this object, and all that it started with it, in whatever session: what descends
/// from it, is of its session, has its environment, or holds its stream or output open. What has given up all of these
/// is not found. It dies with the thread that made it, too, so that a killed program leaves none.
class Child {
 public:
  /// folder: its working directory. variables: NAME=VALUE, over those of this process. printed: gets what it prints, as
  /// it comes. inherited: descriptor of this process that the child gets as descriptor 4; -1: none. go_on: called again
  /// and again while the child is waited for; what it throws ends the waiting. Throws ProcessFailure where the program
  /// cannot be started.
  Child(const std::vector<std::string>& command, const std::string& folder, const std::vector<std::string>& variables,
        std::function<void(std::string_view)> printed = {}, int inherited = -1, std::function<void()> go_on = {});
  ~Child();
  Child(const Child&) = delete;
  Child(Child&&) = delete;
  Child& operator=(const Child&) = delete;
  Child& operator=(Child&&) = delete;

  /// From now on it may print so many bytes within one deadline; ProcessFailure where it prints more.
  void limit_printing(std::size_t most_bytes) { printing_most_ = most_bytes; }
  /// From now on send() and receive() together may take this long by the wall clock. Throws EnvironmentError.
  void set_deadline(double seconds);
  /// All bytes, or ProcessFailure: the process ended, or the time is over.
  void send(const void* bytes, std::size_t size);
  void receive(void* bytes, std::size_t size);
  /// ProcessFailure where the time is over: between messages of one that may send them without end.
  void check_time() const;
  /// Closes the stream, passes over what still comes unless `nothing_more`, and waits for the process until the
  /// deadline; whether it ended by itself, with 0.
  [[nodiscard]] bool close_and_wait(bool nothing_more = false);
  /// Whether anything came after close_and_wait().
  [[nodiscard]] bool sent_more() const { return sent_more_; }
  [[nodiscard]] bool ended() const { return ended_; }
  /// "exited with 7", a clause; of one that has closed the stream, after a moment for it to end.
  [[nodiscard]] std::string how_it_ended();

  /// CPU time of the process itself so far, ms; 0 where the system does not tell.
  [[nodiscard]] double cpu_ms() const;
  /// The last lines that it printed.
  [[nodiscard]] const std::string& printed() const { return printed_; }

 private:
  enum class Ready { stream, over, ended };
  [[nodiscard]] Ready wait_for(short events);
  /// Whether the process has ended; takes its status the first time.
  bool reap();
  [[nodiscard]] bool time_is_over() const;
  void read_printed();
  void kill_all() const;
  [[noreturn]] void fail_as_late() const;
  [[noreturn]] void fail_as_it_ended();

  std::string mark_;                ///< in the environment of all that it starts
  std::vector<std::string> links_;  ///< its stream and output, as /proc names them; no other program has them open
  pid_t pid_ = -1;
  int stream_ = -1, output_ = -1, timer_ = -1;
  double deadline_s_ = 0.0;
  bool ended_ = false, sent_more_ = false;
  int status_ = 0;
  std::string printed_;       ///< the last of it
  std::size_t printing_ = 0;  ///< bytes since the deadline was set
  std::size_t printing_most_ = std::numeric_limits<std::size_t>::max();
  std::function<void(std::string_view)> on_printed_;
  std::function<void()> go_on_;
};

}  // namespace plumbline::slam
