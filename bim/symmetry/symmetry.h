// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/model/building.h"
#include "bim/symmetry/isometry.h"

namespace plumbline::bim {

/// Thresholds of the analysis.
struct SymmetryConfig {
  double exact_m = 6e-3;        ///< deviations up to this are `exact`: the range noise of a VLP-16 at its best
  double near_m = 0.5;          ///< deviations up to this, together with iou_min: `near`
  double iou_min = 0.95;        ///< share of the volume in common, of what either holds
  double iou_thin_min = 0.8;    ///< of it where deviations are up to match_m: walls of 0.1 m that are 1 cm off
  double touch_m = 0.012;       ///< a gap this narrow is no gap: a beam is as wide
  double sliver_m = 1e-3;       ///< surfaces this narrow are rounding
  double sample_m = 0.1;        ///< spacing of the points at which a surface without counterpart is measured
  double sample_up_m = 0.5;     ///< ... and upwards
  double reach_m = 2.0;         ///< larger deviations count as this
  double shift_max_m = 1.0;     ///< how far a small difference moves the centre of a storey
  double direction = 2e-3;      ///< rad, surfaces this close run the same way
  double direction_max = 0.02;  ///< rad, and short ones up to this, as far as match_m at their ends turns them; assumed
  double match_m = 0.02;        ///< lengths and heights of two matching surfaces differ by this at most
  double direction_share = 0.8;  ///< share of the surface whose directions a turn must map onto each other
  double room_share = 0.95;      ///< of two similar rooms: smaller area over larger
  double through_m = 0.06;       ///< distance in front of a surface at which its room is looked up
  int deviations_max = 8;        ///< elements listed for one isometry
};

/// A difference between two images of a building: an element that has no counterpart within `size_m`.
struct Deviation {
  std::string element;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< place of the largest difference, in W
  double size_m = 0.0;  ///< distance to the nearest counterpart, no more than the element's own size in plan
};

enum class SimilarityGrade { exact, near, different };

/// How well an image covers its counterpart.
struct Similarity {
  SimilarityGrade grade = SimilarityGrade::different;
  double iou = 0.0;                   ///< volume in common over volume of both
  double deviation_m = 0.0;           ///< largest of the deviations, which is how far the two surfaces are apart
  std::vector<Deviation> deviations;  ///< above exact_m, the largest first
};

/// An isometry that maps storey `from` onto storey `to` as a LiDAR sees them.
struct StoreySymmetry {
  int from = -1;
  int to = -1;
  Isometry2 isometry;
  Similarity similarity;
};

/// An isometry of the plane under which every habitable storey maps onto itself.
struct BuildingSymmetry {
  Isometry2 isometry;
  Similarity similarity;
};

struct SimilarRoom {
  int room = -1;          ///< into Building::rooms
  Isometry2 isometry;     ///< takes the first room of the class to this one
  Similarity similarity;  ///< of the surfaces around and in the room; iou is that of the outlines
};

/// Rooms of equal appearance from inside under proper isometries, the first under the identity.
struct RoomClass {
  std::vector<SimilarRoom> rooms;  ///< two or more, ascending
  std::vector<Isometry2> turns;    ///< exact proper isometries of the first room onto itself, without the identity
};

/// Symmetries of a building. A robot is a rigid body, so only proper isometries (rotations and translations)
/// confuse it; mirror images are listed apart.
struct SymmetryReport {
  std::vector<StoreySymmetry> storeys;      ///< proper, from == to, without the identity; by storey, then angle
  std::vector<StoreySymmetry> copies;       ///< proper, from < to, `from` the first storey of its kind
  std::vector<StoreySymmetry> reflections;  ///< mirror images, from == to
  std::vector<BuildingSymmetry> building;   ///< proper, without the identity
  std::vector<RoomClass> rooms;             ///< exact ones by their first room, then near ones
  std::vector<std::string> left_out;        ///< ids: bodies around most of a storey, of whose inside nothing is known
};

/// Symmetries of what stands in a building as planned: walls with their openings, columns, stairs, obstacles, edges of
/// openings in floors. Storeys that hold nothing, and foundations and roofs, have none.
[[nodiscard]] SymmetryReport analyse_symmetry(const Building& as_planned, const SymmetryConfig& config = {});

}  // namespace plumbline::bim
