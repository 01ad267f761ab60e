// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "bim/formats/plan_yaml/plan_entries.h"

namespace plumbline::bim {

/// Which way a stair goes on after its landing; back: beside the first flight, on its left or right.
enum class Turn { none, left, right, back_left, back_right };
[[nodiscard]] constexpr std::array<std::string_view, 5> names_of(Turn) {
  return {"none", "left", "right", "back_left", "back_right"};
}

struct PlanStairEntry {
  std::string id, from, to;
  Eigen::Vector2d start = Eigen::Vector2d::Zero();
  double yaw_deg = 0.0;
  double width_m = 1.0;
  double rise_m = 0.18;
  double run_m = 0.28;
  std::optional<int> landing_after;
  std::optional<double> landing_m;
  Turn turn = Turn::none;
  double gap_m = 0.1;
  std::string material;

  template <class V>
  void visit(V& v) {
    v("id", id, plan_id);
    v("from", from, Field{.doc = "id of the storey at the foot", .required = true});
    v("to", to, Field{.doc = "id of the storey at the head, above the other", .required = true});
    v("start", start,
      Field{.doc = "middle of the first step's lower front edge",
            .unit = "m",
            .min = -plan_reach_m,
            .max = plan_reach_m,
            .required = true});
    v("yaw_deg", yaw_deg, Field{.doc = "direction of ascent, counter-clockwise from x", .min = -360.0, .max = 360.0});
    v("width_m", width_m, Field{.doc = "width of the steps", .min = 0.5, .max = 10.0});
    v("rise_m", rise_m, Field{.doc = "greatest height of a step; all steps are equal", .min = 0.05, .max = 0.25});
    v("run_m", run_m, Field{.doc = "depth of a step", .min = 0.2, .max = 0.5});
    v("landing_after", landing_after,
      plain_field("number of steps below the landing; no landing when not given", {.min = 1, .max = 1000}));
    v("landing_m", landing_m,
      Field{.doc = "depth of the landing; the stair's width when not given", .min = 0.5, .max = 10.0});
    v("turn", turn,
      Field{.doc = "turn at the landing; back: the second flight runs beside the first, on its left or right"});
    v("gap_m", gap_m, Field{.doc = "gap between the two flights of a turn back", .min = 0.0, .max = 10.0});
    v("material", material, plan_material);
  }
};

}  // namespace plumbline::bim
