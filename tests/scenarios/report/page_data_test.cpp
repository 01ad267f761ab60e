// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/page_data.h"

#include <gtest/gtest.h>

#include "tests/scenarios/report/report_sample.h"

namespace plumbline::scenarios {
namespace {

TEST(PageData, CannotChangeHowItsElementIsRead) {
  ReportInput input = localized();
  input.methods.front().histories[1].room = "<!--<script";
  const std::string json = script_data(input, 10.0);
  EXPECT_EQ(json.find('<'), std::string::npos);
  const Tree data = read_json(json, "data");
  const Tree* series = data.find("plots")->find("belief-m")->find("series");
  EXPECT_EQ(series->as_list().at(1).find("name")->as_string(), "other: <!--<script");
}

}  // namespace
}  // namespace plumbline::scenarios
