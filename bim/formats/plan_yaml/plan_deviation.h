// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace plumbline::bim

namespace plumbline {

template <>
struct EnumNames<bim::DeviationOp> {
  static constexpr std::array<std::string_view, 9> names = {"move_wall",   "remove_wall",  "add_wall",
                                                            "tilt_wall",   "move_opening", "remove_opening",
                                                            "add_opening", "add_clutter",  "add_column"};
};

}  // namespace plumbline

namespace plumbline::bim {

/// One thing that was built otherwise than planned: the op decides which keys there are.
struct PlanDeviationEntry {
  DeviationOp op = DeviationOp::move_wall;
  std::string target;  ///< wall or opening it is done to
  Eigen::Vector2d by = Eigen::Vector2d::Zero();
  double by_m = 0.0;
  double deg = 0.0;
  PlanWallEntry wall;
  PlanOpeningEntry opening;
  PlanClutterEntry clutter;
  PlanColumnEntry column;

  template <class V>
  void visit(V& v) {
    v("op", op, Field{.doc = "what was done", .required = true});
    switch (op) {
      case DeviationOp::move_wall:
        v("wall", target, plan_reference);
        v("by", by, Field{.doc = "[dx, dy], m", .min = -plan_size_max_m, .max = plan_size_max_m, .required = true});
        break;
      case DeviationOp::remove_wall:
        v("wall", target, plan_reference);
        break;
      case DeviationOp::tilt_wall:
        v("wall", target, plan_reference);
        v("deg", deg, Field{.doc = "upper edge to the left of a to b", .min = -10.0, .max = 10.0, .required = true});
        break;
      case DeviationOp::move_opening:
        v("opening", target, plan_reference);
        v("by_m", by_m, Field{.doc = "towards b", .min = -plan_reach_m, .max = plan_reach_m, .required = true});
        break;
      case DeviationOp::remove_opening:
        v("opening", target, plan_reference);
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
