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

/// Usual distance from one floor to the next or the roof along an axis that may be up, in the unit of the file.
double storey_height(const std::vector<MeshPart>& parts, double height, const MeshAxesConfig& config, int axis = 2) {
  constexpr double step_share = 1e-3;
  if (height <= 0.0) return height;
  const std::map<double, double> areas = layers(parts, axis, 1.0, step_share * height, config.level);
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

/// Share of the plan that the lowest large floor covers, with an axis up.
double ground_cover(const std::vector<MeshPart>& parts, const Eigen::Vector3d& sizes, int axis,
                    const MeshAxesConfig& config) {
  constexpr double step_share = 1e-3;
  const double plan = sizes[(axis + 1) % 3] * sizes[(axis + 2) % 3];
  if (!(sizes[axis] > 0.0) || !(plan > 0.0)) return 0.0;
  const std::map<double, double> areas = layers(parts, axis, 1.0, step_share * sizes[axis], config.level);
  double largest = 0.0;
  for (const auto& [at, area] : areas) largest = std::max(largest, area);
  const auto ground = std::find_if(areas.begin(), areas.end(), [&](const auto& layer) {
    return layer.second >= config.least_ground_share * largest;
  });
  return ground == areas.end() ? 0.0 : ground->second / plan;
}

/// Sides of the mesh, with an axis up, that hardly a face closes: a room may lack its ceiling, but not a wall.
int open_sides(const std::vector<MeshPart>& parts, const Eigen::AlignedBox3d& box, int up,
               const MeshAxesConfig& config) {
  int open = 0;
  const Eigen::Vector3d sizes = box.sizes();
  for (const int axis : {(up + 1) % 3, (up + 2) % 3}) {
    if (!(sizes[axis] > 0.0)) continue;
    const double side = sizes[(axis + 1) % 3] * sizes[(axis + 2) % 3];
    const double near = config.side_share * sizes[axis];
    double low = 0.0, high = 0.0;
    for (const double sign : {-1.0, 1.0})
      for (const auto& [at, area] : layers(parts, axis, sign, 1e-3 * sizes[axis], config.level)) {
        if (at <= box.min()[axis] + near) low += area;
        if (at >= box.max()[axis] - near) high += area;
      }
    open += (low < config.open_share * side ? 1 : 0) + (high < config.open_share * side ? 1 : 0);
  }
  return open;
}

/// Which axis is up, and what speaks against it.
struct UpAxis {
  bool is_y = false;
  bool sure = true;
};

/// Y is up where extents and floors both speak for it. A narrow building with z up has walls that look like floors with
/// y up: what closes its sides and how high its storeys are tell which it is.
UpAxis find_up(const std::vector<MeshPart>& parts, const Eigen::AlignedBox3d& box, const MeshAxesConfig& config) {
  const Eigen::Vector3d sizes = box.sizes();
  if (sizes.y() < config.building.lowest_m) return {};
  const Eigen::Vector3d areas = areas_across(parts, config.level);
  const auto lies = [&](int up, int other) {
    return sizes[up] <= config.most_height_share * std::min(sizes.x(), sizes[other]) &&
           areas[up] >= config.least_area_ratio * areas[other];
  };
  if (!lies(1, 2) && lies(2, 1)) return {};
  const auto is_usual = [&](double storey) {
    return storey >= config.lowest_storey_m && storey <= config.highest_storey_m;
  };
  const int open_y = open_sides(parts, box, 1, config), open_z = open_sides(parts, box, 2, config);
  if (lies(1, 2)) {
    const bool z_may_be = is_usual(storey_height(parts, sizes.z(), config));
    const bool y_is_odd = open_y > open_z || storey_height(parts, sizes.y(), config, 1) < config.lowest_storey_m;
    return z_may_be && y_is_odd ? UpAxis{false, false} : UpAxis{true, true};
  }
  const double cover_y = ground_cover(parts, sizes, 1, config), cover_z = ground_cover(parts, sizes, 2, config);
  const bool y_may_be = open_y <= open_z && cover_y >= config.least_cover && cover_y >= cover_z + config.better_cover;
  // A room without ceiling is commoner than one without a wall.
  const bool is_y = y_may_be && open_y < open_z && is_usual(storey_height(parts, sizes.y(), config, 1));
  return {is_y, is_y || !y_may_be};
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

/// In the unit of the file.
struct Measures {
  double storey = 0.0;
  std::optional<double> wall;
};

struct Choice {
  std::optional<MeshUnit> unit;
  bool sure = false;   ///< no other has usual walls and storeys as well
  bool usual = false;  ///< its own are
  std::string others;
};

/// Of the units in which the mesh is a building the one whose walls and storeys are usual; walls go before storeys,
/// since halls are high.
Choice choose_unit(const Eigen::Vector3d& sizes, const Measures& measures, const MeshAxesConfig& config) {
  const double storey = measures.storey, wall = measures.wall.value_or(0.0);
  const auto rank = [&](const MeshUnit& unit) {
    const double storey_m = storey * unit.metres, wall_m = wall * unit.metres;
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
  choice.usual = best == 3;
  const auto rivals = [&](const MeshUnit& other) { return best == 3 ? rank(other) == 3 : rank(other) > 0; };
  choice.sure = best > 0 && std::none_of(fitting.begin() + 1, fitting.end(), rivals);
  for (std::size_t i = 1; i < fitting.size() && !choice.sure; ++i)
    choice.others += (choice.others.empty() ? "" : " or ") + std::string(fitting[i].name);
  return choice;
}

/// Scales the parts to metres where they are not in metres; returns the unit, m.
double settle_unit(std::vector<MeshPart>& parts, const Eigen::Vector3d& sizes, const std::string& path,
                   const MeshAxesConfig& config, std::vector<Warning>& warnings) {
  const bool large = sizes.maxCoeff() > config.building.largest_m;
  const bool out_of_size = large || sizes.z() > config.building.highest_m;
  const double storey = storey_height(parts, sizes.z(), config);
  if (!out_of_size && storey <= config.highest_storey_m) return metre.metres;
  const Measures measures{storey, wall_thickness(parts, sizes.maxCoeff(), config)};
  if (!out_of_size && measures.wall.value_or(0.0) <= config.thickest_wall_m) return metre.metres;
  const Choice choice = choose_unit(sizes, measures, config);
  if (out_of_size && !choice.unit)
    throw InputError({path, 0, 0}, "larger than " + format_number(config.building.largest_m) +
                                       " m; the unit of a mesh is the metre, and it is no building in millimetres, "
                                       "centimetres, inches or feet either");
  // A hall of thick walls stays in metres, unless it would be a usual house in another unit.
  if (!out_of_size && !choice.usual) return metre.metres;
  const double metres = choice.unit->metres;
  const bool stays = metres == metre.metres;
  if (!stays) change_points(parts, [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(p * metres); });
  const auto rounded = [](double v) { return format_number(std::round(10.0 * v) / 10.0); };
  const std::string size = (out_of_size ? "it is " + format_number(std::round(large ? sizes.maxCoeff() : sizes.z())) +
                                              (large ? " m large" : " m high")
                                        : "its storeys are " + rounded(measures.storey) + " m high and its walls " +
                                              rounded(measures.wall.value_or(0.0)) + " m thick") +
                           " if its unit is the metre";
  const std::string others =
      choice.others.empty() ? "" : "; in the unit " + choice.others + " it would be a building as well";
  if (!stays)
    warnings.push_back(
        {"", "assumed_unit", size + "; it is taken as drawn in the unit " + std::string(choice.unit->name) + others});
  else if (!choice.sure)
    warnings.push_back({"", "assumed_unit", size + ", as is taken" + others});
  return metres;
}

}  // namespace

std::vector<Warning> settle_axes(std::vector<MeshPart>& parts, const std::string& path, const MeshAxesConfig& config) {
  std::vector<Warning> warnings;
  const Eigen::AlignedBox3d box = box_of(parts);
  if (box.isEmpty()) return warnings;
  Eigen::Vector3d sizes = box.sizes();
  if (const UpAxis up = says_its_axes(path) ? UpAxis{} : find_up(parts, box, config); up.is_y) {
    change_points(parts, [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), -p.z(), p.y()); });
    sizes = Eigen::Vector3d(sizes.x(), sizes.z(), sizes.y());
    warnings.push_back({"", "assumed_up",
                        "the file does not say which axis is up; by its extent and its floors it is y, and the mesh "
                        "is turned to z up"});
  } else if (!up.sure) {
    warnings.push_back({"", "assumed_up",
                        "the file does not say which axis is up; z is taken, though with y up it would be a building "
                        "as well"});
  }
  const double metres = settle_unit(parts, sizes, path, config, warnings);
  if (std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff()) * metres > config.furthest_m)
    throw InputError({path, 0, 0}, "lies further than 100 km from its origin; move it there");
  return warnings;
}

}  // namespace plumbline::bim
