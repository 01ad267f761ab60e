// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "bim/rays/face.h"

namespace plumbline::bim {

/// Another face that comes so close to a face that a ray may hit both within the tie distance.
struct CoplanarFace {
  Eigen::AlignedBox3d region_W;  ///< holds every point of the first face that is that close to the other
  int face = -1;                 ///< the other face
};

/// Coplanar neighbours of one face in the cells of a grid over the two axes it is flattest along.
class CoplanarGrid {
 public:
  /// Some cells a face; fewer where faces are so large that each would fill many.
  CoplanarGrid(std::span<const CoplanarFace> coplanar_faces, const Eigen::Vector3d& normal);
  /// Indices of the faces whose region may hold p_W.
  [[nodiscard]] std::span<const std::uint32_t> at(const Eigen::Vector3d& p_W) const {
    const auto c = static_cast<std::size_t>(cell(1, p_W[axis_[1]]) * cells_[0] + cell(0, p_W[axis_[0]]));
    return std::span(indices_).subspan(begin_[c], begin_[c + 1] - begin_[c]);
  }

 private:
  void divide(double side);
  [[nodiscard]] int cell(int k, double x) const {
    const double c = (x - low_[k]) * per_m_[k];
    return c > 0.0 ? (c < cells_[k] ? static_cast<int>(c) : cells_[k] - 1) : 0;
  }
  [[nodiscard]] std::size_t cells_of(const CoplanarFace& neighbour) const;
  template <class Visit>
  void for_each_cell(const CoplanarFace& neighbour, Visit&& visit) const;

  int axis_[2] = {0, 1};
  double low_[2] = {0.0, 0.0}, size_[2] = {0.0, 0.0}, per_m_[2] = {0.0, 0.0};
  int cells_[2] = {1, 1};
  std::vector<std::uint32_t> begin_, indices_;
};

/// Nearly coplanar neighbours of every face: `inside` those that reach into it (overlapping coplanar faces, crossing
/// walls), `border` those that touch it in its edge band only (neighbours over an edge). Found once when a scene is
/// built, so that only marked faces pay for ties. A face with many (a floor full of furniture) looks them up by
/// position.
class CoplanarTable {
 public:
  CoplanarTable() = default;
  CoplanarTable(std::span<const Face> faces, const RayTolerances& tolerances);

  /// Both in order of the other face's index.
  [[nodiscard]] std::span<const CoplanarFace> inside(std::size_t face) const {
    return std::span(inside_).subspan(inside_begin_[face], inside_begin_[face + 1] - inside_begin_[face]);
  }
  [[nodiscard]] std::span<const int> border(std::size_t face) const {
    return std::span(border_).subspan(border_begin_[face], border_begin_[face + 1] - border_begin_[face]);
  }

  /// visit(int other) for each neighbour inside a face whose region holds p_W, in no particular order. Ends, and gives
  /// true, as soon as visit gives true.
  template <class Visit>
  bool any_at(std::size_t face, const Eigen::Vector3d& p_W, Visit&& visit) const {
    const std::span<const CoplanarFace> all = inside(face);
    if (all.size() <= grid_min) {
      for (const CoplanarFace& neighbour : all)
        if (neighbour.region_W.contains(p_W) && visit(neighbour.face)) return true;
      return false;
    }
    for (const std::uint32_t i : grids_[static_cast<std::size_t>(grid_[face])].at(p_W))
      if (all[i].region_W.contains(p_W) && visit(all[i].face)) return true;
    return false;
  }

 private:
  static constexpr std::size_t grid_min = 8;

  std::vector<std::size_t> inside_begin_, border_begin_;
  std::vector<CoplanarFace> inside_;
  std::vector<int> border_;
  std::vector<int> grid_;  ///< of each face into grids_, -1 none; empty where no face has one
  std::vector<CoplanarGrid> grids_;
};

}  // namespace plumbline::bim
