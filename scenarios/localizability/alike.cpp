// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/alike.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "scenarios/localizability/constants.h"

namespace plumbline::scenarios {

namespace {

constexpr std::size_t asked_places = 4;  ///< by whose scans the deciding element is named; assumed
constexpr std::size_t most_tried = 60;   ///< places compared to find them; assumed, so that the work is bounded

class AlikeFinder {
 public:
  AlikeFinder(const bim::Building& plan, const VisibleBuilding& visible, const std::vector<SearchArea>& storeys,
              const std::vector<Floor>& floors, const LocalizabilityMap& map)
      : plan_(plan),
        visible_(visible),
        scenes_{&visible.planned.scene, &visible.as_built().scene, visible.loose},
        storeys_(storeys),
        floors_(floors),
        map_(map) {}

  [[nodiscard]] AlikePlaces find(std::size_t most) const {
    std::vector<std::vector<std::size_t>> cells(map_.isometries.size());
    for (std::size_t c = 0; c < map_.cells.size(); ++c)
      for (const CellAlias& alias : map_.cells[c].aliases) cells[alias.isometry].push_back(c);
    std::vector<std::size_t> order(cells.size());
    for (std::size_t g = 0; g < order.size(); ++g) order[g] = g;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return cells[a].size() > cells[b].size(); });
    std::vector<std::size_t> taken;
    AlikePlaces out;
    for (const std::size_t g : order) {
      if (out.others == most_others || cells[g].empty()) break;
      const SensorPose first = place(cells[g].front());
      const auto alike = [&](std::size_t t) {
        const Pose back = map_.isometries[t].inverse() * first.pose();  // from the images to the places is the same
        return same_pose(image(t, first), image(g, first), localizability_constants.same_alias_m,
                         localizability_constants.same_alias_deg) ||
               same_pose({back.t, back.yaw()}, image(g, first), localizability_constants.same_alias_m,
                         localizability_constants.same_alias_deg);
      };
      if (std::any_of(taken.begin(), taken.end(), alike)) continue;
      taken.push_back(g);
      if (out.motions.size() < most)
        out.motions.push_back(describe(g, cells[g]));
      else
        ++out.others;
    }
    return out;
  }

 private:
  [[nodiscard]] SensorPose place(std::size_t cell) const {
    const MapCell& c = map_.cells[cell];
    return {{c.p_W.x(), c.p_W.y(), storeys_[floors_[c.floor].storey].sensor_z_W(c.p_W)}, 0.0};
  }
  [[nodiscard]] SensorPose image(std::size_t isometry, const SensorPose& place) const {
    const Pose X = map_.isometries[isometry] * place.pose();
    return {X.t, X.yaw()};
  }
  [[nodiscard]] int storey_at(const Eigen::Vector3d& p_W) const {
    for (std::size_t s = 0; s < storeys_.size(); ++s)
      if (std::abs(storeys_[s].sensor_z_W(p_W.head<2>()) - p_W.z()) < localizability_constants.same_alias_m)
        return static_cast<int>(s);
    return -1;
  }
  [[nodiscard]] int room_at(const Eigen::Vector3d& p_W) const {
    const int storey = storey_at(p_W);
    for (std::size_t r = 0; r < plan_.rooms.size(); ++r)
      if (plan_.rooms[r].storey == storey && plan_.rooms[r].contains(p_W.head<2>())) return static_cast<int>(r);
    return -1;
  }
  /// A robot can stand there: a place of the map is near.
  [[nodiscard]] bool on_floor(const Eigen::Vector3d& p_W) const {
    constexpr double near_m = 0.5;
    return std::any_of(map_.cells.begin(), map_.cells.end(), [&](const MapCell& cell) {
      return (cell.p_W - p_W.head<2>()).norm() < near_m &&
             std::abs(storeys_[floors_[cell.floor].storey].sensor_z_W(cell.p_W) - p_W.z()) < near_m;
    });
  }

  [[nodiscard]] Alike describe(std::size_t g, const std::vector<std::size_t>& cells) const {
    Alike alike;
    alike.transform = map_.isometries[g];
    alike.places = static_cast<int>(cells.size());
    alike.compass = std::abs(alike.transform.yaw()) <= localizability_constants.known_yaw_deg * rad_per_deg;
    std::map<std::pair<int, int>, int> rooms;
    for (const std::size_t c : cells) {
      int a = room_at(place(c).position_W), b = room_at(image(g, place(c)).position_W);
      if (a > b) std::swap(a, b);
      ++rooms[{a, b}];
    }
    std::vector<std::pair<int, std::pair<int, int>>> sorted;
    for (const auto& [pair, n] : rooms) sorted.emplace_back(-n, pair);
    std::sort(sorted.begin(), sorted.end());
    for (const auto& [n, pair] : sorted) alike.rooms.push_back(pair);
    alike.distinguished = distinction(g, cells);
    return alike;
  }

  /// Places on floors with aliased ones that are not aliased under the motion themselves, those near aliased ones
  /// first.
  [[nodiscard]] std::vector<std::size_t> others(std::size_t g, const std::vector<std::size_t>& cells) const {
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t c = 0; c < map_.cells.size(); ++c) {
      const auto& aliases = map_.cells[c].aliases;
      if (std::any_of(aliases.begin(), aliases.end(), [&](const CellAlias& alias) { return alias.isometry == g; }))
        continue;
      double least = 1e9;
      for (const std::size_t a : cells)
        if (map_.cells[a].floor == map_.cells[c].floor)
          least = std::min(least, (map_.cells[a].p_W - map_.cells[c].p_W).norm());
      if (least < 1e9) near.emplace_back(least, c);
    }
    std::sort(near.begin(), near.end());
    std::vector<std::size_t> out;
    for (const auto& [distance, c] : near) out.push_back(c);
    return out;
  }

  [[nodiscard]] std::optional<Distinction> distinction(std::size_t g, const std::vector<std::size_t>& cells) const {
    ElementEvidence sum;
    std::size_t asked = 0, tried = 0;
    std::optional<Eigen::Vector2d> from;
    for (const std::size_t c : others(g, cells)) {
      if (asked == asked_places || tried == most_tried) break;
      const SensorPose here = place(c), other = image(g, here);
      if (!on_floor(other.position_W)) continue;
      ++tried;
      ElementEvidence one;
      one.add(imager_, scenes_, see(imager_, scenes_, here), other);
      if (one.llr <= localizability_constants.drop_llr) continue;
      ++asked;
      if (!from) from = map_.cells[c].p_W;
      for (const auto& [key, gain] : one.by_element) sum.by_element[key] += gain;
    }
    const std::optional<DecidingFeature> feature = sum.deciding();
    if (!feature || !from) return std::nullopt;
    const VisibleScene& scene = feature->missing ? visible_.planned : visible_.as_built();
    return Distinction{scene.elements.at(static_cast<std::size_t>(feature->element)), feature->missing, feature->share,
                       *from};
  }

  const bim::Building& plan_;
  const VisibleBuilding& visible_;
  ComparedScenes scenes_;
  const std::vector<SearchArea>& storeys_;
  const std::vector<Floor>& floors_;
  const LocalizabilityMap& map_;
  RangeImager imager_;
};

}  // namespace

AlikePlaces alike_places(const bim::Building& plan, const VisibleBuilding& visible,
                         const std::vector<SearchArea>& storeys, const std::vector<Floor>& floors,
                         const LocalizabilityMap& map, std::size_t most) {
  return AlikeFinder(plan, visible, storeys, floors, map).find(most);
}

}  // namespace plumbline::scenarios
