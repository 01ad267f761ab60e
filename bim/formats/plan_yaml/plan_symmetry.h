// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bim/config/visit.h"

namespace plumbline::bim {

/// The one feature that breaks the symmetry of a plan.
enum class FeatureKind { none, door_shift, wall_shift, niche, window, column, clutter };
[[nodiscard]] constexpr std::array<std::string_view, 7> names_of(FeatureKind) {
  return {"none", "door_shift", "wall_shift", "niche", "window", "column", "clutter"};
}

/// Turn about a point of the plan that maps storey from[i] onto storey to[i].
struct PlanIsometryEntry {
  double angle_deg = 0.0;
  Eigen::Vector2d about = Eigen::Vector2d::Zero();
  std::vector<std::string> from, to;

  template <class V>
  void visit(V& v) {
    v("angle_deg", angle_deg,
      Field{.doc = "angle of rotation, counter-clockwise", .min = -360.0, .max = 360.0, .required = true});
    v("about", about, Field{.doc = "centre of rotation", .unit = "m", .min = -1e4, .max = 1e4});
    v("from", from, Field{.doc = "ids of the storeys that are mapped", .required = true});
    v("to", to, Field{.doc = "ids of the storeys they are mapped onto, in the same order", .required = true});
  }
};

struct PlanFeatureEntry {
  FeatureKind kind = FeatureKind::none;
  double size_m = 0.0;
  std::string element, storey, room;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  std::vector<std::string> visible_from;

  template <class V>
  void visit(V& v) {
    v("kind", kind, Field{.doc = "kind of the feature", .required = true});
    v("size_m", size_m, Field{.doc = "size of the feature", .min = 0.0, .max = 10.0, .required = true});
    v("element", element, Field{.doc = "id of the wall, opening, column or clutter that differs"});
    v("storey", storey, Field{.doc = "id of the storey with the feature", .required = true});
    v("room", room, Field{.doc = "id of the room with the feature"});
    v("at", at, Field{.doc = "position of the feature", .unit = "m", .min = -1e4, .max = 1e4, .required = true});
    v("visible_from", visible_from,
      Field{.doc = "ids of the rooms from which it can be seen through open doors and glass"});
  }
};

/// Declared symmetry of a plan, for tests and readers; nothing is estimated or scored from it.
struct PlanSymmetryEntry {
  bool exact = true;
  std::vector<PlanIsometryEntry> group;
  std::vector<std::vector<std::string>> rooms_alike;
  std::optional<PlanFeatureEntry> feature;

  template <class V>
  void visit(V& v) {
    v("exact", exact, Field{.doc = "whether the symmetry is exact; false: the feature breaks it"});
    v("group", group, Field{.doc = "proper isometries of the plan, without the identity"});
    v("rooms_alike", rooms_alike, Field{.doc = "lists of rooms that are the same from inside, except for the feature"});
    v("feature", feature, Field{.doc = "the one feature that breaks the symmetry"});
  }
};

}  // namespace plumbline::bim
