// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/mesh/mesh_axes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "bim/median.h"

namespace plumbline::bim {

namespace {

struct MeshUnit {
  std::string_view name;
  double metres;
};
constexpr MeshUnit metre{"metre", 1.0};
constexpr std::array<MeshUnit, 4> other_units{
    {{"millimetre", 0.001}, {"centimetre", 0.01}, {"inch", 0.0254}, {"foot", 0.3048}}};

/// Area of the faces that lie across x, y and z.
Eigen::Vector3d areas_across(const std::vector<MeshPart>& parts, double level) {
  Eigen::Vector3d areas = Eigen::Vector3d::Zero();
  for (const MeshPart& part : parts)
    for (const Eigen::Vector3i& t : part.solid.triangles) {
      const auto corner = [&](int k) -> const Eigen::Vector3d& {
        return part.solid.vertices[static_cast<std::size_t>(t[k])];
      };
      const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
      for (int axis = 0; axis < 3; ++axis)
        if (std::abs(normal[axis]) >= level * normal.norm()) areas[axis] += 0.5 * normal.norm();
    }
  return areas;
}

template <class Change>
void change_points(std::vector<MeshPart>& parts, Change&& change) {
  for (MeshPart& part : parts)
    for (Eigen::Vector3d& p : part.solid.vertices) p = change(p);
}

/// A narrow building with z up has walls that look like floors with y up: both signs are asked for.
bool has_y_up(const std::vector<MeshPart>& parts, const Eigen::Vector3d& sizes, const MeshAxesConfig& config) {
  if (sizes.y() < config.building.lowest_m || sizes.y() > config.most_height_share * std::min(sizes.x(), sizes.z()))
    return false;
  const Eigen::Vector3d areas = areas_across(parts, config.level);
  return areas.y() >= config.least_area_ratio * areas.z();
}

/// Areas of the faces that look along an axis (sign 1) or against it (-1), by their place on it.
std::map<double, double> layers(const std::vector<MeshPart>& parts, int axis, double sign, double step, double level) {
  std::map<double, double> areas;
  for (const MeshPart& part : parts)
    for (const Eigen::Vector3i& t : part.solid.triangles) {
      const auto corner = [&](int k) -> const Eigen::Vector3d& {
        return part.solid.vertices[static_cast<std::size_t>(t[k])];
      };
      const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
      if (normal.norm() > 0.0 && sign * normal[axis] >= level * normal.norm())
        areas[step * std::round(corner(0)[axis] / step)] += 0.5 * normal.norm();
    }
  return areas;
}

/// Usual distance from one floor to the next or the roof, in the unit of the file.
double storey_height(const std::vector<MeshPart>& parts, double height, const MeshAxesConfig& config) {
  constexpr double step_share = 1e-3;
  if (height <= 0.0) return height;
  const std::map<double, double> areas = layers(parts, 2, 1.0, step_share * height, config.level);
  double largest = 0.0;
  for (const auto& [z, area] : areas) largest = std::max(largest, area);
  std::vector<double> steps;
  std::optional<double> last;
  for (const auto& [z, area] : areas) {
    if (area < config.least_floor_share * largest) continue;
    if (last) steps.push_back(z - *last);
    last = z;
  }
  return steps.empty() ? height : upper_median(std::move(steps));
}

/// Usual thickness of walls, from a face to the next that looks away from it; nothing where no two do.
std::optional<double> wall_thickness(const std::vector<MeshPart>& parts, double size, const MeshAxesConfig& config) {
  constexpr double step_share = 1e-5;
  std::vector<double> found;
  for (const int axis : {0, 1}) {
    const auto from = layers(parts, axis, -1.0, step_share * size, config.level);
    const auto to = layers(parts, axis, 1.0, step_share * size, config.level);
    const auto least = [&](const std::map<double, double>& areas) {
      double sum = 0.0;
      for (const auto& [at, area] : areas) sum += area;
      return config.least_wall_share * sum;
    };
    const double least_from = least(from), least_to = least(to);
    for (const auto& [at, area] : from) {
      if (area < least_from) continue;
      auto next = to.upper_bound(at);
      while (next != to.end() && next->second < least_to) ++next;
      if (next != to.end()) found.push_back(next->first - at);
    }
  }
  if (found.empty()) return std::nullopt;
  return upper_median(std::move(found));
}

struct Choice {
  std::optional<MeshUnit> unit;
  bool sure = false;  ///< no other has usual walls and storeys as well
  std::string others;
};

/// Of the units in which the mesh is a building the one whose walls and storeys are usual; walls go before storeys,
/// since halls are high.
Choice choose_unit(const std::vector<MeshPart>& parts, const Eigen::Vector3d& sizes, const MeshAxesConfig& config) {
  const double storey = storey_height(parts, sizes.z(), config);
  const std::optional<double> wall = wall_thickness(parts, sizes.maxCoeff(), config);
  const auto rank = [&](const MeshUnit& unit) {
    const double storey_m = storey * unit.metres, wall_m = wall.value_or(0.0) * unit.metres;
    return (wall_m >= config.thinnest_wall_m && wall_m <= config.thickest_wall_m ? 2 : 0) +
           (storey_m >= config.lowest_storey_m && storey_m <= config.highest_storey_m ? 1 : 0);
  };
  BuildingSizes room = config.building;
  room.shortest_m = config.shortest_room_m;
  std::vector<MeshUnit> fitting;
  if (sizes.maxCoeff() <= config.building.largest_m) fitting.push_back(metre);
  for (const MeshUnit& unit : other_units)
    if (config.building.hold(sizes * unit.metres) || (room.hold(sizes * unit.metres) && rank(unit) % 2 == 1))
      fitting.push_back(unit);
  const auto less = [&](const MeshUnit& a, const MeshUnit& b) {
    const auto off = [&](const MeshUnit& u) { return std::abs(std::log(storey * u.metres / config.usual_storey_m)); };
    return rank(a) != rank(b) ? rank(a) > rank(b) : off(a) < off(b);
  };
  std::stable_sort(fitting.begin(), fitting.end(), less);
  Choice choice;
  if (fitting.empty()) return choice;
  choice.unit = fitting.front();
  const int best = rank(fitting.front());
  const auto rivals = [&](const MeshUnit& other) { return best == 3 ? rank(other) == 3 : rank(other) > 0; };
  choice.sure = best > 0 && std::none_of(fitting.begin() + 1, fitting.end(), rivals);
  for (std::size_t i = 1; i < fitting.size() && !choice.sure; ++i)
    choice.others += (choice.others.empty() ? "" : " or ") + std::string(fitting[i].name);
  return choice;
}

}  // namespace

std::vector<Warning> settle_axes(std::vector<MeshPart>& parts, const std::string& path, const MeshAxesConfig& config) {
  std::vector<Warning> warnings;
  const Eigen::AlignedBox3d box = box_of(parts);
  if (box.isEmpty()) return warnings;
  Eigen::Vector3d sizes = box.sizes();
  if (!says_its_axes(path) && has_y_up(parts, sizes, config)) {
    change_points(parts, [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), -p.z(), p.y()); });
    sizes = Eigen::Vector3d(sizes.x(), sizes.z(), sizes.y());
    warnings.push_back({"", "assumed_up",
                        "the file does not say which axis is up; by its extent and its floors it is y, and the mesh "
                        "is turned to z up"});
  }
  double metres = 1.0;
  const bool large = sizes.maxCoeff() > config.building.largest_m;
  if (large || sizes.z() > config.building.highest_m) {
    const Choice choice = choose_unit(parts, sizes, config);
    if (!choice.unit)
      throw InputError({path, 0, 0}, "larger than " + format_number(config.building.largest_m) +
                                         " m; the unit of a mesh is the metre, and it is no building in millimetres, "
                                         "centimetres, inches or feet either");
    metres = choice.unit->metres;
    const bool stays = metres == metre.metres;
    if (!stays) change_points(parts, [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(p * metres); });
    const std::string size = format_number(std::round(large ? sizes.maxCoeff() : sizes.z())) +
                             (large ? " m large" : " m high") + " if its unit is the metre";
    const std::string others =
        choice.others.empty() ? "" : "; in the unit " + choice.others + " it would be a building as well";
    if (!stays)
      warnings.push_back(
          {"", "assumed_unit",
           "it is " + size + "; it is taken as drawn in the unit " + std::string(choice.unit->name) + others});
    else if (!choice.sure)
      warnings.push_back({"", "assumed_unit", "it is " + size + ", as is taken" + others});
  }
  if (std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff()) * metres > config.furthest_m)
    throw InputError({path, 0, 0}, "lies further than 100 km from its origin; move it there");
  return warnings;
}

}  // namespace plumbline::bim
