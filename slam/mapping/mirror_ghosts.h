// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "bim/config/visit.h"
#include "slam/io/estimate.h"
#include "slam/scan/map_cloud.h"

namespace plumbline::slam {

struct MirrorGhostConfig {
  bool remove = true;
  double behind_m = 0.3;
  double above_m = 0.5;
  double corner_m = 0.6;
  double pane_depth_m = 0.25;
  double cell_m = 0.2;
  double level_m = 0.15;
  double wall_m = 0.06;
  double sill_m = 0.15;
  double least_sill_m = 0.5;
  double under_sill = 0.1;
  double share = 0.3;
  double whole = 0.8;
  int solid_hits = 5;
  int min_points = 20;

  template <class V>
  void visit(V& v) {
    v("remove", remove, Field{.doc = "remove mirror images behind panes from the map", .basic = true});
    v("behind_m", behind_m,
      Field{.doc = "distance behind a wall from which a point was seen through it: panes stand back from the face",
            .min = 0});
    v("above_m", above_m, Field{.doc = "height by which a wall extends above and below its observed part", .min = 0});
    v("corner_m", corner_m, Field{.doc = "largest gap to a corner to which a wall extends", .min = 0});
    v("pane_depth_m", pane_depth_m,
      Field{.doc = "largest depth of a pane behind the face it is set in", .min = 0, .max = 2});
    v("cell_m", cell_m,
      Field{.doc = "cell size of the grids of openings in a wall and of directly seen space", .min = 0.05});
    v("level_m", level_m,
      Field{.doc = "distance to a floor or ceiling within which points do not vote: a floor's mirror image is a floor",
            .min = 0});
    v("wall_m", wall_m, Field{.doc = "largest distance of a mirror image from the wall it shows", .min = 0.01});
    v("sill_m", sill_m, Field{.doc = "height above the floor below which an opening's sill makes it a door", .min = 0});
    v("least_sill_m", least_sill_m,
      Field{.doc = "least sill of a window, under which outlier points pass", .min = 0.2, .max = 1.2});
    // Of those just above it; the same share of all below it.
    v("under_sill", under_sill, share_field("largest share of a window's points that pass just below its sill"));
    v("share", share,
      share_field("share of mirror images among the points seen through an opening that makes it a mirror"));
    v("whole", whole, share_field("the same share of all points, where only side walls, floor and ceiling are seen"));
    v("solid_hits", solid_hits,
      Field{.doc = "returns from a wall's cell from which on nothing is seen through it", .min = 1});
    v("min_points", min_points,
      Field{.doc = "least number of points seen through an opening that is tested", .min = 1});
  }
};

/// Takes mirror images out of the clouds, by what the sensor saw alone. Points whose ray crossed a mapped wall were
/// seen through an opening: a door, or a pane that transmits beams and mirrors the room in front of it. An opening
/// above a sill is a mirror when what was seen through it was mostly never seen directly, and enough of it lies,
/// mirrored at one and the same depth, on walls that face the opening; or, as at the end of a corridor, when only side
/// walls, floor and ceiling were seen through it, and most of that stands here too, mirrored. All that was seen through
/// a mirror only goes. Openings down to the floor are taken for doors: a room like this one may lie behind. walls:
/// faces in F, normals into free space; levels: floors (normal up) and ceilings in F. Returns how many points were
/// removed.
std::size_t remove_mirror_ghosts(std::vector<CloudKeyframe>& clouds, std::span<const PlaneNode> walls,
                                 std::span<const Plane> levels, const Eigen::Vector3d& sensor_R,
                                 const MirrorGhostConfig& config);

}  // namespace plumbline::slam
