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

/// Where a face stands along a line.
struct FaceSpan {
  double s0, s1;
  std::size_t segment;
};

/// Unassigned faces coplanar with `first`, as spans along it, by start.
std::vector<FaceSpan> coplanar_spans(const std::vector<PlanSegment>& segments, std::size_t first, double band_z,
                                     const PlanIndexConfig& config) {
  const PlanSegment& base = segments[first];
  std::vector<FaceSpan> spans;
  for (std::size_t i = first; i < segments.size(); ++i) {
    if (segments[i].plan_face < 0 || segments[i].line >= 0 || !at_height(segments[i], band_z)) continue;
    if (!coplanar(base, segments[i], config)) continue;
    const double s0 = (segments[i].a - base.a).dot(base.e);
    spans.push_back({s0, s0 + segments[i].length, i});
  }
  std::stable_sort(spans.begin(), spans.end(), [](const FaceSpan& a, const FaceSpan& b) { return a.s0 < b.s0; });
  return spans;
}

/// The run of spans without a wide gap that holds segment `first`.
std::vector<FaceSpan> run_with(const std::vector<FaceSpan>& spans, std::size_t first, double gap) {
  std::vector<FaceSpan> run;
  double end = 0.0;
  bool found = false;
  for (const FaceSpan& span : spans) {
    if (!run.empty() && span.s0 > end + gap) {
      if (found) break;
      run.clear();
    }
    end = run.empty() ? span.s1 : std::max(end, span.s1);
    run.push_back(span);
    found = found || span.segment == first;
  }
  return run;
}

/// Holes over more than least_share of a face's height, along a line whose start is s from the face's.
void add_openings(const PlanSegment& face, double s, WallLine& line) {
  constexpr double least_share = 0.6;  // doors of 2.1 m under ceilings of 2.4 to 3.4 m, no window over a sill; assumed
  for (const bim::FaceHole& hole : face.holes)
    if (std::min(hole.z1, face.z1) - std::max(hole.z0, face.z0) > least_share * (face.z1 - face.z0))
      line.openings.emplace_back(s + hole.s0, s + hole.s1);
}

}  // namespace

std::vector<WallLine> merge_wall_lines(std::vector<PlanSegment>& segments, double band_z,
                                       const PlanIndexConfig& config) {
  std::vector<WallLine> lines;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (segments[i].plan_face < 0 || segments[i].line >= 0 || !at_height(segments[i], band_z)) continue;
    const std::vector<FaceSpan> run = run_with(coplanar_spans(segments, i, band_z, config), i, config.line_gap_m);
    double s0 = 0.0, s1 = segments[i].length;
    for (const FaceSpan& span : run) {
      s0 = std::min(s0, span.s0);
      s1 = std::max(s1, span.s1);
      segments[span.segment].line = static_cast<int>(lines.size());
    }
    WallLine line;
    line.e = segments[i].e;
    line.n = segments[i].n;
    line.a = segments[i].a + s0 * line.e;
    line.length = s1 - s0;
    line.d = -line.n.dot(line.a);
    line.azimuth = std::atan2(line.n.y(), line.n.x());
    for (const FaceSpan& span : run) add_openings(segments[span.segment], span.s0 - s0, line);
    lines.push_back(line);
  }
  return lines;
}

}  // namespace plumbline::slam
