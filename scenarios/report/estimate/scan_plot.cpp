// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/scan_plot.h"

#include <algorithm>

#include "scenarios/metrics/state_names.h"
#include "scenarios/report/plot.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

constexpr std::size_t most_points = 2000;

/// Time since the scan before, s; of many scans the longest of a few neighbours, so that no pause is lost.
std::vector<Eigen::Vector2d> intervals_of(const std::vector<double>& scans_s) {
  std::vector<Eigen::Vector2d> points;
  const std::size_t together = scans_s.size() / most_points + 1;
  for (std::size_t i = 1; i < scans_s.size(); ++i) {
    const Eigen::Vector2d point(scans_s[i], scans_s[i] - scans_s[i - 1]);
    if ((i - 1) % together == 0)
      points.push_back(point);
    else if (point.y() > points.back().y())
      points.back() = point;
  }
  return points;
}

std::vector<PlotBand> bands_of(const std::vector<StateSpan>& spans) {
  std::vector<PlotBand> bands;
  for (const StateSpan& span : spans) {
    const bool lost = span.state == state_name(slam::State::lost);
    bands.push_back({span.from_s, span.to_s, span.state, lost ? "var(--lost)" : "var(--converged)"});
  }
  return bands;
}

/// "a pause of 3.2 s"
std::string pause_label(const ScanPause& pause) {
  return "no scan for " + svg::number(pause.to_s - pause.from_s, 1) + " s";
}

std::vector<PlotMark> pause_marks(const std::vector<ScanPause>& pauses) {
  constexpr std::size_t most = 5;  // a row of text each
  std::vector<PlotMark> marks;
  for (std::size_t i = 0; i < std::min(most, pauses.size()); ++i)
    marks.push_back({pauses[i].from_s, pause_label(pauses[i])});
  std::stable_sort(marks.begin(), marks.end(), [](const PlotMark& a, const PlotMark& b) { return a.t_s < b.t_s; });
  return marks;
}

std::string scans_sentence(const EstimatePage& page, double usual_s, double longest_s) {
  std::string text = std::to_string(page.scans_s.size()) + " scans in " + svg::number(page.scans_s.back(), 1) +
                     " s, usually one every " + svg::number(usual_s, 3) + " s, at most " + svg::number(longest_s, 3) +
                     " s apart. ";
  if (page.pauses.empty()) return text + "No pause.";
  return text + (page.pauses.size() == 1 ? "1 pause" : std::to_string(page.pauses.size()) + " pauses") +
         ", the longest after " + svg::number(page.pauses.front().from_s, 1) +
         " s: " + pause_label(page.pauses.front()) + ".";
}

}  // namespace

std::string draw_scans(const EstimatePage& page) {
  if (page.scans_s.size() < 2) return "";
  const std::vector<Eigen::Vector2d> intervals = intervals_of(page.scans_s);
  std::vector<double> sorted;
  for (std::size_t i = 1; i < page.scans_s.size(); ++i) sorted.push_back(page.scans_s[i] - page.scans_s[i - 1]);
  std::sort(sorted.begin(), sorted.end());
  const double usual_s = sorted[sorted.size() / 2], longest_s = sorted.back();
  const bool slam = !page.input.methods.front().localization;
  const bool lost = slam && page.spans.size() > 1;
  constexpr double even = 1.5;  // of the usual interval
  std::string out = "<section class=\"card\"><h2>The scans over time</h2>";
  if (longest_s > even * usual_s || lost) {
    PlotExtras extras;
    extras.title = "time since the scan before, s";
    extras.max = 1.05 * longest_s;
    extras.marks = pause_marks(page.pauses);
    if (slam) extras.bands = bands_of(page.spans);
    PlotCurve curve{"", "var(--m0)", intervals};
    curve.layer = page.input.methods.front().name;
    curve.gap_s = page.scans_s.back() + 1.0;  // a pause is a peak, not a gap
    out += draw_plot("scans", {curve}, page.scans_s.back(), extras);
    if (slam)
      out +=
          "<div class=\"key\"><span><i class=\"swatch\" style=\"background:var(--converged)\"></i>followed: the method "
          "gives a pose and stands by it</span><span><i class=\"swatch\" style=\"background:var(--lost)\"></i>LOST: it "
          "says that its pose is no answer</span></div>";
  }
  return out + "<p class=\"facts\">" + svg::escape(scans_sentence(page, usual_s, longest_s)) + "</p></section>";
}

}  // namespace plumbline::scenarios
