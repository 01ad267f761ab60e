// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/formats/mesh/mesh_file.h"
#include "bim/model/building_sizes.h"
#include "bim/model/warning.h"

namespace plumbline::bim {

/// When a mesh is taken as drawn in another unit than metres, or with y up.
struct MeshAxesConfig {
  BuildingSizes building;          ///< larger or higher than these: another unit, in which they hold
  double furthest_m = 1e5;         ///< coordinates beyond this are refused
  double level = 0.98;             ///< component of a normal from which on a face lies across an axis
  double most_height_share = 0.7;  ///< with y up its extent along y is at most this share of the others
  double least_area_ratio = 1.5;   ///< and this many times more of its faces lie across y than across z
  double shortest_room_m = 2.0;    ///< a mesh whose storeys are of usual height may be this short
  double lowest_storey_m = 2.2, highest_storey_m = 6.0, usual_storey_m = 3.0;
  double thinnest_wall_m = 0.05, thickest_wall_m = 0.6;
  double least_floor_share = 0.3;  ///< of the area of the largest floor, from which on a level is a floor
  double least_wall_share = 0.02;  ///< of the faces across an axis, from which on one is of a wall
  // Which axis is up (all assumed):
  double least_ground_share = 0.5;  ///< of the largest floor's area that the lowest has
  double least_cover = 0.95;        ///< share of the plan that floors cover from which on an axis may be up,
  double better_cover = 0.02;       ///< and so much more than with z up
  double side_share = 0.15;         ///< of an extent, within which faces close that side
  double open_share = 0.25;         ///< a side with less of it covered is open
};

/// Turns the parts to z up and scales them to metres, in place. Y counts as up in formats that say nothing of it and
/// where extents and faces both speak for it, unless that leaves a side of the mesh open or its storeys too low. A mesh
/// too large or too high for metres is in the unit of millimetres, centimetres, inches and feet that makes it a
/// building; of several in that whose walls and storeys are usual ones. So is one whose walls and storeys are both too
/// large for metres and usual in another unit.
/// Returns what was assumed; throws InputError when it is too large and no unit fits.
std::vector<Warning> settle_axes(std::vector<MeshPart>& parts, const std::string& path,
                                 const MeshAxesConfig& config = {});

}  // namespace plumbline::bim
