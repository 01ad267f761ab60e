// SPDX-License-Identifier: Apache-2.0
#include "slam/process/child.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

#include "bim/config/utf8.h"
#include "bim/errors.h"
#include "tests/folder.h"

namespace plumbline::slam {
namespace {

std::vector<std::string> shell(const std::string& script) { return {"/bin/sh", "-c", script}; }

double seconds_of(const std::function<void()>& work) {
  const auto before = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
}

TEST(Child, WithoutItsStreamItHasUntilTheDeadline) {
  Child slow(shell("exec 3>&-; sleep 2.5"), "", {});
  slow.set_deadline(20.0);
  EXPECT_TRUE(slow.close_and_wait());
  EXPECT_TRUE(slow.ended());
  Child slower(shell("exec 3>&-; sleep 100"), "", {});
  slower.set_deadline(0.2);
  EXPECT_LT(seconds_of([&] { EXPECT_FALSE(slower.close_and_wait()); }), 1.5);
  EXPECT_FALSE(slower.ended());
}

TEST(Child, WhatItPrintsWithoutItsStreamDoesNotHoldItUp) {
  Child child(shell("exec 3>&-; head -c 1000000 /dev/zero; echo; echo done"), "", {});
  child.set_deadline(20.0);
  EXPECT_TRUE(child.close_and_wait());
  EXPECT_TRUE(child.ended());
}

TEST(Child, WhatItSendsWithoutEndIsReadUntilTheDeadline) {
  Child child(shell("exec cat /dev/zero >&3"), "", {});
  char byte = 0;
  child.set_deadline(60.0);
  child.receive(&byte, 1);  // it runs
  child.set_deadline(0.2);
  EXPECT_FALSE(child.close_and_wait());
  EXPECT_FALSE(child.ended());
  EXPECT_TRUE(child.sent_more());
  Child silent(shell("exit 0"), "", {});
  silent.set_deadline(20.0);
  EXPECT_TRUE(silent.close_and_wait());
  EXPECT_FALSE(silent.sent_more());
}

TEST(Child, AFloodIsNamedLongBeforeTheDeadline) {
  Child prints(shell("exec cat /dev/zero"), "", {});
  prints.limit_printing(1U << 20U);
  prints.set_deadline(3600.0);
  char byte = 0;
  try {
    prints.receive(&byte, 1);
    ADD_FAILURE() << "got an answer";
  } catch (const ProcessFailure& failure) {
    EXPECT_STREQ(failure.what(), "printed more than 1 MiB for one answer");
  }
  Child sends(shell("exec cat /dev/zero >&3"), "", {});
  sends.set_deadline(3600.0);
  EXPECT_FALSE(sends.close_and_wait(true));
  EXPECT_TRUE(sends.sent_more());
}

TEST(Child, ADeadlineJustBelowASecondCounts) {
  Child child(shell("sleep 10; exit 7"), "", {});
  child.set_deadline(0.9999999999);
  char byte = 0;
  try {
    child.receive(&byte, 1);
    ADD_FAILURE() << "got an answer";
  } catch (const ProcessFailure& failure) {
    EXPECT_STREQ(failure.what(), "gave no answer within 1 s");
  }
}

TEST(Child, WithoutDescriptorsItIsNotStartedAtAll) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit few = before;
  few.rlim_cur = 16;  // not enough for what the child is given; nor for the connection, where many files are open
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &few), 0);
  std::string said;
  try {
    const Child child(shell("exit 0"), "", {});
  } catch (const EnvironmentError& error) {
    said = error.what();
  }
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  EXPECT_FALSE(said.empty());
}

TEST(Child, SaysHowItEnded) {
  Child exits(shell("exit 7"), "", {}), killed(shell("kill -9 $$"), "", {});
  for (Child* child : {&exits, &killed}) {
    child->set_deadline(20.0);
    EXPECT_FALSE(child->close_and_wait());
    EXPECT_TRUE(child->ended());
  }
  EXPECT_EQ(exits.how_it_ended(), "exited with 7");
  EXPECT_EQ(killed.how_it_ended(), "was ended by signal 9");
}

TEST(Child, WhatItPrintedLastIsTextInUtf8) {
  const auto failure_of = [](const std::string& script) -> std::string {
    Child child(shell(script), "", {});
    child.set_deadline(20.0);
    char byte = 0;
    try {
      child.receive(&byte, 1);
    } catch (const ProcessFailure& failure) {
      return failure.what();
    }
    return "";
  };
  EXPECT_EQ(failure_of("printf 'Fehler beim \\326ffnen\\n'; exit 3"),
            "exited with 3; the last it printed: Fehler beim Öffnen");
  EXPECT_EQ(failure_of("printf '10 %%\\r20 %%\\r\\n'; exit 3"), "exited with 3; the last it printed: 20 %");
  // Only the end is kept, and may begin within a character.
  for (const std::string before : {"", "x", "xx"}) {
    const std::string said = failure_of("printf '" + before + "'; for i in $(seq 2000); do printf '█'; done; exit 3");
    EXPECT_EQ(utf8_of_bytes(said), said);
    EXPECT_NE(said.find("printed: █"), std::string::npos) << said.substr(0, 60);
  }
}

// What it started holds the stream open.
TEST(Child, ItsEndIsSeenWhateverItLeavesBehind) {
  Child child(shell("sleep 100 & printf now >&3; exit 7"), "", {});
  child.set_deadline(50.0);
  std::array<char, 3> answer{};
  const double took = seconds_of([&] {
    child.receive(answer.data(), answer.size());  // what was sent before is read
    try {
      child.receive(answer.data(), 1);
      ADD_FAILURE() << "got an answer";
    } catch (const ProcessFailure& failure) {
      EXPECT_STREQ(failure.what(), "exited with 7");
    }
  });
  EXPECT_EQ(std::string(answer.data(), answer.size()), "now");
  EXPECT_LT(took, 20.0);
}

// A daemon in a session of its own, with another parent and environment, but with the stream or the output.
TEST(Child, WhatHoldsItsStreamOrOutputDiesWithIt) {
  const Folder folder;
  for (const std::string kept : {"3>&-", ">/dev/null 2>&1"}) {
    const std::string file = folder / "number";
    {
      Child child(shell("(env -i /usr/bin/setsid /bin/sh -c 'echo $$ >" + file + ".new; /bin/mv " + file + ".new " +
                        file + "; exec /bin/sleep 100' " + kept + " &); exec sleep 100"),
                  "", {});
      while (!std::filesystem::exists(file)) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::string number;
    std::ifstream(file) >> number;
    // What is killed ends when it gets a core; unharmed, it would last for 100 s.
    std::string status;
    for (int wait = 0; wait < 1000; ++wait) {
      status.clear();
      std::getline(std::ifstream("/proc/" + number + "/stat"), status);
      if (status.empty() || status.find(") Z ") != std::string::npos) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_TRUE(status.empty() || status.find(") Z ") != std::string::npos) << status;
    std::filesystem::remove(file);
  }
}

TEST(Child, AMissingFolderIsNoMissingProgram) {
  const auto failure_of = [](const std::vector<std::string>& command, const std::string& folder) -> std::string {
    try {
      const Child child(command, folder, {});
    } catch (const ProcessFailure& failure) {
      return failure.what();
    }
    return "";
  };
  EXPECT_EQ(failure_of(shell("exit 0"), "/no/such"),
            "cannot be started: its folder '/no/such' cannot be entered: No such file or directory");
  EXPECT_EQ(failure_of({"no_such_program"}, ""), "'no_such_program' cannot be started: No such file or directory");
  EXPECT_EQ(failure_of({"./child"}, "/"), "'./child' cannot be started: No such file or directory");
}

TEST(Child, EndsWithTheThreadThatMadeIt) {
  std::optional<Child> child;
  std::thread([&] { child.emplace(shell("sleep 100"), "", std::vector<std::string>()); }).join();
  child->set_deadline(50.0);
  char byte = 0;
  EXPECT_LT(seconds_of([&] { EXPECT_THROW(child->receive(&byte, 1), ProcessFailure); }), 20.0);
  EXPECT_EQ(child->how_it_ended(), "was ended by signal 9");
}

TEST(Child, WaitingForItEndsWhenItsParentMayNotGoOn) {
  struct Stop {};
  int asked = 0;
  const auto go_on = [&] {
    if (++asked > 3) throw Stop();
  };
  const double took = seconds_of([&] {
    Child child(shell("sleep 100"), "", {}, {}, -1, go_on);
    child.set_deadline(50.0);
    char byte = 0;
    EXPECT_THROW(child.receive(&byte, 1), Stop);
    asked = 0;
    EXPECT_THROW((void)child.close_and_wait(), Stop);
  });
  EXPECT_LT(took, 20.0);
}

}  // namespace
}  // namespace plumbline::slam
