// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "bim/model/building.h"
#include "sim/route/route.h"

namespace plumbline::sim {

/// By what would clear it: opening the door; moving furniture; building otherwise.
enum class BlockageKind { closed_door, furniture, structure };

/// Something that keeps the robot from going on.
struct Blockage {
  BlockageKind kind = BlockageKind::structure;
  std::string element;  ///< its name: "door 'd1'", "wall 'w3'"; empty where the floor ends
  std::string text;     ///< a clause, with numbers: "door 'd1' leaves 0.62 m free, and the robot needs 0.7 m"
  Eigen::Vector2d at_W = Eigen::Vector2d::Zero();
  bool operator==(const Blockage&) const = default;
};

/// What stops the robot on the way that takes least to clear, from the floor it can reach to places that it cannot:
/// through a gap before through a door that is closed, through that before through furniture, through that before
/// over the end of the floor, and only then through walls.
class Blockages {
 public:
  /// From `start_W` on one storey; the building and the map must outlive it.
  Blockages(const bim::Building& as_built, int storey, const ClearanceMap& space, const Eigen::Vector2d& start_W);
  ~Blockages();
  Blockages(const Blockages&) = delete;
  Blockages& operator=(const Blockages&) = delete;
  Blockages(Blockages&&) = delete;
  Blockages& operator=(Blockages&&) = delete;

  /// In the order of the way; none where nothing stops the robot.
  [[nodiscard]] std::vector<Blockage> before(const Eigen::Vector2d& goal_W) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline::sim
