// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/report.h"

#include <gtest/gtest.h>

#include "scenarios/report/plot.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {
namespace {

ReportInput sample() {
  ReportInput input;
  Tree gate = Tree::map();
  gate.set("metric", "ate_aligned_rmse_m").set("method", "m").set("op", "<=").set("limit", 0.05).set("value", 0.08);
  gate.set("passed", false);
  Tree method = Tree::map();
  method.set("verdict", "complete").set("ate_aligned_rmse_m", 0.08);
  input.results = Tree::map();
  input.results.set("scenario", "a <b> & \"c\"").set("seed", "1").set("duration_s", 10.0);
  input.results.set("gates", Tree(Tree::List{gate})).set("methods", Tree(Tree::Map{{"m", method}}));
  bim::PlanFace face;
  face.storey = 0;
  face.p1 = {4.0, 0.0};
  face.holes = {{1.0, 2.0, 0.0, 2.1}};
  input.plan.faces = {face};
  input.plan.storeys = {{"ground", 0.0, 3.0}, {"upper", 3.0, 3.0}};
  input.storeys = {{0, "ground", {}}};
  for (int i = 0; i <= 100; ++i) input.truth.push_back({0.1 * i, 0.04 * i, 1.0, 0.0, 0.0, 0});
  ReportMethod m;
  m.name = "m";
  for (const auto& s : input.truth) m.samples.push_back({s.t_s, s.x, s.y + 0.08, 0.0, 0.08, 0});
  m.beliefs.push_back({"start", 0.0, {{1.0, 1.0, 0.0, 1.0}}, {0.0, 1.0}, 0});
  input.methods.push_back(m);
  return input;
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++n;
  return n;
}

TEST(Report, IsSelfContainedAndSaysWhatFailed) {
  const std::string page = render_report(sample());
  EXPECT_EQ(count(page, "http://") + count(page, "https://") + count(page, "src=") + count(page, "<link"), 0U);
  EXPECT_NE(page.find("FAIL"), std::string::npos);
  EXPECT_NE(page.find("8 cm rms after alignment"), std::string::npos);
  EXPECT_NE(page.find("a &lt;b&gt; &amp; &quot;c&quot;"), std::string::npos);
}

TEST(Report, GivesBothAnswersAndWhatMethodsWereTold) {
  ReportInput input = sample();
  const auto place = Tree::map().set("t_s", 0.0).set("distance_m", 0.0).set("twins", 1).set("weak", 0);
  Tree alone = Tree::map(), furnished = Tree::map();
  alone.set("identifiable", false).set("places", Tree(Tree::List{place}));
  furnished.set("identifiable", true).set("at_s", 0.0).set("at_m", 0.0).set("places", Tree(Tree::List{place}));
  input.results.set("identifiability", alone.set("with_furniture", furnished));
  input.results.set("told", Tree::map().set("plan_furniture", "none").set("world_furniture", "as_planned"));
  input.methods.front().states.push_back({0.0, 1, slam::State::searching});
  const std::string page = render_report(input);
  EXPECT_NE(page.find("By the building alone: the scans never distinguished"), std::string::npos);
  EXPECT_NE(page.find("With the furniture as planned: identifiable from the first scan"), std::string::npos);
  EXPECT_NE(page.find("Only furniture tells these apart"), std::string::npos);
  EXPECT_NE(page.find("the methods' plan has no furniture; furniture as built: as planned"), std::string::npos);
  EXPECT_EQ(render_report(sample()).find("furniture as built"), std::string::npos);
}

TEST(Report, ShowsAGatesLimitHoweverSmall) {
  ReportInput input = sample();
  Tree gate = Tree::map();
  gate.set("metric", "ate_aligned_rmse_m").set("method", "truth").set("op", "<=").set("limit", 1e-9).set("value", 0.0);
  gate.set("passed", true);
  input.results.set("gates", Tree(Tree::List{gate}));
  EXPECT_NE(render_report(input).find("&lt;= 1e-09"), std::string::npos);
}

TEST(Report, LeavesDoorsOpenInWalls) {
  // One door splits the face into two strokes.
  const std::string page = render_report(sample());
  const std::string map =
      page.substr(page.find("<svg class=\"map\""), page.find("</svg>") - page.find("<svg class=\"map\""));
  EXPECT_EQ(count(map, "class=\"wall\""), 2U);
  EXPECT_EQ(count(map, "class=\"wall high\""), 0U);
}

TEST(Report, ShowsWhatHangsAboveTheRobotFaintly) {
  ReportInput input = sample();
  input.plan.faces.front().z0 = 2.5;
  input.plan.faces.front().holes.clear();
  const std::string page = render_report(input);
  EXPECT_EQ(count(page, "class=\"wall\""), 0U);
  EXPECT_EQ(count(page, "class=\"wall high\""), count(page, "<svg class=\"map\""));
}

TEST(Report, DrawsWhatStandsOnTheFloor) {
  ReportInput input = sample();
  const Polygon2 square = {{1.0, 1.0}, {2.0, 1.0}, {2.0, 2.0}, {1.0, 2.0}};
  input.obstacles = {{"desk <1>", 0, square, true}, {"table", 0, square, false}, {"upstairs", 1, square, true}};
  const std::string page = render_report(input);
  const std::string outline = "<polygon points=\"1,-1 2,-1 2,-2 1,-2\" class=\"";
  const std::size_t maps = count(page, "<svg class=\"map\"");
  EXPECT_EQ(count(page, outline + "thing\"><title>desk &lt;1&gt;</title>"), maps);
  EXPECT_EQ(count(page, outline + "thing hull\"><title>table</title>"), maps);
  EXPECT_EQ(count(page, outline), 2 * maps);
}

TEST(Report, DrawsTheMapOfEveryStoreyWithThePathOnIt) {
  ReportInput input = sample();
  input.storeys.push_back({1, "upper <floor>", {}});
  input.plan.faces.push_back(input.plan.faces.front());
  input.plan.faces.back().storey = 1;
  for (std::size_t i = 60; i < input.truth.size(); ++i) input.truth[i].storey = 1;
  const std::string page = render_report(input);
  EXPECT_EQ(count(page, "data-robot=\"truth\""), 2U);
  EXPECT_EQ(count(page, "class=\"truth\""), 2U);
  EXPECT_EQ(count(page, "<p class=\"storey\">"), 2U);
  EXPECT_NE(page.find("upper &lt;floor&gt;"), std::string::npos);
  EXPECT_EQ(count(render_report(sample()), "<p class=\"storey\">"), 0U);
}

/// A localization that had two hypotheses, converged at 6 s and matched two walls, one of them wrongly.
ReportInput localized() {
  ReportInput input = sample();
  ReportMethod& m = input.methods.front();
  m.localization = true;
  for (const ReportSample& s : input.truth)
    m.states.push_back({s.t_s, s.t_s < 6.0 ? 2 : 1, s.t_s < 6.0 ? slam::State::ambiguous : slam::State::converged});
  m.histories = {{0, true, "hall", {{0.0, 0.5}, {0.9, 0.9}}}, {1, false, "a<b", {{0.0, 0.5}, {0.9, 0.1}}}};
  const ReportWall wall{{0, 0}, {4, 0}, 0};
  m.recognised = {
      {"at convergence", 6.0, 0, {1.0, 1.0}, {{{1.0, 1.0}, 0.5, 1.0, {{{wall}, wall, true}, {{wall}, wall, false}}}}}};
  Tree results = Tree::map();
  results.set("verdict", "success");
  results.set("localization", Tree::map().set("converged_at_s", 6.0).set("ape_rmse_m", 0.08));
  input.results.set("methods", Tree(Tree::Map{{"m", results}}));
  return input;
}

TEST(Report, SaysFromWhenToWhenAnAnswerWasWrongAndOnWhichStorey) {
  ReportInput input = localized();
  EXPECT_EQ(render_report(input).find("More than 0.5 m off"), std::string::npos);
  std::vector<ReportSample>& samples = input.methods.front().samples;
  ASSERT_GT(samples.size(), 60U);
  for (std::size_t i = 30; i < 50; ++i) samples[i].error_m = i == 40 ? 2.5 : 0.8;
  for (std::size_t i = 50; i < 60; ++i) {
    samples[i].error_m = 9.0;
    samples[i].lost = true;
  }
  const auto at = [&](std::size_t i) { return "t = " + svg::number(samples[i].t_s, 1) + " s"; };
  EXPECT_NE(render_report(input).find("More than 0.5 m off from " + at(30) + " to " + at(49) + ", at most 2.5 m."),
            std::string::npos);
  input.plan.storeys = {{"ground", 0.0, 3.0}, {"upper", 3.0, 3.0}};
  for (std::size_t i = 35; i < 45; ++i) samples[i].storey = 1;
  samples.back().error_m = 0.9;
  std::string page = render_report(input);
  EXPECT_NE(page.find("More than 0.5 m off from " + at(30) + " to " + at(49) + " and once more, at most 2.5 m."),
            std::string::npos);
  EXPECT_NE(page.find("At " + at(35) + " it was on storey upper, the robot on ground."), std::string::npos);
  for (std::size_t i = 50; i < samples.size(); ++i) samples[i] = samples[49];
  samples.back().t_s = input.truth.back().t_s;
  page = render_report(input);
  EXPECT_NE(page.find("More than 0.5 m off from " + at(30) + " to the end, at most 2.5 m."), std::string::npos);
}

// An answer may be right in its place and wrong in its heading.
TEST(Report, SaysWhenAnAnswersHeadingWasWrong) {
  ReportInput input = localized();
  std::vector<ReportSample>& samples = input.methods.front().samples;
  for (std::size_t i = 30; i < 50; ++i) samples[i].yaw_error = i == 40 ? -0.3 : 0.2;
  const auto at = [&](std::size_t i) { return "t = " + svg::number(samples[i].t_s, 1) + " s"; };
  EXPECT_NE(render_report(input).find("More than 10° off from " + at(30) + " to " + at(49) + ", at most 17°."),
            std::string::npos);
  samples[35].error_m = 0.8;
  EXPECT_NE(render_report(input).find("More than 0.5 m or 10° off from " + at(30) + " to " + at(49) +
                                      ", at most 80 cm and 17°."),
            std::string::npos);
  Tree results = Tree::map();
  results.set("verdict", "false_convergence");
  results.set("localization",
              Tree::map().set("converged_at_s", 6.0).set("failure", "tracking_lost").set("failure_at_s", 9.5));
  input.results.set("methods", Tree(Tree::Map{{"m", results}}));
  EXPECT_NE(render_report(input).find("Converged on the right pose after 6 s, and lost it again at 9.5 s without "
                                      "saying so."),
            std::string::npos);
}

TEST(Report, ShowsWhatALocalizationBelievedOverTime) {
  const std::string page = render_report(localized());
  const std::size_t chart = page.find("id=\"belief-m\"");
  ASSERT_NE(chart, std::string::npos);
  const std::string plot = page.substr(chart, page.find("</figure>", chart) - chart);
  EXPECT_EQ(count(plot, "background:var(--ambiguous)") + count(plot, "background:var(--converged)"), 2U);
  EXPECT_NE(plot.find("AMBIGUOUS, 0 to 6 s"), std::string::npos);
  EXPECT_NE(plot.find("CONVERGED, 6 to 10 s"), std::string::npos);
  EXPECT_NE(plot.find(">converged<"), std::string::npos);
  EXPECT_NE(plot.find("</i>true pose "), std::string::npos);
  EXPECT_NE(plot.find("</i>other: a&lt;b "), std::string::npos);
  EXPECT_EQ(count(plot, "class=\"curve"), 2U);
  EXPECT_EQ(count(render_report(sample()), "belief-m"), 0U);
}

TEST(Report, NamesTheTruePoseOnceHoweverOftenItIsLost) {
  ReportInput input = localized();
  input.methods.front().histories = {{0, true, "hall", {{0.0, 1.0}, {0.5, 1.0}}},
                                     {0, false, "hall", {{0.5, 1.0}, {0.9, 1.0}}},
                                     {0, true, "hall", {{0.9, 1.0}, {1.4, 1.0}}}};
  const std::string page = render_report(input);
  EXPECT_EQ(count(page, "</i>true pose "), 1U);
  EXPECT_EQ(count(page, "</i>other: hall "), 1U);
  // The legend's values: the later stretch of the true pose is its own, not that of the other one.
  const std::size_t true_pose = page.find("\"true pose\""), again = page.find("[0.9,100", true_pose),
                    other = page.find("\"other: hall\"");
  ASSERT_NE(other, std::string::npos);
  EXPECT_LT(true_pose, again);
  EXPECT_LT(again, other);
}

TEST(Report, CountsFromTheFirstScanAndMarksOnTheRunsClock) {
  ReportInput input = localized();
  for (ReportSample& s : input.truth) s.t_s += 0.5;
  input.results.set("identifiability", Tree::map().set("at_s", 3.0).set("at_m", 1.0).set("places", Tree::list()));
  const std::string page = render_report(input);
  EXPECT_NE(page.find("title=\"converged, 6.5 s\""), std::string::npos);
  EXPECT_NE(page.find("title=\"identifiable from here on, 3.5 s\""), std::string::npos);
  EXPECT_NE(page.find("Converged on the right pose after 6 s"), std::string::npos);
}

TEST(Report, SaysHowManyHypothesesHaveNoLineOfTheirOwn) {
  ReportInput input = localized();
  EXPECT_EQ(render_report(input).find("all others together"), std::string::npos);
  input.methods.front().other_hypotheses = {{0.0, 0.1}, {0.5, 0.2}};
  input.methods.front().hypotheses_left_out = 17;
  const std::string page = render_report(input);
  EXPECT_NE(page.find("</i>all others together <b"), std::string::npos);
  EXPECT_NE(page.find("the other 17 are one grey line together"), std::string::npos);
}

TEST(Report, SaysWhenARightPoseWasLost) {
  ReportInput input = localized();
  Tree where = Tree::map();
  where.set("converged_at_s", 6.0).set("failure", "tracking_lost").set("failure_at_s", 8.5);
  input.results.set("methods", Tree(Tree::Map{{"m", Tree::map().set("verdict", "lost").set("localization", where)}}));
  EXPECT_NE(render_report(input).find("Converged on the right pose after 6 s, and lost it again at 8.5 s."),
            std::string::npos);
}

TEST(Report, SaysFirstWhichGatesFailedAndByHowMuch) {
  ReportInput input = sample();
  Tree gate = input.results.find("gates")->as_list().front();
  gate.set("see", "replay.html#t=1&m=m").set("reason", "the run ended early");
  input.results.set("gates", Tree(Tree::List{gate}));
  const std::string page = render_report(input);
  EXPECT_NE(page.find("<li><a href=\"replay.html#t=1&amp;m=m\">ate_aligned_rmse_m of m</a>: 0.08, must be &lt;= 0.05; "
                      "the run ended early</li>"),
            std::string::npos);
  EXPECT_LT(page.find("class=\"failed\""), page.find("<svg class=\"map\""));
  EXPECT_EQ(page.find(">look</a>"), std::string::npos);
}

TEST(Report, NamesABadMethodThatNoGateJudges) {
  ReportInput input = localized();
  Tree gate = input.results.find("gates")->as_list().front();
  gate.set("method", "other").set("passed", true);
  input.results.set("gates", Tree(Tree::List{gate}));
  EXPECT_EQ(render_report(input).find("not judged"), std::string::npos);
  Tree where = Tree::map();
  where.set("converged_at_s", 6.0).set("failure", "depleted").set("failure_at_s", 4.0).set("evidence", "weak");
  input.results.set("methods",
                    Tree(Tree::Map{{"m", Tree::map().set("verdict", "overconfident").set("localization", where)}}));
  const std::string page = render_report(input);
  EXPECT_NE(page.find("<span class=\"badge bad\">m: overconfident, not judged</span>"), std::string::npos);
  EXPECT_NE(
      page.find("the scans favour it only marginally, since the true pose dropped out of the hypotheses (at 4 s)"),
      std::string::npos);
  where.set("hypotheses", 2);
  input.results.set("methods",
                    Tree(Tree::Map{{"m", Tree::map().set("verdict", "honest_ambiguity").set("localization", where)}}));
  EXPECT_NE(render_report(input).find("rightly: the scans favour one only marginally"), std::string::npos);
}

TEST(Report, GlossaryHoldsNoMarkdownAndNamesWhatPagesSay) {
  const std::string page = render_report(sample());
  const std::string glossary =
      page.substr(page.find("Glossary:"), page.find("</details>", page.find("Glossary:")) - page.find("Glossary:"));
  EXPECT_EQ(glossary.find('`'), std::string::npos);
  EXPECT_NE(glossary.find("<code>localization.<wbr>state</code>"), std::string::npos);
  for (const char* word :
       {"consistent poses", "marginally identifiable", "with_<wbr>furniture.<wbr>*", "A. Hoover et al."})
    EXPECT_NE(glossary.find(word), std::string::npos) << word;
}

TEST(Report, ItsKeyNamesOnlyWhatSomeMethodFound) {
  ReportInput input = sample();
  EXPECT_EQ(render_report(input).find(" found</span>"), std::string::npos);
  input.methods.front().ink = 2;
  input.methods.front().walls.push_back({{0.0, 0.0}, {1.0, 0.0}, 0});
  std::string page = render_report(input);
  EXPECT_NE(page.find("stroke=\"var(--m2)\" stroke-width=\"4\" stroke-opacity=\".8\"/></svg>wall that m found"),
            std::string::npos);
  EXPECT_EQ(page.find("room that m found"), std::string::npos);
  input.methods.front().rooms.push_back({{{0, 0}, {1, 0}, {1, 1}}, true, 0});
  page = render_report(input);
  EXPECT_NE(page.find("height=\"8\"/></svg>room that m found"), std::string::npos);
}

TEST(Report, BreaksTheHeadingWhereItTurnsOver) {
  PlotCurve curve{"m", "red", {{0.0, 179.0}, {0.1, 179.5}, {0.2, -179.5}, {0.3, -179.0}}};
  EXPECT_EQ(count(draw_plot("p", {curve}, 1.0), "M"), 1U);
  curve.jump = 180.0;
  EXPECT_EQ(count(draw_plot("p", {curve}, 1.0), "M"), 2U);
}

TEST(Report, ColoursAVerdictByTheGates) {
  ReportInput input = sample();  // its gate failed
  EXPECT_NE(render_report(input).find("<span class=\"verdict bad\">complete</span>"), std::string::npos);
  EXPECT_NE(render_report(input).find("0 of 1 gate passed."), std::string::npos);
  input.results.set("gates", Tree::list());
  EXPECT_NE(render_report(input).find("<span class=\"verdict open\">complete</span>"), std::string::npos);
  EXPECT_NE(render_report(input).find("No gate judges it."), std::string::npos);
}

TEST(Report, DrawsNoErrorWhereAMethodSaysThatItIsLost) {
  ReportInput input = sample();
  for (std::size_t i = 50; i < 101; ++i) {
    input.methods.front().samples[i].lost = true;
    input.methods.front().samples[i].error_m = 500.0;
  }
  const std::string page = render_report(input);
  EXPECT_NE(page.find("curve disclaimed layer-m"), std::string::npos);
  EXPECT_EQ(page.find(">5000<"), std::string::npos);  // the scale is that of answers
  EXPECT_EQ(count(page, "<polyline"), count(render_report(sample()), "<polyline"));
}

TEST(Report, ShowsTheWallsItRecognised) {
  const std::string page = render_report(localized());
  EXPECT_EQ(count(page, "class=\"plannedwall\""), 2U);
  EXPECT_EQ(count(page, "class=\"seenwall\""), 2U);
  EXPECT_NE(page.find("at convergence, 6 s: 1 of 2 walls right"), std::string::npos);
  ReportInput ambiguous = localized();
  ReportWalls& walls = ambiguous.methods.front().recognised.front();
  walls.hypotheses.resize(5, walls.hypotheses.front());  // a map each, of three at most
  EXPECT_EQ(count(render_report(ambiguous), "class=\"heldplace\""), 3U);
  EXPECT_NE(render_report(ambiguous).find("6 s: hypothesis 2 of 5, 100 %: 1 of 2 walls right"), std::string::npos);
}

TEST(Report, DoesNotJoinPathsWhereTheRobotWasCarried) {
  ReportInput input = sample();
  const std::size_t lines = count(render_report(input), "<polyline");
  const auto carry = [](std::vector<ReportSample>& samples) {
    for (std::size_t i = 50; i < samples.size(); ++i) {
      samples[i].t_s += 3.0;
      samples[i].y += 5.0;
    }
  };
  carry(input.truth);
  carry(input.methods.front().samples);
  input.kidnap = ReportKidnap{4.9, 8.0};
  const std::string page = render_report(input);
  EXPECT_EQ(count(page, "<polyline"), lines + 3);  // the truth's, the method's, and that by its error
  EXPECT_EQ(count(page, ">kidnapped<"), 2U);       // on the map and over the errors
  // A method that changes its mind within a scan does not walk there either.
  for (std::size_t i = 70; i < input.methods.front().samples.size(); ++i) input.methods.front().samples[i].x += 2.0;
  EXPECT_EQ(count(render_report(input), "<polyline"), lines + 5);
}

TEST(Report, LeadsToTheReplayWhereThereIsOne) {
  ReportInput input = sample();
  EXPECT_EQ(render_report(input).find("<a href=\"replay.html\">"), std::string::npos);
  input.has_replay = true;
  EXPECT_NE(render_report(input).find("<a href=\"replay.html\">"), std::string::npos);
}

TEST(Report, SameInputSameBytes) { EXPECT_EQ(render_report(sample()), render_report(sample())); }

TEST(Report, WorksWithoutAnyMethod) {
  ReportInput input = sample();
  input.methods.clear();
  input.truth.clear();
  EXPECT_NE(render_report(input).find("</html>"), std::string::npos);
}

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
  EXPECT_EQ(count(plot, "class=\"over layer-c\" style=\"left:50%"), 1U);
  EXPECT_EQ(count(plot, "▲"), 1U);
  extras.both_ways = true;
  extras.max = 1.0;
  const std::string both = draw_plot("p", {{"c", "#111", {{1.0, -3.0}, {1.1, 0.5}}}}, 20.0, extras);
  EXPECT_EQ(count(both, "▼") + 10 * count(both, "▲"), 1U);
  EXPECT_NE(both.find(">-0.5<"), std::string::npos) << both;
}

TEST(Report, HasTheErrorOfEachAxisTheHeadingAndTheLastMetre) {
  ReportInput input = sample();
  for (ReportSample& s : input.methods.front().samples) {
    s.error_W = {0.03, -0.04, 0.0625};
    s.yaw_error = -0.1;
    if (s.t_s > 5.0) s.relative_m = 0.02;
  }
  const std::string page = render_report(input);
  for (const char* id : {"errors", "errors-x", "errors-y", "errors-z", "errors-heading", "errors-relative"})
    EXPECT_EQ(count(page, "<figure class=\"plot" + std::string(std::string(id) == "errors" ? "" : " small") +
                              "\" id=\"" + id + "\""),
              1U)
        << id;
  const std::string data = page.substr(page.find("id=\"data\""));
  EXPECT_NE(data.find("\"ex\":[0.03,"), std::string::npos);
  EXPECT_NE(data.find("\"ey\":[-0.04,"), std::string::npos);
  EXPECT_NE(data.find("\"ez\":[0.0625,"), std::string::npos);
  EXPECT_NE(data.find("\"eh\":[-0.1,"), std::string::npos);
  EXPECT_NE(data.find("\"er\":[null,"), std::string::npos);
}

TEST(Report, DrawsThePathByTheSizeOfItsError) {
  ReportInput input = sample();  // 8 cm off
  for (std::size_t i = 50; i < 101; ++i) input.methods.front().samples[i].error_m = 0.7;
  const std::string page = render_report(input);
  EXPECT_EQ(count(page, "class=\"errorpath\" stroke=\"var(--e2)\""), 1U);
  EXPECT_EQ(count(page, "class=\"errorpath\" stroke=\"var(--e4)\""), 1U);
}

TEST(Plot, StepsAreRound) {
  EXPECT_DOUBLE_EQ(round_step(10.0, 5), 2.0);
  EXPECT_DOUBLE_EQ(round_step(0.9, 5), 0.2);
  EXPECT_DOUBLE_EQ(round_step(120.0, 10), 20.0);
}

}  // namespace
}  // namespace plumbline::scenarios
