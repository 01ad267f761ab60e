// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <utility>

#include "tests/scenarios/report/report_sample.h"

namespace plumbline::scenarios {
namespace {

TEST(Report, ShowsAGatesLimitHoweverSmall) {
  ReportInput input = sample();
  Tree gate = Tree::map();
  gate.set("metric", "ate_aligned_rmse_m").set("method", "truth").set("op", "<=").set("limit", 1e-9).set("value", 0.0);
  gate.set("passed", true);
  input.results.set("gates", Tree(Tree::List{gate}));
  EXPECT_NE(render_report(input).find("&lt;= 1e-09"), std::string::npos);
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
      page.find("the scans favour it only marginally, since the true pose dropped out of the hypotheses (at t = 4 s)"),
      std::string::npos);
  input.has_replay = true;
  EXPECT_NE(
      render_report(input).find("<a class=\"badge bad\" href=\"replay.html#m=m\">m: overconfident, not judged</a>"),
      std::string::npos);
  where.set("hypotheses", 2);
  input.results.set("methods",
                    Tree(Tree::Map{{"m", Tree::map().set("verdict", "honest_ambiguity").set("localization", where)}}));
  EXPECT_NE(render_report(input).find("rightly: the scans favour one only marginally"), std::string::npos);
}

TEST(Report, NamesAMethodThatIsNotLocalizedAgainAfterAKidnappingUnlessAGateDoes) {
  ReportInput input = localized();
  input.kidnap = ReportKidnap{7.0, 9.0};
  Tree where = Tree::map();
  where.set("converged_at_s", 6.0).set("kidnap_wrong_s", 1.0);
  const auto page = [&] {
    input.results.set("methods",
                      Tree(Tree::Map{{"m", Tree::map().set("verdict", "success").set("localization", where)}}));
    return render_report(input);
  };
  const std::string badge = "m: not localized again after the kidnapping, not judged";
  EXPECT_NE(page().find(badge), std::string::npos);
  EXPECT_NE(page().find("it was CONVERGED on a wrong pose for up to 1"), std::string::npos);
  const Tree converged = std::exchange(where, Tree::map().set("kidnap_wrong_s", 1.0));  // it never was localized
  EXPECT_NE(page().find("m: not localized after the kidnapping either, not judged"), std::string::npos);
  where = converged;
  Tree gate = input.results.find("gates")->as_list().front();
  input.results.set("gates", Tree(Tree::List{gate.set("metric", "localization.kidnap_found_s")}));
  EXPECT_EQ(page().find(badge), std::string::npos);
  where.set("kidnap_found_s", 1.0);
  input.results.set("gates", Tree::list());
  EXPECT_EQ(page().find(badge), std::string::npos);
}

TEST(Report, NamesSlamThatIsFarOffUnlessAGateJudgesItsError) {
  ReportInput input = sample();
  for (ReportSample& s : input.methods.front().samples) s.error_m = s.t_s < 5.0 ? 0.08 : 0.8;
  const auto page = [&](double error_m, const char* metric) {
    const Tree block = Tree::map().set("verdict", "complete").set("ate_aligned_rmse_m", error_m);
    input.results.set("methods", Tree(Tree::Map{{"m", block}}));
    Tree gate = input.results.find("gates")->as_list().front();
    input.results.set("gates", Tree(Tree::List{gate.set("metric", metric).set("passed", true)}));
    return render_report(input);
  };
  const std::string badge = "<span class=\"badge bad\">m: off by 56 cm rms, not judged</span>";
  const std::string far = page(0.56, "rooms.recall");
  EXPECT_NE(far.find(badge), std::string::npos);
  EXPECT_NE(far.find("<span class=\"verdict bad\">complete</span>"), std::string::npos);
  EXPECT_NE(far.find("More than 0.5 m off from t = 5 s to the end, at most 80 cm."), std::string::npos);
  EXPECT_NE(far.find("<code>far off</code>"), std::string::npos);
  EXPECT_EQ(page(0.49, "rooms.recall").find(badge.substr(0, 28)), std::string::npos);
  EXPECT_EQ(page(0.56, "ate_final_rmse_m").find("rms, not judged"), std::string::npos);
}

TEST(Report, SaysWithWhichErrorAMethodStopped) {
  ReportInput input = sample();
  const Tree block = Tree::map().set("verdict", "crashed").set("error", "ValueError: <no plane>");
  input.results.set("methods", Tree(Tree::Map{{"m", block}}));
  EXPECT_NE(render_report(input).find("stopped with an error: ValueError: &lt;no plane&gt;"), std::string::npos);
}

TEST(Report, GivesAnErrorOfMetresInMetres) {
  ReportInput input = sample();
  const Tree block = Tree::map().set("verdict", "complete").set("ate_aligned_rmse_m", 2.926);
  input.results.set("methods", Tree(Tree::Map{{"m", block}}));
  EXPECT_NE(render_report(input).find("Position error 2.93 m rms"), std::string::npos);
}

TEST(Report, ColoursAVerdictByTheGates) {
  ReportInput input = sample();  // its gate failed
  EXPECT_NE(render_report(input).find("<span class=\"verdict bad\">complete</span>"), std::string::npos);
  EXPECT_NE(render_report(input).find("0 of 1 gate passed."), std::string::npos);
  input.results.set("gates", Tree::list());
  EXPECT_NE(render_report(input).find("<span class=\"verdict open\">complete</span>"), std::string::npos);
  EXPECT_NE(render_report(input).find("No gate judges it."), std::string::npos);
}

}  // namespace
}  // namespace plumbline::scenarios
