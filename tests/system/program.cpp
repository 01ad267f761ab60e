// SPDX-License-Identifier: Apache-2.0
#include "tests/system/program.h"

#include <fcntl.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace plumbline::system_tests {

namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

void redirect(const std::string& path, int fd) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  ::dup2(file, fd);
  ::close(file);
}

void allow_one_cpu() {
  cpu_set_t allowed;
  sched_getaffinity(0, sizeof(allowed), &allowed);
  int first = 0;
  while (first < CPU_SETSIZE && !CPU_ISSET(first, &allowed)) ++first;
  CPU_ZERO(&allowed);
  CPU_SET(first, &allowed);
  sched_setaffinity(0, sizeof(allowed), &allowed);
}

/// In the child: settles everything asked for and becomes the program.
[[noreturn]] void become(const std::vector<std::string>& command, const Setting& setting, const Folder& pipes) {
  redirect(pipes / "out", 1);
  redirect(pipes / "err", 2);
  if (setting.close_stdin) ::close(0);
  if (setting.one_cpu) allow_one_cpu();
  if (setting.largest_file) {
    const rlimit limit{*setting.largest_file, *setting.largest_file};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  for (const auto& [name, value] : setting.env)
    value ? setenv(name.c_str(), value->c_str(), 1) : unsetenv(name.c_str());
  if (!setting.cwd.empty() && ::chdir(setting.cwd.c_str()) != 0) _exit(126);
  std::vector<char*> argv;
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  ::execvp(argv[0], argv.data());
  _exit(127);
}

int wait_for(pid_t child, const Setting& setting) {
  int status = 0;
  bool sent = false;
  while (::waitpid(child, &status, setting.kill_when ? WNOHANG : 0) == 0) {
    if (!sent && setting.kill_when()) {
      ::kill(child, setting.signal);
      sent = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

bool available() { return !environment("PLUMBLINE_BINARY").empty() && !environment("PLUMBLINE_SOURCE").empty(); }

Outcome plumbline(const std::vector<std::string>& arguments, const Setting& setting) {
  std::vector<std::string> command = setting.wrapper;
  command.push_back(environment("PLUMBLINE_BINARY"));
  command.insert(command.end(), arguments.begin(), arguments.end());
  const Folder pipes;
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) become(command, setting, pipes);
  Outcome outcome;
  outcome.code = wait_for(child, setting);
  outcome.out = read_file(pipes / "out");
  outcome.err = read_file(pipes / "err");
  return outcome;
}

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void write_file(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

}  // namespace plumbline::system_tests
