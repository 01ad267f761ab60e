// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "bim/formats/plan_yaml/plan_yaml.h"
#include "tests/input_error.h"

namespace plumbline::bim {

/// What reading a plan of this text complains of.
[[nodiscard]] inline std::string error_of(const std::string& text) {
  return input_error([&] { (void)read_plan_text(text, "p.yaml"); });
}

/// The complaint names this line, or line and column, and says this.
inline void expect_plan_error(const std::string& text, const std::string& place, const std::string& part) {
  const std::string message = error_of(text);
  EXPECT_EQ(message.rfind("p.yaml:" + place + ":", 0), 0U) << message;
  EXPECT_NE(message.find(part), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

}  // namespace plumbline::bim
