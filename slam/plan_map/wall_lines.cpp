// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/wall_lines.h"

#include <algorithm>
#include <cmath>

namespace plumbline::slam {

namespace {

bool coplanar(const PlanSegment& a, const PlanSegment& b, const PlanIndexConfig& config) {
  if (a.e.dot(b.e) < std::cos(config.line_angle_rad)) return false;
  const Eigen::Vector2d b_end = b.a + b.length * b.e;
  return std::abs((b.a - a.a).dot(a.n)) < config.line_offset_m &&
         std::abs((b_end - a.a).dot(a.n)) < config.line_offset_m;
}

bool at_height(const PlanSegment& segment, double z) { return segment.z0 < z && segment.z1 > z; }

struct Interval {
  double s0, s1;
  std::size_t segment;
};

/// Unassigned faces coplanar with `first`, as intervals along it, by start.
std::vector<Interval> coplanar_intervals(const std::vector<PlanSegment>& segments, std::size_t first, double band_z,
                                         const PlanIndexConfig& config) {
  const PlanSegment& base = segments[first];
  std::vector<Interval> intervals;
  for (std::size_t i = first; i < segments.size(); ++i) {
    if (segments[i].plan_face < 0 || segments[i].line >= 0 || !at_height(segments[i], band_z)) continue;
    if (!coplanar(base, segments[i], config)) continue;
    const double s0 = (segments[i].a - base.a).dot(base.e);
    intervals.push_back({s0, s0 + segments[i].length, i});
  }
  std::stable_sort(intervals.begin(), intervals.end(),
                   [](const Interval& a, const Interval& b) { return a.s0 < b.s0; });
  return intervals;
}

/// The run of intervals without a wide gap that holds segment `first`.
std::vector<Interval> run_with(const std::vector<Interval>& intervals, std::size_t first, double gap) {
  std::vector<Interval> run;
  double end = 0.0;
  bool found = false;
  for (const Interval& interval : intervals) {
    if (!run.empty() && interval.s0 > end + gap) {
      if (found) break;
      run.clear();
    }
    end = run.empty() ? interval.s1 : std::max(end, interval.s1);
    run.push_back(interval);
    found = found || interval.segment == first;
  }
  return run;
}

}  // namespace

std::vector<WallLine> merge_wall_lines(std::vector<PlanSegment>& segments, double band_z,
                                       const PlanIndexConfig& config) {
  std::vector<WallLine> lines;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (segments[i].plan_face < 0 || segments[i].line >= 0 || !at_height(segments[i], band_z)) continue;
    const std::vector<Interval> run = run_with(coplanar_intervals(segments, i, band_z, config), i, config.line_gap_m);
    double s0 = 0.0, s1 = segments[i].length;
    for (const Interval& interval : run) {
      s0 = std::min(s0, interval.s0);
      s1 = std::max(s1, interval.s1);
      segments[interval.segment].line = static_cast<int>(lines.size());
    }
    WallLine line;
    line.e = segments[i].e;
    line.n = segments[i].n;
    line.a = segments[i].a + s0 * line.e;
    line.length = s1 - s0;
    line.d = -line.n.dot(line.a);
    line.azimuth = std::atan2(line.n.y(), line.n.x());
    lines.push_back(line);
  }
  return lines;
}

}  // namespace plumbline::slam
