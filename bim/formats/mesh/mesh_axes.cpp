// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/mesh/mesh_axes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "bim/config/tree.h"
#include "bim/errors.h"

namespace plumbline::bim {

namespace {

struct MeshUnit {
  std::string_view name;
  double metres;
};
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
  if (sizes.maxCoeff() > config.building.largest_m) {
    const auto fits = [&](const MeshUnit& unit) { return config.building.hold(sizes * unit.metres); };
    const auto* const unit = std::find_if(other_units.begin(), other_units.end(), fits);
    if (unit == other_units.end())
      throw InputError({path, 0, 0}, "larger than " + format_number(config.building.largest_m) +
                                         " m; the unit of a mesh is the metre, and it is no building in millimetres, "
                                         "centimetres, inches or feet either");
    metres = unit->metres;
    change_points(parts, [&](const Eigen::Vector3d& p) { return Eigen::Vector3d(p * metres); });
    warnings.push_back({"", "assumed_unit",
                        "it is " + format_number(std::round(sizes.maxCoeff())) +
                            " m large if its unit is the metre; it is taken "
                            "as drawn in the unit " +
                            std::string(unit->name)});
  }
  if (std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff()) * metres > config.furthest_m)
    throw InputError({path, 0, 0}, "lies further than 100 km from its origin; move it there");
  return warnings;
}

}  // namespace plumbline::bim
