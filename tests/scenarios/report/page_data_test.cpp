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

TEST(PageData, HasTheGapOverWhichCurvesAreDrawn) {
  ReportInput input = localized();
  input.methods.front().breaks.gap_s = 7.5;
  input.methods.front().histories = {{0, false, "", {{0.0, 0.5}, {5.0, 0.9}, {20.0, 0.9}}}};
  const Tree data = read_json(script_data(input, 30.0), "data");
  EXPECT_EQ(data.find("tracks")->find("m")->find("gap")->as_double(), 7.5);
  const Tree* steps = data.find("plots")->find("belief-m")->find("series")->as_list().at(0).find("steps");
  EXPECT_EQ(write_json(*steps, 0), "[[0,50],[5,90],[12.5,null],[20,90],[27.5,null]]");
}

}  // namespace
}  // namespace plumbline::scenarios
