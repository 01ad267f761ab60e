// SPDX-License-Identifier: Apache-2.0
#include "bim/model/wall_section.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "bim/model/wall_frame.h"

namespace plumbline::bim {

namespace {

double cross(const Eigen::Vector2d& u, const Eigen::Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); }

std::vector<WallCut> cut_triangles(const Wall& wall, double z) {
  constexpr double least_m = 1e-4;
  std::vector<WallCut> cuts;
  if (!wall.body) return cuts;
  const WallFrame frame(wall);
  for (const Eigen::Vector3i& triangle : wall.body->triangles) {
    std::vector<Eigen::Vector2d> ends;
    Eigen::Vector3d corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = frame.to_wall(wall.body->vertices[static_cast<std::size_t>(triangle[k])]);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d &p = corner[k], &q = corner[(k + 1) % 3];
      if ((p.z() > z) == (q.z() > z)) continue;
      ends.emplace_back((p + (q - p) * ((z - p.z()) / (q.z() - p.z()))).head<2>());
    }
    if (ends.size() != 2 || (ends[1] - ends[0]).norm() < least_m) continue;
    const Eigen::Vector2d out = (corner[1] - corner[0]).cross(corner[2] - corner[0]).head<2>();
    if (cross(ends[1] - ends[0], out) < 0.0) std::swap(ends[0], ends[1]);
    cuts.push_back({ends[0], ends[1]});
  }
  return cuts;
}

/// Length of the wall's thickness that the section fills at s along it.
double filled_across(const std::vector<WallCut>& cuts, double s) {
  std::vector<double> crossings;
  for (const WallCut& cut : cuts)
    if ((cut.a.x() > s) != (cut.b.x() > s))
      crossings.push_back(cut.a.y() + (cut.b.y() - cut.a.y()) * ((s - cut.a.x()) / (cut.b.x() - cut.a.x())));
  std::sort(crossings.begin(), crossings.end());
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) sum += crossings[i + 1] - crossings[i];
  return sum;
}

}  // namespace

std::vector<WallCut> section(const Wall& wall, double z) {
  constexpr double touch_m = 1e-4, level = 1e-3;
  std::vector<WallCut> cuts = cut_triangles(wall, z);
  const auto continues = [](const WallCut& p, const WallCut& q) {
    return (p.b - q.a).norm() < touch_m &&
           std::abs(cross((p.b - p.a).normalized(), (q.b - q.a).normalized())) < level &&
           (p.b - p.a).dot(q.b - q.a) > 0.0;
  };
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    for (std::size_t j = i + 1; j < cuts.size();) {
      if (continues(cuts[i], cuts[j]))
        cuts[i].b = cuts[j].b;
      else if (continues(cuts[j], cuts[i]))
        cuts[i].a = cuts[j].a;
      else {
        ++j;
        continue;
      }
      cuts.erase(cuts.begin() + static_cast<std::ptrdiff_t>(j));
      j = i + 1;  // what did not touch may touch the longer one
    }
  }
  return cuts;
}

bool is_straight(const Wall& wall, const std::vector<Opening>& openings, const Interval& z,
                 const WallSectionConfig& config) {
  if (!wall.body) return true;
  const double margin = std::min(wall.thickness_m, config.mitre_m);
  for (const double share : {0.1, 0.5, 0.9}) {
    const std::vector<WallCut> cuts = cut_triangles(wall, z.low + share * z.length());
    double missing = 0.0;
    for (double s = margin + 0.5 * config.step_m; s < wall.length() - margin; s += config.step_m) {
      const bool open = std::any_of(openings.begin(), openings.end(), [&](const Opening& o) {
        return std::abs(s - o.s_m) < 0.5 * o.width_m + config.step_m;
      });
      if (!open && filled_across(cuts, s) < config.least_fill * wall.thickness_m) missing += config.step_m;
    }
    if (missing < config.gap_min_m) return true;
  }
  return false;
}

std::vector<Opening> openings_of(const Building& building, int wall) {
  std::vector<Opening> own;
  for (const Opening& opening : building.openings)
    if (opening.wall == wall) own.push_back(opening);
  return own;
}

std::vector<Wall> surface_walls(const Wall& wall, double z, double deepest_m) {
  const WallFrame frame(wall);
  const std::vector<WallCut> cuts = section(wall, z);
  double area = 0.0, outline = 0.0;
  for (const WallCut& cut : cuts) {
    area += 0.5 * cross(cut.a, cut.b);
    outline += (cut.b - cut.a).norm();
  }
  const double deep = std::min(deepest_m, outline > 0.0 ? 2.0 * std::abs(area) / outline : deepest_m);
  std::vector<Wall> walls;
  for (const WallCut& cut : cuts) {
    Wall face = wall;
    face.body.reset();
    face.slope = 0.0;
    face.a = frame.to_world({cut.a.x(), cut.a.y(), z}).head<2>();
    face.b = frame.to_world({cut.b.x(), cut.b.y(), z}).head<2>();
    face.thickness_m = deep;
    face.offset_m = -deep;
    walls.push_back(std::move(face));
  }
  return walls;
}

}  // namespace plumbline::bim
