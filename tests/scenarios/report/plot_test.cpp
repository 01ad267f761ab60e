// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/plot.h"

#include <gtest/gtest.h>

#include "scenarios/report/svg.h"
#include "tests/occurrences.h"

namespace plumbline::scenarios {
namespace {

TEST(Svg, NumbersAreShort) {
  EXPECT_EQ(svg::number(1.5), "1.5");
  EXPECT_EQ(svg::number(-0.0001), "0");
  EXPECT_EQ(svg::number(100.0), "100");
}

TEST(Plot, MarksHaveRowsOfTheirOwn) {
  const std::string plot =
      draw_plot("p", {{"c", "#111", {{0, 1}, {0.5, 1}}}}, 10.0, {{{2, "one"}, {2.1, "two"}}, {}, 0});
  const auto row_of = [&](const std::string& text) {
    const std::size_t at = plot.rfind("top:", plot.find(">" + text + "<"));
    return plot.substr(at, plot.find(';', at) - at);
  };
  EXPECT_NE(row_of("one"), row_of("two"));
}

TEST(Plot, MarksWhereACurveLeavesTheScale) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 2000; ++i) points.emplace_back(0.01 * i, i >= 1000 && i < 1004 ? 50.0 : 1.0);
  PlotExtras extras;
  const std::string plot = draw_plot("p", {{"c", "#111", points}}, 20.0, extras);
  EXPECT_EQ(occurrences(plot, "class=\"over layer-c\" style=\"left:50%"), 1U);
  EXPECT_EQ(occurrences(plot, "▲"), 1U);
  extras.both_ways = true;
  extras.max = 1.0;
  const std::string both = draw_plot("p", {{"c", "#111", {{1.0, -3.0}, {1.1, 0.5}}}}, 20.0, extras);
  EXPECT_EQ(occurrences(both, "▼") + 10 * occurrences(both, "▲"), 1U);
  EXPECT_NE(both.find(">-0.5<"), std::string::npos) << both;
}

TEST(Plot, HasAScaleInWhichTheGoodCurvesCanBeCompared) {
  const auto curve = [](const char* name, double value) {
    return PlotCurve{name, "#111", {{1.0, value}, {1.1, value}}};
  };
  const std::vector<PlotCurve> curves = {curve("a", 1.0), curve("b", 1.5), curve("c", 300.0)};
  const std::string plot = draw_plot("p", curves, 20.0);
  EXPECT_NE(plot.find(">6<"), std::string::npos) << plot;  // four times the median, and a line at its round numbers
  EXPECT_EQ(plot.find(">100<"), std::string::npos) << plot;
  EXPECT_EQ(occurrences(plot, "class=\"over layer-c\""), 1U);
  EXPECT_EQ(occurrences(plot, "▲"), 1U);
  PlotExtras counts;
  counts.counts = true;
  EXPECT_EQ(occurrences(draw_plot("p", curves, 20.0, counts), "▲"), 0U);
}

TEST(Plot, StepsAreRound) {
  EXPECT_DOUBLE_EQ(round_step(10.0, 5), 2.0);
  EXPECT_DOUBLE_EQ(round_step(0.9, 5), 0.2);
  EXPECT_DOUBLE_EQ(round_step(120.0, 10), 20.0);
}

// Curves of equal shares are drawn beside each other; the script's legend has the values.
TEST(Plot, ALoweredCurveKeepsItsValues) {
  PlotCurve curve{"m", "red", {{0.0, 40.0}, {0.1, 0.5}}};
  const std::string plain = draw_plot("p", {curve}, 1.0, {.max = 100.0});
  curve.lowered = 2.0;
  EXPECT_NE(draw_plot("p", {curve}, 1.0, {.max = 100.0}), plain);
  curve.points = {{0.0, 38.0}, {0.1, 0.0}};
  curve.lowered = 0.0;
  const std::string below = draw_plot("p", {curve}, 1.0, {.max = 100.0});
  curve.points = {{0.0, 40.0}, {0.1, 0.5}};
  curve.lowered = 2.0;
  EXPECT_EQ(draw_plot("p", {curve}, 1.0, {.max = 100.0}), below);
}

TEST(Plot, BreaksTheHeadingWhereItTurnsOver) {
  PlotCurve curve{"m", "red", {{0.0, 179.0}, {0.1, 179.5}, {0.2, -179.5}, {0.3, -179.0}}};
  EXPECT_EQ(occurrences(draw_plot("p", {curve}, 1.0), "M"), 1U);
  curve.jump = 180.0;
  EXPECT_EQ(occurrences(draw_plot("p", {curve}, 1.0), "M"), 2U);
}

}  // namespace
}  // namespace plumbline::scenarios
