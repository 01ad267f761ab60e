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
  BuildingSizes building;          ///< larger than these: another unit, in which they hold, or refused
  double furthest_m = 1e5;         ///< coordinates beyond this are refused
  double level = 0.98;             ///< component of a normal from which on a face lies across an axis
  double most_height_share = 0.7;  ///< with y up its extent along y is at most this share of the others
  double least_area_ratio = 1.5;   ///< and this many times more of its faces lie across y than across z
};

/// Turns the parts to z up and scales them to metres, in place. Y counts as up in formats that say nothing of it and
/// where extents and faces both speak for it; a mesh too large for metres is in the first of millimetres, centimetres,
/// inches and feet that make it a building. Returns what was assumed; throws InputError when no unit fits.
std::vector<Warning> settle_axes(std::vector<MeshPart>& parts, const std::string& path,
                                 const MeshAxesConfig& config = {});

}  // namespace plumbline::bim
