// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/report.h"

#include <gtest/gtest.h>

#include "scenarios/report/svg.h"
#include "tests/occurrences.h"
#include "tests/scenarios/report/report_sample.h"

namespace plumbline::scenarios {
namespace {

TEST(Report, IsSelfContainedAndSaysWhatFailed) {
  const std::string page = render_report(sample());
  EXPECT_EQ(occurrences(page, "http://") + occurrences(page, "https://") + occurrences(page, "src=") +
                occurrences(page, "<link"),
            0U);
  EXPECT_NE(page.find("FAIL"), std::string::npos);
  EXPECT_NE(page.find("8 cm rms after alignment"), std::string::npos);
  EXPECT_NE(page.find("a &lt;b&gt; &amp; &quot;c&quot;"), std::string::npos);
}

TEST(Report, GivesBothAnswersAndWhatMethodsWereTold) {
  ReportInput input = sample();
  const auto place = Tree::map().set("t_s", 0.0).set("distance_m", 0.0).set("aliases", 1).set("weak", 0);
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
  EXPECT_NE(page.find("the methods' plan has no furniture; in the building: as planned"), std::string::npos);
  EXPECT_EQ(render_report(sample()).find("in the building:"), std::string::npos);
}

TEST(Report, LeavesDoorsOpenInWalls) {
  // One door splits the face into two strokes.
  const std::string page = render_report(sample());
  const std::string map =
      page.substr(page.find("<svg class=\"map\""), page.find("</svg>") - page.find("<svg class=\"map\""));
  EXPECT_EQ(occurrences(map, "class=\"wall\""), 2U);
  EXPECT_EQ(occurrences(map, "class=\"wall high\""), 0U);
}

TEST(Report, ShowsWhatHangsAboveTheRobotFaintly) {
  ReportInput input = sample();
  input.plan.faces.front().z0 = 2.5;
  input.plan.faces.front().holes.clear();
  const std::string page = render_report(input);
  EXPECT_EQ(occurrences(page, "class=\"wall\""), 0U);
  EXPECT_EQ(occurrences(page, "class=\"wall high\""), occurrences(page, "<svg class=\"map\""));
}

TEST(Report, DrawsWhatStandsOnTheFloor) {
  ReportInput input = sample();
  const Polygon2 square = {{1.0, 1.0}, {2.0, 1.0}, {2.0, 2.0}, {1.0, 2.0}};
  input.obstacles = {{"desk <1>", 0, square, true}, {"table", 0, square, false}, {"upstairs", 1, square, true}};
  const std::string page = render_report(input);
  const std::string outline = "<polygon points=\"1,-1 2,-1 2,-2 1,-2\" class=\"";
  const std::size_t maps = occurrences(page, "<svg class=\"map\"");
  EXPECT_EQ(occurrences(page, outline + "thing\"><title>desk &lt;1&gt;</title>"), maps);
  EXPECT_EQ(occurrences(page, outline + "thing hull\"><title>table</title>"), maps);
  EXPECT_EQ(occurrences(page, outline), 2 * maps);
}

TEST(Report, DrawsTheMapOfEveryStoreyWithThePathOnIt) {
  ReportInput input = sample();
  input.storeys.push_back({1, "upper <floor>", {}});
  input.plan.faces.push_back(input.plan.faces.front());
  input.plan.faces.back().storey = 1;
  for (std::size_t i = 60; i < input.truth.size(); ++i) input.truth[i].storey = 1;
  const std::string page = render_report(input);
  EXPECT_EQ(occurrences(page, "data-robot=\"truth\""), 2U);
  EXPECT_EQ(occurrences(page, "class=\"truth\""), 2U);
  EXPECT_EQ(occurrences(page, "<p class=\"storey\">"), 2U);
  EXPECT_NE(page.find("upper &lt;floor&gt;"), std::string::npos);
  EXPECT_EQ(occurrences(render_report(sample()), "<p class=\"storey\">"), 0U);
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
  EXPECT_NE(page.find("More than 0.5 m off from " + at(30) + " to " + at(49) +
                      " and once more, 1.9 s in all, at most 2.5 m."),
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
  EXPECT_NE(render_report(input).find("Converged on the right pose at t = 6 s, and lost it again at t = 9.5 s without "
                                      "saying so."),
            std::string::npos);
}

TEST(Report, ShowsWhatALocalizationBelievedOverTime) {
  const std::string page = render_report(localized());
  const std::size_t chart = page.find("id=\"belief-m\"");
  ASSERT_NE(chart, std::string::npos);
  const std::string plot = page.substr(chart, page.find("</figure>", chart) - chart);
  EXPECT_EQ(occurrences(plot, "background:var(--ambiguous)") + occurrences(plot, "background:var(--converged)"), 2U);
  EXPECT_NE(plot.find("AMBIGUOUS, 0 to 6 s"), std::string::npos);
  EXPECT_NE(plot.find("CONVERGED, 6 to 10 s"), std::string::npos);
  EXPECT_NE(plot.find(">converged<"), std::string::npos);
  EXPECT_NE(plot.find("</i>true pose "), std::string::npos);
  EXPECT_NE(plot.find("</i>other: a&lt;b "), std::string::npos);
  EXPECT_EQ(occurrences(plot, "class=\"curve"), 2U);
  EXPECT_EQ(occurrences(render_report(sample()), "belief-m"), 0U);
}

TEST(Report, NamesTheTruePoseOnceHoweverOftenItIsLost) {
  ReportInput input = localized();
  input.methods.front().histories = {{0, true, "hall", {{0.0, 1.0}, {0.5, 1.0}}},
                                     {0, false, "hall", {{0.5, 1.0}, {0.9, 1.0}}},
                                     {0, true, "hall", {{0.9, 1.0}, {1.4, 1.0}}}};
  const std::string page = render_report(input);
  EXPECT_EQ(occurrences(page, "</i>true pose "), 1U);
  EXPECT_EQ(occurrences(page, "</i>other: hall "), 1U);
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
  EXPECT_NE(page.find("Converged on the right pose at t = 6.5 s"), std::string::npos);
  EXPECT_NE(page.find("identifiable from t = 3.5 s on, after 1 m walked."), std::string::npos);
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
  EXPECT_NE(render_report(input).find("Converged on the right pose at t = 6 s, and lost it again at t = 8.5 s."),
            std::string::npos);
}

// The end that counts may be a kidnapping.
TEST(Report, SaysUntilWhenATruePoseWasOneOfSeveral) {
  ReportInput input = localized();
  const Tree where = Tree::map().set("failure", "undecided").set("failure_at_s", 8.5);
  input.results.set("methods", Tree(Tree::Map{{"m", Tree::map().set("verdict", "late").set("localization", where)}}));
  EXPECT_NE(render_report(input).find("since the true pose remained one of several (until t = 8.5 s)."),
            std::string::npos);
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
  EXPECT_EQ(render_report(input).find("built otherwise than planned</span>"), std::string::npos);
  input.storeys.front().deviations.emplace_back();
  EXPECT_NE(render_report(input).find("built otherwise than planned</span>"), std::string::npos);
  input = sample();
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

TEST(Report, DrawsNoErrorWhereAMethodSaysThatItIsLost) {
  ReportInput input = sample();
  for (std::size_t i = 50; i < 101; ++i) {
    input.methods.front().samples[i].lost = true;
    input.methods.front().samples[i].error_m = 500.0;
  }
  const std::string page = render_report(input);
  EXPECT_NE(page.find("curve disclaimed layer-m"), std::string::npos);
  EXPECT_EQ(page.find(">5000<"), std::string::npos);  // the scale is that of answers
  EXPECT_NE(page.find(" It reported LOST at 51 of 101 scans"), std::string::npos);
  EXPECT_EQ(occurrences(page, "<polyline"), occurrences(render_report(sample()), "<polyline"));
}

TEST(Report, SaysWhatTheScenarioInjectedAndWhenAMethodFailedByIt) {
  EXPECT_EQ(render_report(sample()).find("Injected faults"), std::string::npos);
  ReportInput input = sample();
  input.results.set("injected", Tree(Tree::List{Tree("the feet slip at 1 m/s"), Tree("dust & rain")}));
  ReportMethod& m = input.methods.front();
  for (std::size_t i = 42; i < 60; ++i) m.samples[i].lost = true;
  m.failed_s = 4.2;
  m.slip = SlipEpisode{4.0, 4.2};
  const std::string page = render_report(input);
  const std::size_t at = page.find("<b>Injected faults:</b> the feet slip at 1 m/s; dust &amp; rain</p>");
  ASSERT_NE(at, std::string::npos);
  EXPECT_LT(at, page.find("<svg class=\"map\""));  // in the head of the page
  EXPECT_NE(page.find("LOST at 18 of 101 scans, first at t = 4.2 s."), std::string::npos);
  EXPECT_NE(page.find("The feet slipped from t = 4 s to 4.2 s; it first failed at t = 4.2 s."), std::string::npos);
}

TEST(Report, ShowsTheWallsItRecognised) {
  const std::string page = render_report(localized());
  EXPECT_EQ(occurrences(page, "class=\"plannedwall\""), 2U);
  EXPECT_EQ(occurrences(page, "class=\"seenwall\""), 2U);
  EXPECT_NE(page.find("at convergence, 6 s: 1 of 2 walls right"), std::string::npos);
  ReportInput ambiguous = localized();
  ReportWalls& walls = ambiguous.methods.front().recognised.front();
  walls.hypotheses.resize(5, walls.hypotheses.front());  // a map each, of three at most
  EXPECT_EQ(occurrences(render_report(ambiguous), "class=\"heldplace\""), 3U);
  EXPECT_NE(render_report(ambiguous).find("6 s: hypothesis 2 of 5, 100 %: 1 of 2 walls right"), std::string::npos);
}

TEST(Report, DoesNotJoinPathsWhereTheRobotWasCarried) {
  ReportInput input = sample();
  const std::size_t lines = occurrences(render_report(input), "<polyline");
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
  EXPECT_EQ(occurrences(page, "<polyline"), lines + 3);  // the truth's, the method's, and that by its error
  EXPECT_EQ(occurrences(page, ">kidnapped<"), 2U);       // on the map and over the errors
  // A method that changes its mind within a scan does not walk there either.
  for (std::size_t i = 70; i < input.methods.front().samples.size(); ++i) input.methods.front().samples[i].x += 2.0;
  EXPECT_EQ(occurrences(render_report(input), "<polyline"), lines + 5);
}

TEST(Report, LeadsToTheReplayWhereThereIsOne) {
  ReportInput input = sample();
  EXPECT_EQ(render_report(input).find("<a href=\"replay.html\">"), std::string::npos);
  input.has_replay = true;
  EXPECT_NE(render_report(input).find("<a href=\"replay.html\">"), std::string::npos);
}

TEST(Report, SameInputSameBytes) { EXPECT_EQ(render_report(sample()), render_report(sample())); }

TEST(Report, WarnsOfTheWalkWithoutMarkdown) {
  ReportInput input = sample();
  Tree walk = Tree::map();
  walk.set("warnings", Tree(Tree::List{Tree("a longer `duration_s: 50` would do")})).set("out_of_reach", Tree::list());
  input.results.set("walk", walk.set("left_out", Tree::list()));
  EXPECT_NE(render_report(input).find("a longer <code>duration_<wbr>s: 50</code> would do"), std::string::npos);
}

TEST(Report, SaysThatNoMethodGaveAPose) {
  ReportInput input = sample();
  EXPECT_EQ(render_report(input).find("No method gave one pose."), std::string::npos);
  input.methods.front().samples.clear();
  EXPECT_NE(render_report(input).find("No method gave one pose."), std::string::npos);
  std::erase_if(input.methods, [](const ReportMethod& method) { return method.name != "truth"; });
  EXPECT_EQ(render_report(input).find("No method gave one pose."), std::string::npos);
  EXPECT_NE(render_report(input).find("No method was run beside the truth"), std::string::npos);
}

TEST(Report, WorksWithoutAnyMethod) {
  ReportInput input = sample();
  input.methods.clear();
  input.truth.clear();
  EXPECT_NE(render_report(input).find("</html>"), std::string::npos);
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
    EXPECT_EQ(occurrences(page, "<figure class=\"plot" + std::string(std::string(id) == "errors" ? "" : " small") +
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
  EXPECT_EQ(occurrences(page, "class=\"errorpath\" stroke=\"var(--e2)\""), 1U);
  EXPECT_EQ(occurrences(page, "class=\"errorpath\" stroke=\"var(--e4)\""), 1U);
}

}  // namespace
}  // namespace plumbline::scenarios
