// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bim/config/visit.h"

namespace plumbline::bim {

/// The one thing that tells the parts of an otherwise symmetric plan apart.
enum class FeatureKind { none, door_shift, wall_shift, niche, window, column, clutter };

}  // namespace plumbline::bim

namespace plumbline {

template <>
struct EnumNames<bim::FeatureKind> {
  static constexpr std::array<std::string_view, 7> names = {"none",   "door_shift", "wall_shift", "niche",
                                                            "window", "column",     "clutter"};
};

}  // namespace plumbline

namespace plumbline::bim {

/// Turn about a point of the plan that maps storey from[i] onto storey to[i].
struct PlanIsometryEntry {
  double angle_deg = 0.0;
  Eigen::Vector2d about = Eigen::Vector2d::Zero();
  std::vector<std::string> from, to;

  template <class V>
  void visit(V& v) {
    v("angle_deg", angle_deg,
      Field{.doc = "counter-clockwise, degrees", .min = -360.0, .max = 360.0, .required = true});
    v("about", about, Field{.doc = "point that stays where it is, m", .min = -1e4, .max = 1e4});
    v("from", from, Field{.doc = "storeys", .required = true});
    v("to", to, Field{.doc = "the storeys they are mapped onto, in the same order", .required = true});
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
    v("kind", kind, Field{.doc = "what distinguishes", .required = true});
    v("size_m", size_m, Field{.doc = "m", .min = 0.0, .max = 10.0, .required = true});
    v("element", element, Field{.doc = "id of the wall, opening, column or clutter"});
    v("storey", storey, Field{.doc = "where it is", .required = true});
    v("room", room, Field{.doc = "where it is"});
    v("at", at, Field{.doc = "m", .min = -1e4, .max = 1e4, .required = true});
    v("visible_from", visible_from, Field{.doc = "rooms from which it can be seen through open doors and glass"});
  }
};

/// What a plan says of its own symmetry, for tests and people; nothing is estimated or scored from it.
struct PlanSymmetryEntry {
  bool exact = true;  ///< false: the feature breaks the group
  std::vector<PlanIsometryEntry> group;
  std::vector<std::vector<std::string>> rooms_alike;
  std::optional<PlanFeatureEntry> feature;

  template <class V>
  void visit(V& v) {
    v("exact", exact, Field{.doc = "false: the feature breaks the group"});
    v("group", group, Field{.doc = "proper isometries without the identity"});
    v("rooms_alike", rooms_alike, Field{.doc = "lists of rooms that look alike from inside, but for the feature"});
    v("feature", feature, Field{.doc = "the one difference"});
  }
};

}  // namespace plumbline::bim
