// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/model/building.h"
#include "bim/model/rooms.h"

namespace plumbline::bim {

/// Fills Room::virtual_edges of every room: the stretches of its outline where no wall stands at walking height, longer
/// than overlap_m. Where another room of the same height lies beyond (its outline within virtual_gap_m, or within
/// 1 m in front of the edge's middle with nothing between) the edge names it. What stands in the way besides walls
/// (columns, curtain walls) closes an edge too.
void find_virtual_edges(Building& building, const AdjacencyConfig& config = {});

/// Fills Stair::rooms of every stair that names none: the rooms at the foot of its first flight and at the head of its
/// last.
void find_stair_rooms(Building& building, const AdjacencyConfig& config = {});

}  // namespace plumbline::bim
