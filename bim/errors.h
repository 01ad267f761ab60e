// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace plumbline {

/// Where in an input a value was written. line and col count from 1; 0 means not known.
struct Mark {
  std::string file;
  int line = 0;
  int col = 0;
};

/// "file:line:col", leaving out what is not known.
std::string to_string(const Mark& mark);

/// Bad usage or bad input: exit code 2. what() is "file:line:col: what is wrong, and what would be right".
class InputError : public std::runtime_error {
 public:
  InputError(const Mark& mark, const std::string& message);
};

/// The environment failed the program (disk full, unwritable output, library failure): exit code 3.
class EnvironmentError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A promise of the program itself is broken (not-a-number): exit code 3.
class InternalError : public std::logic_error {
  using std::logic_error::logic_error;
};

/// The scenario itself failed while running (fall, stall): exit code 4.
class ScenarioFailure : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace plumbline
