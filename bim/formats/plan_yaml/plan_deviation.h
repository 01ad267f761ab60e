// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "bim/formats/plan_yaml/plan_entries.h"

namespace plumbline::bim {

enum class DeviationOp {
  move_wall,
  remove_wall,
  add_wall,
  tilt_wall,
  move_opening,
  remove_opening,
  add_opening,
  add_clutter,
  add_column
};
[[nodiscard]] constexpr std::array<std::string_view, 9> names_of(DeviationOp) {
  return {"move_wall",      "remove_wall", "add_wall",    "tilt_wall", "move_opening",
          "remove_opening", "add_opening", "add_clutter", "add_column"};
}

/// One deviation of the building from its plan: the op decides which keys there are.
struct PlanDeviationEntry {
  DeviationOp op = DeviationOp::move_wall;
  std::string target;
  Eigen::Vector2d by = Eigen::Vector2d::Zero();
  double by_m = 0.0;
  double deg = 0.0;
  PlanWallEntry wall;
  PlanOpeningEntry opening;
  PlanClutterEntry clutter;
  PlanColumnEntry column;

  template <class V>
  void visit(V& v) {
    v("op", op, Field{.doc = "kind of deviation", .required = true});
    switch (op) {
      case DeviationOp::move_wall:
        v("wall", target, Field{.doc = "id of the wall", .required = true});
        v("by", by,
          Field{.doc = "displacement [dx, dy] of the wall",
                .unit = "m",
                .min = -plan_size_max_m,
                .max = plan_size_max_m,
                .required = true});
        break;
      case DeviationOp::remove_wall:
        v("wall", target, Field{.doc = "id of the wall", .required = true});
        break;
      case DeviationOp::tilt_wall:
        v("wall", target, Field{.doc = "id of the wall", .required = true});
        v("deg", deg,
          Field{.doc = "tilt of the wall; positive: its upper edge moves to the left of a to b",
                .min = -10.0,
                .max = 10.0,
                .required = true});
        break;
      case DeviationOp::move_opening:
        v("opening", target, Field{.doc = "id of the opening", .required = true});
        v("by_m", by_m,
          Field{.doc = "displacement of the opening along its wall, towards b",
                .min = -plan_reach_m,
                .max = plan_reach_m,
                .required = true});
        break;
      case DeviationOp::remove_opening:
        v("opening", target, Field{.doc = "id of the opening", .required = true});
        break;
      case DeviationOp::add_wall:
        return wall.visit(v);
      case DeviationOp::add_opening:
        return opening.visit(v);
      case DeviationOp::add_clutter:
        return clutter.visit(v);
      case DeviationOp::add_column:
        return column.visit(v);
    }
  }
};

}  // namespace plumbline::bim
