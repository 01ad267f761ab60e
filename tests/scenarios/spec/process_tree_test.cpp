// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/process_tree.h"

#include <gtest/gtest.h>

#include "bim/errors.h"

namespace plumbline::scenarios {
namespace {

TEST(ProcessTree, MethodsGivenAsMapsStandUnderProcesses) {
  const Tree tree =
      with_processes_apart(read_yaml("methods: [vgicp, {name: mine, command: [./a]}]\nprocesses: [{name: b}]", "x"));
  ASSERT_EQ(tree.find("methods")->as_list().size(), 2U);
  EXPECT_EQ(tree.find("methods")->as_list()[1].as_string(), "mine");
  ASSERT_EQ(tree.find("processes")->as_list().size(), 2U);
  EXPECT_EQ(tree.find("processes")->as_list()[0].find("name")->as_string(), "b");
  EXPECT_NE(tree.find("processes")->as_list()[1].find("command"), nullptr);
  EXPECT_EQ(with_processes_apart(read_yaml("methods: [vgicp]", "x")).find("processes"), nullptr);
  EXPECT_THROW((void)with_processes_apart(read_yaml("methods: [{command: [./a]}]", "x")), InputError);
}

// A built-in method needs no braces.
TEST(ProcessTree, AMethodInBracesWithoutACommandIsRefusedWithWhatWouldBeRight) {
  try {
    (void)with_processes_apart(read_yaml("methods: [{name: vgicp, sensors: lidar}]", "x"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'.lidar'"), std::string::npos) << error.what();
  }
}

TEST(ProcessTree, AFolderThatIsGivenIsSeenFromTheScenarios) {
  const Tree tree = with_process_folders(read_yaml("methods: [{name: a, command: [x]}, {name: b, command: [x], "
                                                   "folder: own}, {name: c, command: [x], folder: /whole}]",
                                                   "x"),
                                         "/other");
  EXPECT_EQ(tree.find("processes")->as_list()[0].find("folder")->as_string(), "/other");
  EXPECT_EQ(tree.find("processes")->as_list()[1].find("folder")->as_string(), "/other/own");
  EXPECT_EQ(tree.find("processes")->as_list()[2].find("folder")->as_string(), "/whole");
}

}  // namespace
}  // namespace plumbline::scenarios
