// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "scenarios/report/report.h"

namespace plumbline::scenarios {

/// What a map shows of the plane, m.
struct MapBox {
  Eigen::Vector2d min = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d max = Eigen::Vector2d::Constant(-1e9);
  void add(const Eigen::Vector2d& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
};

/// Of all storeys shown, so that their maps lie over each other.
[[nodiscard]] MapBox bounds(const ReportInput& input);
/// Start tag of a map.
[[nodiscard]] std::string open_map(const MapBox& box, const std::string& label);
/// Where the name of a room stands: the highest line in it that is nearly as wide as any, in the upper left corner of a
/// rectangle, away from most paths.
struct RoomNamePlace {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  double width_m = 0.0;  ///< free from there
};
[[nodiscard]] RoomNamePlace room_name_place(const Polygon2& polygon);
/// Names of the storey's rooms; the script of the page leaves out those without space.
[[nodiscard]] std::string room_names(const ReportInput& input, int storey);
/// A stretch of whole metres with its length, in the lower left corner.
[[nodiscard]] std::string draw_scale(const MapBox& box);
/// Rooms and walls of a storey.
[[nodiscard]] std::string draw_plan(const ReportInput& input, int storey);
/// A map of every storey with the parts of the paths on it, and what was found there.
[[nodiscard]] std::string draw_maps(const ReportInput& input, const MapBox& box);
/// What the lines of a map mean.
[[nodiscard]] std::string map_key(const ReportInput& input);

/// The row that checks the scorer; it would lie under everything it is compared with.
[[nodiscard]] bool is_truth(const ReportMethod& method);

}  // namespace plumbline::scenarios
