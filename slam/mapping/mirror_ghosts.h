// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "bim/config/visit.h"
#include "slam/io/estimate.h"
#include "slam/scan/map_cloud.h"

namespace plumbline::slam {

struct ReflectionConfig {
  bool remove = true;
  double behind_m = 0.3;       ///< a point this far behind a wall was seen through it: panes stand back from the face
  double above_m = 0.5;        ///< a wall goes on this far above and below what was seen of it
  double corner_m = 0.6;       ///< a wall goes on to a corner that is this near to what was seen of it
  double pane_depth_m = 0.25;  ///< a pane stands at most this far behind the face it is set in
  double cell_m = 0.2;         ///< of openings in a wall and of what was seen directly
  double level_m = 0.15;  ///< points this near to a floor or ceiling say nothing: a mirror image of a floor is a floor
  double wall_m = 0.06;   ///< from an image to the wall it shows
  double sill_m = 0.15;   ///< an opening that reaches nearer to a floor is a door
  double least_sill_m = 0.5;  ///< of windows under which strays pass
  double under_sill = 0.1;    ///< of the points just above a sill pass just below it, at most, and of all below it
  double share = 0.3;         ///< of the points seen through an opening that must be mirror images
  double whole = 0.8;         ///< of all points, where side walls, floor and ceiling alone are seen
  int solid_hits = 5;         ///< of a wall's cell, from which nothing is seen through it
  int min_points = 20;        ///< seen through an opening, else it is left alone

  template <class V>
  void visit(V& v) {
    v("remove", remove, Field{.doc = "mirror images behind panes"});
    v("behind_m", behind_m, Field{.doc = "a point this far behind a wall was seen through it", .min = 0});
    v("above_m", above_m, Field{.doc = "a wall goes on above and below what was seen of it", .min = 0});
    v("corner_m", corner_m, Field{.doc = "a wall goes on to a corner this near to what was seen of it", .min = 0});
    v("pane_depth_m", pane_depth_m,
      Field{.doc = "of a pane behind the face it is set in, at most", .min = 0, .max = 2});
    v("cell_m", cell_m, Field{.doc = "of openings and of what was seen directly", .min = 0.05});
    v("level_m", level_m, Field{.doc = "points this near to a floor or ceiling do not vote", .min = 0});
    v("wall_m", wall_m, Field{.doc = "from an image to the wall it shows", .min = 0.01});
    v("sill_m", sill_m, Field{.doc = "an opening nearer to a floor is a door", .min = 0});
    v("least_sill_m", least_sill_m, Field{.doc = "of windows under which strays pass", .min = 0.2, .max = 1.2});
    v("under_sill", under_sill, Field{.doc = "of a window's points, that may pass under its sill", .min = 0, .max = 1});
    v("share", share, Field{.doc = "of mirror images that makes an opening a mirror", .min = 0, .max = 1});
    v("whole", whole, Field{.doc = "the same where only side walls, floor and ceiling are seen", .min = 0, .max = 1});
    v("solid_hits", solid_hits, Field{.doc = "of a wall's cell, from which nothing is seen through it", .min = 1});
    v("min_points", min_points, Field{.doc = "seen through an opening that is judged", .min = 1});
  }
};

/// Takes mirror images out of the clouds, by what the sensor saw alone. Points whose ray crossed a mapped wall were
/// seen through an opening: a door, or a pane that lets light through and mirrors the room before it. An opening above
/// a sill is a mirror when what was seen through it was mostly never seen directly, and enough of it lies, mirrored at
/// one and the same depth, on walls that face the opening; or, as at the end of a corridor, when only side walls, floor
/// and ceiling were seen through it, and most of that stands here too, mirrored. All that was seen through a mirror
/// only goes. Openings down to the floor are taken for doors: a room like this one may lie behind. walls: faces in F,
/// normals into free space; levels: floors (normal up) and ceilings in F. Returns how many points were removed.
std::size_t remove_reflections(std::vector<CloudKeyframe>& clouds, std::span<const PlaneNode> walls,
                               std::span<const Plane> levels, const Eigen::Vector3d& sensor_R,
                               const ReflectionConfig& config);

}  // namespace plumbline::slam
