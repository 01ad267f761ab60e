// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "slam/rooms/cluster_walls.h"

namespace plumbline::slam {

/// Two faces of one side this near are one side: pillars, cupboards, leaves.
inline constexpr double same_line_m = 0.35;

/// True for faces that look the same way.
[[nodiscard]] bool parallel(const FaceLine& a, const FaceLine& b, const RoomConfig& config);

/// On which side of each line a point lies; bit k: the free side of line k.
using Sides = std::uint32_t;

/// A stretch of a line between two corners; what counts lies to the left.
struct Edge {
  std::size_t line = 0;  ///< its index
  Eigen::Vector2d from, to;
  [[nodiscard]] double length() const { return (to - from).norm(); }
};

/// A convex piece between the lines: its corners counter-clockwise, each with the line of the edge that it begins.
using Piece = std::vector<Edge>;

[[nodiscard]] double area_of(const Piece& piece);

/// The faces that carry most of the border, without those that run beside a better one, and four cuts where free space
/// ends. `more`: faces to take after those of the cluster, in their order.
[[nodiscard]] std::vector<FaceLine> lines_of(const ClusterWalls& cluster_walls, std::span<const FaceLine> more = {});

/// Lines part the plane into convex pieces; those that are mostly cells of one cluster.
class Arrangement {
 public:
  Arrangement(const ClusterWalls& cluster_walls, std::vector<FaceLine> lines);

  [[nodiscard]] const std::vector<FaceLine>& lines() const { return lines_; }
  [[nodiscard]] const std::map<Sides, Piece>& pieces() const { return pieces_; }
  /// Cells of the cluster in a piece.
  [[nodiscard]] std::size_t cells_in(Sides piece) const { return cells_.at(piece); }
  /// The piece a point lies in, which may be none that counts.
  [[nodiscard]] Sides piece_at(const Eigen::Vector2d& p) const;
  /// The piece behind an edge of a piece, which may be none that counts.
  [[nodiscard]] static Sides behind(Sides piece, const Edge& edge) { return piece ^ (Sides{1} << edge.line); }

  using Joins = std::function<bool(const Edge&)>;
  /// Pieces that hang together by edges that `joins` holds for, in the order of their lowest.
  [[nodiscard]] std::vector<std::vector<Sides>> components(const Joins& joins) const;
  [[nodiscard]] double area_of(std::span<const Sides> pieces) const;
  /// Drops all other pieces.
  void keep(std::span<const Sides> pieces);
  /// Closed chains of the edges between what counts and what does not, what counts to the left.
  [[nodiscard]] std::vector<Piece> borders() const;

  /// Calls visit(from, to, piece) for each stretch of a run's cells in one piece, by their indices in the cluster.
  using Visit = std::function<void(std::size_t, std::size_t, Sides)>;
  void for_each_stretch(const CellRun& run, const Visit& visit) const;

 private:
  [[nodiscard]] Piece piece_of(Sides sides) const;

  const ClusterWalls& cluster_walls_;
  std::vector<FaceLine> lines_;
  std::map<Sides, std::size_t> cells_;
  std::map<Sides, Piece> pieces_;
};

}  // namespace plumbline::slam
