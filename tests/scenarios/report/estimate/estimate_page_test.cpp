// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/estimate_page.h"

#include <gtest/gtest.h>

#include "tests/occurrences.h"

namespace plumbline::scenarios {
namespace {

/// Of SLAM on its own map, with names that a page must not take for its own.
EstimatePage slam_page() {
  EstimatePage page;
  ReportInput& input = page.input;
  input.has_plan = false;
  input.truth_name = "reference";
  input.plan.storeys = {{}};
  input.storeys = {{0, "", {}, "<g id=\"points\"/>"}};
  ReportMethod method;
  method.name = "m";
  method.judged = false;
  method.lost_drawn = true;
  for (int i = 0; i < 50; ++i) {
    ReportSample& sample = method.samples.emplace_back();
    sample.t_s = 0.1 * i;
    sample.x = 0.05 * i;
    sample.judged = false;
    sample.lost = i >= 40;
    page.scans_s.push_back(0.1 * i);
  }
  input.methods = {method};
  input.results = Tree::map().set("methods", Tree(Tree::Map{{"m", Tree::map().set("length_m", 2.45)}}));
  page.spans = {{0.0, 4.0, "followed"}, {4.0, 4.9, "LOST"}};
  page.state = "LOST";
  page.has_map = true;
  page.answer = "A path <of> 2.45 m.";
  page.facts.recording = "walk <b>\"x\"</b>.bag";
  page.facts.command = "plumbline estimate 'a & b'";
  page.facts.given = {{"points", "/<topic>"}};
  page.facts.warnings = {"</script><script>alert(1)</script>"};
  return page;
}

EstimatePage localized_page() {
  EstimatePage page = slam_page();
  page.input.has_plan = true;
  bim::PlanFace face;
  face.storey = 0;
  face.p1 = {4.0, 0.0};
  page.input.plan.faces = {face};
  ReportMethod& method = page.input.methods.front();
  method.localization = true;
  method.states = {{0.0, 2, slam::State::ambiguous}, {2.0, 1, slam::State::converged}};
  method.converged_s = 2.0;
  method.histories = {{0, false, "a<b", {{0.0, 0.5}, {0.9, 0.9}}}};
  method.beliefs = {{"start", 0.0, {{1.0, 1.0, 0.0, 1.0}}, {0.0, 1.0}, 0}};
  const ReportWall wall{{0, 0}, {4, 0}, 0};
  method.recognised = {{"at convergence", 2.0, 0, {1.0, 1.0}, {{{1.0, 1.0}, 0.5, 1.0, {{{wall}, wall, false}}}}}};
  return page;
}

TEST(EstimatePage, EscapesNamesAndLoadsNothing) {
  const std::string page = render_estimate(slam_page());
  EXPECT_EQ(occurrences(page, "http://") + occurrences(page, "https://") + occurrences(page, "src=") +
                occurrences(page, "<link"),
            0U);
  EXPECT_EQ(occurrences(page, "<b>\"x\"") + occurrences(page, "<of>") + occurrences(page, "/<topic>") +
                occurrences(page, "<script>alert"),
            0U);
  EXPECT_NE(page.find("m on walk &lt;b&gt;&quot;x&quot;&lt;/b&gt;.bag"), std::string::npos);
  EXPECT_EQ(occurrences(page, "plumbline estimate 'a &amp; b'"), 2U);
}

TEST(EstimatePage, SaysNothingOfATruthThatIsNotKnown) {
  for (const EstimatePage& made : {slam_page(), localized_page()}) {
    const std::string page = render_estimate(made);
    const std::string body = page.substr(page.find("<body>"), page.find("<script") - page.find("<body>"));
    for (const char* word : {"truth\"", "true p", "ground truth", " right", "wrong", "PASS", "verdict", "cm off"})
      EXPECT_EQ(body.find(word), std::string::npos) << word;
    EXPECT_NE(body.find("no reference has been given"), std::string::npos);
    EXPECT_EQ(occurrences(body, "errorpath"), 2U);  // of the style
  }
}

TEST(EstimatePage, DrawsTheMapAndWhereItWasLost) {
  const std::string page = render_estimate(slam_page());
  EXPECT_NE(page.find("<g id=\"points\"/>"), std::string::npos);
  EXPECT_EQ(occurrences(page, "class=\"path\""), 1U);
  EXPECT_EQ(occurrences(page, "class=\"path lost\""), 1U);
  EXPECT_NE(page.find("while it reports LOST"), std::string::npos);
  EXPECT_NE(page.find("background:var(--lost)\"></i>LOST at the end"), std::string::npos);
  EXPECT_EQ(page.find("wall of the building"), std::string::npos);
  EXPECT_NE(page.find("id=\"scans\""), std::string::npos);
  EstimatePage even = slam_page();
  even.spans = {{0.0, 4.9, "followed"}};
  EXPECT_EQ(render_estimate(even).find("id=\"scans\""), std::string::npos);
  EXPECT_NE(render_estimate(even).find("usually one every 0.1 s"), std::string::npos);
}

TEST(EstimatePage, ShowsHypothesesOfALocalization) {
  const std::string page = render_estimate(localized_page());
  EXPECT_NE(page.find("wall of the building"), std::string::npos);
  EXPECT_NE(page.find("id=\"belief-m\""), std::string::npos);
  EXPECT_NE(page.find("hypothesis 1: a&lt;b"), std::string::npos);
  EXPECT_NE(page.find("at convergence, 2 s: 1 wall<"), std::string::npos);
  EXPECT_NE(page.find(">converged</span>"), std::string::npos);
  EXPECT_EQ(occurrences(page, "class=\"thing"), 1U);  // the key
}

/// Beside a reference over the first two seconds.
EstimatePage scored_page() {
  EstimatePage made = slam_page();
  made.reference.in_plan_frame = true;
  made.by_reference = "By the reference: position error 8 cm rms.";
  for (ReportSample& sample : made.input.methods.front().samples) {
    made.input.truth.push_back({sample.t_s, sample.x, 0.08, 0.0});
    sample.judged = sample.t_s < 2.0;
    sample.error_m = 0.08;
    sample.relative_m = 0.08;
  }
  return made;
}

TEST(EstimatePage, ShowsAReferenceAndItsErrors) {
  const EstimatePage made = scored_page();
  const std::string page = render_estimate(made);
  EXPECT_NE(page.find("By the reference: position error 8 cm rms"), std::string::npos);
  EXPECT_NE(page.find("id=\"errors\""), std::string::npos);
  EXPECT_NE(page.find(">reference</span>"), std::string::npos);
  EXPECT_EQ(page.find("id=\"errors-x\""), std::string::npos);
  EXPECT_NE(page.find("class=\"errorpath\""), std::string::npos);
  EXPECT_NE(page.find("0.08,null"), std::string::npos);  // from where the reference ends
}

TEST(EstimatePage, SaysWhyThereIsNoPlan) {
  const std::string why = "The plan is not drawn: this estimate has no plan.json";
  EstimatePage made = localized_page();
  EXPECT_EQ(render_estimate(made).find(why), std::string::npos);
  made.input.has_plan = false;
  EXPECT_NE(render_estimate(made).find(why), std::string::npos);
  EXPECT_EQ(render_estimate(slam_page()).find(why), std::string::npos);  // SLAM has none
}

TEST(EstimatePage, PlotsNoTurnOfAReferenceOfPositionsAlone) {
  EstimatePage made = scored_page();
  EXPECT_NE(render_estimate(made).find("id=\"errors-heading\""), std::string::npos);
  EXPECT_NE(render_estimate(made).find("id=\"errors-relative\""), std::string::npos);
  made.reference.positions_alone = true;
  const std::string page = render_estimate(made);
  EXPECT_NE(page.find("id=\"errors-z\""), std::string::npos);
  EXPECT_EQ(page.find("id=\"errors-heading\""), std::string::npos);
  EXPECT_EQ(page.find("id=\"errors-relative\""), std::string::npos);
}

TEST(EstimatePage, NamesPausesAndAlteredFiles) {
  EstimatePage made = slam_page();
  made.scans_s.push_back(12.0);
  made.pauses = {{4.9, 12.0}};
  made.altered = {"m.tum"};
  made.facts.unchecked = {"lidar.pcap"};
  const std::string page = render_estimate(made);
  EXPECT_NE(page.find("1 pause, the longest after 4.9 s: no scan for 7.1 s."), std::string::npos);
  EXPECT_NE(page.find("Files of this estimate were altered or added after it was written: m.tum"), std::string::npos);
  EXPECT_NE(page.find("Files of the recording were altered or added after it was written: lidar.pcap"),
            std::string::npos);
}

TEST(EstimatePage, OfOneScanAndOfNoneCanBeMade) {
  EstimatePage made = slam_page();
  made.input.methods.front().samples.clear();
  made.spans.clear();
  for (std::size_t scans = 2; scans-- > 0;) {
    made.scans_s.assign(scans, 0.0);
    made.has_map = scans == 1;
    EXPECT_EQ(render_estimate(made).find("no path and no map") == std::string::npos, scans == 1);
    EXPECT_NE(render_estimate(made).find(scans == 1 ? "1 scan<" : "no scan<"), std::string::npos);
  }
}

}  // namespace
}  // namespace plumbline::scenarios
