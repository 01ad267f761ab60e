// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bim/config/visit.h"
#include "slam/methods.h"

namespace plumbline::scenarios {

/// A method that is a program of the user's, docs/guide/your_method.md.
struct ProcessSpec {
  std::string name;
  std::vector<std::string> command;
  std::optional<std::string> folder;
  bool plan = false;
  bool repeat = false;
  double start_s = 30.0;
  double scan_s = 10.0;
  double finish_s = 120.0;

  template <class V>
  void visit(V& v) {
    v("name", name, Field{.doc = "name of the method: letters, digits, - and _", .required = true});
    v("command", command,
      Field{.doc = "the program and its arguments; it is started in `folder`, and found in PATH where it has no slash",
            .required = true});
    v("folder", folder,
      Field{.doc = "folder in which it is started, relative to that of the file; that of the file when not given"});
    v("plan", plan, Field{.doc = "whether it localizes in the plan, which it then gets, and answers with hypotheses"});
    v("repeat", repeat,
      Field{.doc = "whether a second process gets the same; the method has crashed where it answers otherwise"});
    v("start_s", start_s, Field{.doc = "most time by the wall clock to start", .min = 0.01, .max = 86400.0});
    v("scan_s", scan_s, Field{.doc = "most time for the answer to one scan", .min = 0.01, .max = 86400.0});
    v("finish_s", finish_s, Field{.doc = "most time for the answer at the end", .min = 0.01, .max = 86400.0});
  }
};

/// A method as the command line gives it: "NAME=PROGRAM ARGUMENT...", words apart by spaces, ' and " around words with
/// spaces. Nothing where the text has no '='. Throws InputError at the option `where`, also where no program is named.
[[nodiscard]] std::optional<ProcessSpec> process_of(const std::string& text, const std::string& folder,
                                                    const std::string& where = "--method");

/// Throws InputError where there is no program of this name: in `folder` where it has a slash, else in PATH.
void check_program(const std::vector<std::string>& command, const std::string& folder, const Mark& mark);

/// A table of methods with processes added. Throws InputError at marks[i] where process i has no name or one that is
/// taken, or no command.
class ProcessTable {
 public:
  ProcessTable(slam::MethodTable table, std::vector<ProcessSpec> processes, const std::vector<Mark>& marks);
  [[nodiscard]] slam::MethodTable table() const { return rows_; }

 private:
  std::vector<ProcessSpec> processes_;  ///< the rows' names stand here
  std::vector<slam::MethodRow> rows_;
};

}  // namespace plumbline::scenarios
