// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/scan_plot.h"

#include <gtest/gtest.h>

#include "tests/occurrences.h"

namespace plumbline::scenarios {
namespace {

/// Ten scans a second; after those of `pause_at` none for 3 s.
EstimatePage page_of_scans(int scans, int pause_at = -1) {
  EstimatePage page;
  page.input.methods.emplace_back().name = "m";
  double t_s = 0.0;
  for (int i = 0; i < scans; ++i) {
    page.scans_s.push_back(t_s);
    t_s += i == pause_at ? 3.0 : 0.1;
  }
  if (pause_at >= 0) page.pauses = {{0.1 * pause_at, 0.1 * pause_at + 3.0}};
  return page;
}

TEST(ScanPlot, NeedsTwoScans) {
  EXPECT_EQ(draw_scans(page_of_scans(0)), "");
  EXPECT_EQ(draw_scans(page_of_scans(1)), "");
}

TEST(ScanPlot, OfEvenScansIsASentence) {
  const std::string drawn = draw_scans(page_of_scans(50));
  EXPECT_EQ(drawn.find("<svg"), std::string::npos);
  EXPECT_NE(drawn.find("50 scans in 4.9 s, usually one every 0.1 s, at most 0.1 s apart. No pause."), std::string::npos)
      << drawn;
}

TEST(ScanPlot, ShowsAPauseHoweverManyScansThereAre) {
  for (const int scans : {50, 30'000}) {
    const std::string drawn = draw_scans(page_of_scans(scans, 30));
    EXPECT_NE(drawn.find("id=\"scans\""), std::string::npos);
    EXPECT_NE(drawn.find("1 pause, the longest after 3 s: no scan for 3 s."), std::string::npos) << drawn;
    EXPECT_LT(drawn.size(), 100'000U);
    const std::size_t line = drawn.find(" d=\"");
    EXPECT_EQ(occurrences(drawn.substr(line, drawn.find('"', line + 4) - line), "M"), 1U) << "a pause is a peak";
  }
}

TEST(ScanPlot, ShowsWhenSlamWasLost) {
  EstimatePage page = page_of_scans(50);
  page.spans = {{0.0, 4.0, "followed"}, {4.0, 4.9, "LOST"}};
  EXPECT_NE(draw_scans(page).find("LOST: it says that its pose is no answer"), std::string::npos);
  page.input.methods.front().localization = true;  // its states stand beside its hypotheses
  EXPECT_EQ(draw_scans(page).find("id=\"scans\""), std::string::npos);
}

}  // namespace
}  // namespace plumbline::scenarios
