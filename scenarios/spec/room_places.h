// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/model/building.h"
#include "sim/route/multi_storey_planner.h"

namespace plumbline::scenarios {

/// Start points are written with four decimals, 0.1 mm, so that a resolved file reads well.
[[nodiscard]] Eigen::Vector2d rounded(const Eigen::Vector2d& p);

/// A room in a message: "'2cXV28' (Kitchen)", its id and, where that is another, its name.
[[nodiscard]] std::string quoted(const bim::Room& room);

/// The freest places of the rooms of a building, each looked for once.
class RoomPlaces {
 public:
  /// Both must outlive it. Where the floor of a room falls into pieces, those that can be reached `from` a point go
  /// before others. Those of the rooms `inside` lie as far inside these as they can.
  RoomPlaces(const bim::Building& as_built, const sim::MultiStoreyPlanner& space,
             const std::optional<sim::FloorPoint>& from = std::nullopt, std::vector<int> inside = {});

  /// Of the room with this index, if the robot can turn round in it.
  [[nodiscard]] const std::optional<sim::FloorPoint>& of(int room) const;

  /// Whether there is floor in it at the level of its storey. Gaps in floors are closed, so that a little of it along
  /// its walls counts in any case.
  [[nodiscard]] bool has_floor(int room) const;
  /// Why the robot has no place in a room, a clause; to be asked only where it has none.
  [[nodiscard]] std::string why_none(int room) const;
  /// Why it has none in the whole building, a clause: that of the largest room, and how many more there are.
  [[nodiscard]] std::string why_nowhere() const;

  /// A start for who names none: of the pieces of floor of a storey, each as large as the rooms that it joins, the
  /// largest, and there the largest room that the robot can turn round in (ties: the lower index); -1 where there is
  /// none. `rooms` of the storey are joined by that piece.
  struct Start {
    int room = -1;
    int rooms = 0;
  };
  [[nodiscard]] Start start_on(int storey) const;
  /// The lowest storey on which one can walk from one room to another; where there is none, the lowest with a room for
  /// the robot; -1 without.
  [[nodiscard]] int start_storey() const;

 private:
  const bim::Building& building_;
  const sim::MultiStoreyPlanner& space_;
  std::optional<sim::FloorPoint> from_;
  std::vector<int> inside_;
  mutable std::vector<std::optional<std::optional<sim::FloorPoint>>> places_;
};

}  // namespace plumbline::scenarios
