// SPDX-License-Identifier: Apache-2.0
#include <embree3/rtcore_config.h>
#include <gnu/libc-version.h>
#include <sqlite3.h>

#include <Eigen/Core>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bim/config/printable.h"
#include "bim/errors.h"
#include "scenarios/app/commands.h"
#include "scenarios/app/process.h"
#include "scenarios/host/files.h"
#include "scenarios/host/terminal.h"
#include "scenarios/spec/library.h"
#include "slam/process/child.h"
#include "slam/process/client_folder.h"

namespace plumbline::scenarios {

namespace {

/// One line: what was looked for, and what there is.
void say(const char* state, const std::string& what, const std::string& found) {
  char name[40];
  std::snprintf(name, sizeof name, "%-8s%-22s", state, what.c_str());
  print(name + printable(found) + "\n");
}

/// Whether a command ends with 0 within ten seconds.
bool works(const std::vector<std::string>& command) {
  try {
    slam::Child child(command, "", {});
    constexpr double patience_s = 10.0;
    child.set_deadline(patience_s);
    return child.close_and_wait();
  } catch (const slam::ProcessFailure&) {
    return false;
  }
}

std::string version(int a, int b, int c) {
  return std::to_string(a) + "." + std::to_string(b) + "." + std::to_string(c);
}

/// What only some tasks need.
void optional(const std::string& what, const std::vector<std::string>& command, const std::string& use) {
  const bool there = works(command);
  say(there ? "ok" : "missing", what, there ? use : use + "; not found, or it does not run");
}

int examine() {
  int broken = 0;
  std::error_code error;
  say("ok", "plumbline",
      std::string(PLUMBLINE_VERSION) + ", " + std::filesystem::read_symlink("/proc/self/exe", error).string());
  say("ok", "cpus", std::to_string(allowed_cpus()) + " allowed");
  say("ok", "glibc", gnu_get_libc_version());
  say("ok", "eigen", version(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION));
  say("ok", "embree", RTC_VERSION_STRING);
  say("ok", "sqlite", sqlite3_libversion());
  const auto folder = [&](const std::string& what, const std::string& path, const std::string& use) {
    say(path.empty() ? "BROKEN" : "ok", what,
        path.empty() ? "not found beside the program; install it whole" : path + use);
    broken += path.empty() ? 1 : 0;
  };
  folder("scenarios", library_folder(), ": plumbline scenarios lists them");
  folder("clients", slam::client_folder(), ": for methods that are processes");
  optional("python3 with numpy", {"python3", "-c", "import numpy"}, "methods in Python");
  optional("/usr/bin/python3", {"/usr/bin/python3", "-c", "import numpy"}, "the examples of methods in Python");
  optional("g++", {"g++", "--version"}, "methods in C++, packages that link to this one");
  optional("sbatch", {"sbatch", "--version"}, "sweeps on a cluster");
  print(broken == 0 ? "all that the program itself needs is there\n" : "the installation is not whole\n");
  constexpr int environment = 3;
  return broken == 0 ? 0 : environment;
}

/// Names and removes what killed runs left in a folder of runs.
int tidy(const std::string& folder) {
  if (!std::filesystem::is_directory(folder))
    throw InputError({folder, 0, 0}, "no such directory; name one with runs in it");
  const std::vector<std::string> unfinished = unfinished_in(folder);
  for (const std::string& directory : unfinished) {
    const bool removed = remove_abandoned(directory);
    say(removed ? "removed" : "kept", ".partial",
        directory +
            (removed ? ": left by a run that was killed" : ": a run is writing there, or it may not be removed"));
  }
  if (unfinished.empty()) print("no run left anything unfinished in " + printable(folder) + "\n");
  return 0;
}

}  // namespace

Command add_doctor(CommandLine& program) {
  CommandLine line =
      program.add_command("doctor", "Says what is installed, what is missing, and what that is needed for");
  const auto folder = std::make_shared<std::string>();
  line.option("FOLDER", *folder,
              "instead: list and delete temporary files that killed runs left in this folder and below it")
      .takes("DIR");
  line.footer(
      "Example: plumbline doctor\n         plumbline doctor runs\nExit codes: 0 all that the program itself needs is "
      "there, 3 it is not");
  return {line, [folder] { return folder->empty() ? examine() : tidy(*folder); }};
}

}  // namespace plumbline::scenarios
