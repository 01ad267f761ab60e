// SPDX-License-Identifier: Apache-2.0
#include "bim/model/wall_section.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <set>
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
  struct Crossing {
    double across = 0.0;
    int inward = 0;  ///< 1: the body begins here, -1: it ends
  };
  std::vector<Crossing> crossings;
  int all = 0;
  for (const WallCut& cut : cuts) {
    if ((cut.a.x() > s) == (cut.b.x() > s)) continue;
    const double across = cut.a.y() + (cut.b.y() - cut.a.y()) * ((s - cut.a.x()) / (cut.b.x() - cut.a.x()));
    crossings.push_back({across, cut.b.x() < cut.a.x() ? 1 : -1});
    all += crossings.back().inward;
  }
  std::sort(crossings.begin(), crossings.end(),
            [](const Crossing& a, const Crossing& b) { return a.across < b.across; });
  double sum = 0.0;
  int depth = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    depth += crossings[i].inward;
    // Parts may overlap, or one be given twice; where faces are turned over their number alone tells.
    if (all == 0 ? depth != 0 : i % 2 == 0) sum += crossings[i + 1].across - crossings[i].across;
  }
  return sum;
}

/// Cuts by where they begin and end and by their direction, to find what continues one.
class Chains {
 public:
  explicit Chains(const std::vector<WallCut>& cuts) : cuts_(cuts) {
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      const std::int64_t direction = direction_of(cuts[i]);
      starts_[key(cuts[i].a, direction)].insert(i);
      ends_[key(cuts[i].b, direction)].insert(i);
    }
  }

  void remove(std::size_t i) {
    const std::int64_t direction = direction_of(cuts_[i]);
    starts_[key(cuts_[i].a, direction)].erase(i);
    ends_[key(cuts_[i].b, direction)].erase(i);
  }
  /// The first that `cut` goes on in, or that goes on in it.
  [[nodiscard]] std::optional<std::size_t> next_to(const WallCut& cut) const {
    const std::optional<std::size_t> after =
        first(starts_, cut.b, cut, [&](const WallCut& other) { return continues(cut, other); });
    const std::optional<std::size_t> before =
        first(ends_, cut.a, cut, [&](const WallCut& other) { return continues(other, cut); });
    if (!after || !before) return after ? after : before;
    return std::min(*after, *before);
  }
  [[nodiscard]] static bool continues(const WallCut& p, const WallCut& q) {
    return (p.b - q.a).norm() < touch_m &&
           std::abs(cross((p.b - p.a).normalized(), (q.b - q.a).normalized())) < level &&
           (p.b - p.a).dot(q.b - q.a) > 0.0;
  }

 private:
  static constexpr double touch_m = 1e-4, level = 1e-3;
  static constexpr std::int64_t directions = 6276;  // each a little more than `level` wide
  using Key = std::array<std::int64_t, 3>;
  using Table = std::map<Key, std::set<std::size_t>>;

  static std::int64_t whole(double x) {
    constexpr double most = 1e15;
    return std::isfinite(x) ? static_cast<std::int64_t>(std::floor(std::clamp(x, -most, most))) : 0;
  }
  static std::int64_t direction_of(const WallCut& cut) {
    const Eigen::Vector2d d = cut.b - cut.a;
    const double turns = std::atan2(d.y(), d.x()) / (2.0 * std::numbers::pi) + 0.5;
    return std::min(whole(turns * static_cast<double>(directions)), directions - 1);
  }
  static Key key(const Eigen::Vector2d& p, std::int64_t direction) {
    return {whole(p.x() / touch_m), whole(p.y() / touch_m), direction};
  }
  template <class Continues>
  std::optional<std::size_t> first(const Table& table, const Eigen::Vector2d& p, const WallCut& cut,
                                   const Continues& continues) const {
    std::optional<std::size_t> found;
    const Key at = key(p, direction_of(cut));
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int turn = -1; turn <= 1; ++turn) {
          const auto cell = table.find({at[0] + dx, at[1] + dy, (at[2] + turn + directions) % directions});
          if (cell == table.end()) continue;
          for (const std::size_t i : cell->second)
            if (continues(cuts_[i])) {
              found = std::min(found.value_or(i), i);
              break;
            }
        }
    return found;
  }

  const std::vector<WallCut>& cuts_;
  Table starts_, ends_;
};

}  // namespace

std::vector<WallCut> section(const Wall& wall, double z) {
  const std::vector<WallCut> cuts = cut_triangles(wall, z);
  std::vector<WallCut> joined;
  std::vector<bool> taken(cuts.size(), false);
  Chains chains(cuts);
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    if (taken[i]) continue;
    chains.remove(i);
    WallCut& whole = joined.emplace_back(cuts[i]);
    while (const std::optional<std::size_t> next = chains.next_to(whole)) {
      if (Chains::continues(whole, cuts[*next]))
        whole.b = cuts[*next].b;
      else
        whole.a = cuts[*next].a;
      taken[*next] = true;
      chains.remove(*next);
    }
  }
  return joined;
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
