// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "tests/system/program.h"

namespace plumbline::system_tests {

/// One run of the program for all tests of a suite, made on first use. Suite::begin() makes it in `folder_`; each test
/// begins with the check that it ended with `ends_with`.
template <class Suite, int ends_with = 0>
class RunOnce : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!available()) return;
    folder_.emplace();
    outcome_ = Suite::begin();
  }
  static void TearDownTestSuite() {
    folder_.reset();
    outcome_.reset();
  }
  void SetUp() override {
    if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
    ASSERT_EQ(outcome_->code, ends_with) << outcome_->out << outcome_->err;
  }

  static inline std::optional<Folder> folder_;
  static inline std::optional<Outcome> outcome_;
};

}  // namespace plumbline::system_tests
