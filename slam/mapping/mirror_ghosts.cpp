// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/mirror_ghosts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "slam/mapping/wall_faces.h"
#include "slam/scan/voxel.h"

namespace plumbline::slam {

namespace {

/// Where a ray went through a face.
struct Crossing {
  int face = -1;
  double share = 1.0;  ///< of the ray's length, from the sensor
  int s_cell = 0, z_cell = 0;
  Eigen::Vector3d q_F = Eigen::Vector3d::Zero();
};

/// A point that was seen through a face.
struct PenetratingPoint {
  std::size_t cloud = 0, point = 0;
  Eigen::Vector3d p_F;
  Crossing crossing;
};

class MirrorGhostFilter {
 public:
  MirrorGhostFilter(std::vector<CloudKeyframe>& clouds, std::span<const PlaneNode> walls, std::span<const Plane> levels,
                    const MirrorGhostConfig& config)
      : clouds_(clouds), faces_(wall_faces(walls, config)), levels_(levels), config_(config) {}

  std::size_t run(const Eigen::Vector3d& sensor_R) {
    const FacesNear near(faces_, config_.wall_m);
    for (const CloudKeyframe& cloud : clouds_) mark_solid(cloud, near);
    std::vector<std::vector<bool>> removed;
    for (std::size_t c = 0; c < clouds_.size(); ++c) {
      removed.emplace_back(clouds_[c].points_R.size(), false);
      classify_points(c, sensor_R, removed.back());
    }
    for (std::size_t c = 0; c < clouds_.size(); ++c) restore_seen(clouds_[c], removed[c]);
    for (const std::vector<std::size_t>& opening : openings()) {
      if (!is_mirror(opening)) continue;
      for (const std::size_t k : opening) {
        const PenetratingPoint& t = penetrating_[k];
        if (seen_directly(t.p_F)) continue;
        removed[t.cloud][t.point] = true;
      }
    }
    std::size_t count = 0;
    for (std::size_t c = 0; c < clouds_.size(); ++c) count += erase(clouds_[c], removed[c]);
    return count;
  }

 private:
  /// Counts the points on each cell of each face; not those of floors and ceilings, which lie in doors too.
  void mark_solid(const CloudKeyframe& cloud, const FacesNear& near) {
    for (const Eigen::Vector3f& p_R : cloud.points_R) {
      const Eigen::Vector3d p = cloud.X_FR * p_R.cast<double>();
      for (const std::uint32_t f : near.of(p)) {
        const WallFace& face = faces_[f];
        if (std::abs(face.plane.distance(p)) > config_.wall_m) continue;
        const double s = face.along.dot(p.head<2>());
        if (s < face.s0 || s > face.s1 || near_level(p)) continue;
        const auto slot = static_cast<std::size_t>(solid_.insert(cell_of(f, p)));
        if (slot >= hits_.size()) hits_.resize(slot + 1, 0);
        ++hits_[slot];
      }
    }
  }

  /// A face's cell, as a voxel: along it, up, face.
  [[nodiscard]] VoxelKey cell_of(std::size_t face, const Eigen::Vector3d& q_F) const {
    const auto cell = [&](double x) { return static_cast<std::int32_t>(std::floor(x / config_.cell_m)); };
    return {cell(faces_[face].along.dot(q_F.head<2>())), cell(q_F.z()), static_cast<std::int32_t>(face)};
  }

  [[nodiscard]] bool has_hits(const VoxelKey& cell) const {
    const int slot = solid_.find(cell);
    return slot >= 0 && hits_[static_cast<std::size_t>(slot)] >= config_.solid_hits;
  }

  /// Nothing is seen through a wall: in its cell, and the two beside it, as next to a door it is one or the other; nor
  /// through its last bit before a corner, which something hides.
  [[nodiscard]] bool is_solid(std::size_t face, const Eigen::Vector3d& q_F) const {
    const double s = faces_[face].along.dot(q_F.head<2>());
    if (s < faces_[face].seen_s0 || s > faces_[face].seen_s1) return true;
    VoxelKey cell = cell_of(face, q_F);
    if (!has_hits(cell)) return false;
    --cell.x;
    if (!has_hits(cell)) return false;
    cell.x += 2;
    return has_hits(cell);
  }

  /// Classifies every point as seen directly or through a face; what is behind a wall's solid part is to be removed,
  /// but votes on the opening next to it.
  void classify_points(std::size_t c, const Eigen::Vector3d& sensor_R, std::vector<bool>& removed) {
    const CloudKeyframe& cloud = clouds_[c];
    const Eigen::Vector3d origin = cloud.X_FR * sensor_R;
    const FacesInView in_view(faces_, origin);
    for (std::size_t k = 0; k < cloud.points_R.size(); ++k) {
      const Eigen::Vector3d p = cloud.X_FR * cloud.points_R[k].cast<double>();
      bool behind_wall = false;
      const std::optional<Crossing> crossing = last_crossing(in_view, origin, p, behind_wall);
      removed[k] = behind_wall;
      if (crossing) penetrating_.push_back({c, k, p, *crossing});
      if (behind_wall) continue;
      const auto slot = static_cast<std::size_t>(seen_.insert(VoxelKey::of(p, config_.cell_m)));
      if (slot == direct_.size()) direct_.push_back(false);
      if (!crossing) direct_[slot] = true;
    }
  }

  /// What stands behind a door that was shut once was seen directly too.
  void restore_seen(const CloudKeyframe& cloud, std::vector<bool>& removed) const {
    for (std::size_t k = 0; k < removed.size(); ++k)
      if (removed[k] && seen_directly(cloud.X_FR * cloud.points_R[k].cast<double>())) removed[k] = false;
  }

  /// The last face that the ray crosses from its free side and far enough before its end (ties: lower index), and
  /// whether it crosses any where that is solid.
  [[nodiscard]] std::optional<Crossing> last_crossing(const FacesInView& in_view, const Eigen::Vector3d& origin,
                                                      const Eigen::Vector3d& p, bool& behind_wall) const {
    std::optional<Crossing> last;
    for (const auto& [f, from] : in_view.towards(p)) {
      const WallFace& face = faces_[f];
      const double to = face.plane.distance(p);
      if (to > -config_.behind_m) continue;
      const double share = from / (from - to);
      const Eigen::Vector3d q = origin + share * (p - origin);
      const double s = face.along.dot(q.head<2>());
      if (s < face.s0 || s > face.s1) continue;
      if (q.z() < face.z0 - config_.above_m || q.z() > face.z1 + config_.above_m) continue;
      behind_wall |= is_solid(f, q);
      if (last && share <= last->share) continue;
      const VoxelKey cell = cell_of(f, q);
      last = Crossing{static_cast<int>(f), share, cell.x, cell.y, q};
    }
    return last;
  }

  using Key = std::tuple<int, int, int>;  ///< face, cell along it, cell up
  using Cells = std::map<Key, std::vector<std::size_t>>;

  /// Points seen through neighbouring cells of one face, in order of face and cell. Doors that the robot went through
  /// are left out.
  [[nodiscard]] std::vector<std::vector<std::size_t>> openings() const {
    Cells cells;
    for (std::size_t k = 0; k < penetrating_.size(); ++k) {
      const Crossing& x = penetrating_[k].crossing;
      cells[{x.face, x.s_cell, x.z_cell}].push_back(k);
    }
    drop_passages(cells);
    std::vector<std::vector<std::size_t>> result;
    while (!cells.empty()) {
      std::vector<Key> front = {cells.begin()->first};
      std::vector<std::size_t> points;
      while (!front.empty()) {
        const auto [face, s, z] = front.back();
        front.pop_back();
        const auto cell = cells.find({face, s, z});
        if (cell == cells.end()) continue;
        points.insert(points.end(), cell->second.begin(), cell->second.end());
        cells.erase(cell);
        for (int ds = -1; ds <= 1; ++ds)
          for (int dz = -1; dz <= 1; ++dz) front.emplace_back(face, s + ds, z + dz);
      }
      result.push_back(std::move(points));
    }
    return result;
  }

  /// Takes out the columns of a face through which mostly points were seen that were seen directly too: doors, and
  /// panes between rooms that the robot has entered both.
  void drop_passages(Cells& cells) const {
    std::map<std::pair<int, int>, std::pair<std::size_t, std::size_t>> columns;  // of points: known, all
    for (const auto& [key, points] : cells) {
      auto& [known, all] = columns[{std::get<0>(key), std::get<1>(key)}];
      all += points.size();
      known += static_cast<std::size_t>(std::count_if(
          points.begin(), points.end(), [&](std::size_t k) { return seen_directly(penetrating_[k].p_F); }));
    }
    std::erase_if(cells, [&](const auto& cell) {
      const auto& [known, all] = columns[{std::get<0>(cell.first), std::get<1>(cell.first)}];
      return 2 * known > all;
    });
  }

  /// All images of a mirror come from one depth of its pane.
  [[nodiscard]] bool is_mirror(const std::vector<std::size_t>& opening) const {
    if (opening.size() < static_cast<std::size_t>(config_.min_points) || reaches_floor(opening)) return false;
    std::vector<std::size_t> voters;
    for (const std::size_t k : opening)
      if (!near_level(penetrating_[k].p_F) && !on_side_wall(penetrating_[k])) voters.push_back(k);
    if (voters.size() < static_cast<std::size_t>(config_.min_points)) return is_fully_mirrored(opening);
    std::ptrdiff_t images = 0;
    for (double depth = 0.0; depth <= config_.pane_depth_m; depth += 0.5 * config_.wall_m)
      images = std::max(images, std::count_if(voters.begin(), voters.end(),
                                              [&](std::size_t k) { return is_image(penetrating_[k], depth); }));
    return images > 0 && static_cast<double>(images) >= config_.share * static_cast<double>(voters.size());
  }

  /// Everything seen through it has its mirror image here: a mirror, or a room that continues alike behind glass.
  [[nodiscard]] bool is_fully_mirrored(const std::vector<std::size_t>& opening) const {
    const auto here = std::count_if(opening.begin(), opening.end(),
                                    [&](std::size_t k) { return seen(image_of(penetrating_[k], 0.0)); });
    return static_cast<double>(here) >= config_.whole * static_cast<double>(opening.size());
  }

  /// It is then a door: what lies behind it exists even if the robot never entered.
  [[nodiscard]] bool reaches_floor(const std::vector<std::size_t>& opening) const {
    std::vector<double> heights;
    for (const std::size_t k : opening)
      if (const std::optional<double> height = above_floor(penetrating_[k].crossing.q_F)) heights.push_back(*height);
    const bool low = std::any_of(heights.begin(), heights.end(), [&](double h) { return h < config_.sill_m; });
    return low && !has_sill(heights);
  }

  /// Strays pass under windows, too, but far fewer than through them; of a door's points ever fewer pass lower down.
  [[nodiscard]] bool has_sill(const std::vector<double>& heights) const {
    constexpr double highest_m = 1.3, step_m = 0.1, row_m = 0.2;
    const auto between = [&](double from, double to) {
      return static_cast<double>(
          std::count_if(heights.begin(), heights.end(), [&](double h) { return h >= from && h < to; }));
    };
    for (double sill = config_.least_sill_m; sill < highest_m; sill += step_m)
      if (between(sill - row_m, sill) < config_.under_sill * between(sill, sill + row_m) &&
          between(0.0, sill) < config_.under_sill * static_cast<double>(heights.size()))
        return true;
    return false;
  }

  /// Over the highest floor that is not above it; a little below counts as on it.
  [[nodiscard]] std::optional<double> above_floor(const Eigen::Vector3d& q_F) const {
    std::optional<double> height;
    for (const Plane& level : levels_) {
      const double h = level.distance(q_F);
      if (level.n.z() > 0.0 && h > -config_.sill_m && (!height || h < *height)) height = h;
    }
    return height ? std::optional(std::max(*height, 0.0)) : std::nullopt;
  }

  [[nodiscard]] bool near_level(const Eigen::Vector3d& p_F) const {
    return std::any_of(levels_.begin(), levels_.end(),
                       [&](const Plane& level) { return std::abs(level.distance(p_F)) < config_.level_m; });
  }

  /// On a wall that runs through the face, whose image is itself.
  [[nodiscard]] bool on_side_wall(const PenetratingPoint& t) const {
    const Eigen::Vector3d& n = faces_[static_cast<std::size_t>(t.crossing.face)].plane.n;
    return std::any_of(faces_.begin(), faces_.end(), [&](const WallFace& face) {
      return std::abs(face.plane.n.dot(n)) < 0.5 && std::abs(face.plane.distance(t.p_F)) < config_.behind_m;
    });
  }

  [[nodiscard]] bool seen_directly(const Eigen::Vector3d& p_F) const {
    const int slot = seen_.find(VoxelKey::of(p_F, config_.cell_m));
    return slot >= 0 && direct_[static_cast<std::size_t>(slot)];
  }

  /// Directly or through any face: faces of furniture end nowhere in particular, and much is seen past them.
  [[nodiscard]] bool seen(const Eigen::Vector3d& p_F) const {
    return seen_.find(VoxelKey::of(p_F, config_.cell_m)) >= 0;
  }

  [[nodiscard]] Eigen::Vector3d image_of(const PenetratingPoint& t, double depth_m) const {
    const Plane& plane = faces_[static_cast<std::size_t>(t.crossing.face)].plane;
    return t.p_F - 2.0 * (plane.distance(t.p_F) + depth_m) * plane.n;
  }

  /// Does the point, mirrored by a pane that deep behind its face, lie on what was seen directly, or on a wall that
  /// faces the pane? Over a mirror the sensor sees such a wall higher up than it does directly.
  [[nodiscard]] bool is_image(const PenetratingPoint& t, double depth_m) const {
    const Plane& plane = faces_[static_cast<std::size_t>(t.crossing.face)].plane;
    const Eigen::Vector3d image_F = image_of(t, depth_m);
    if (seen(image_F)) return true;
    return std::any_of(faces_.begin(), faces_.end(), [&](const WallFace& face) {
      const double s = face.along.dot(image_F.head<2>());
      return face.plane.n.dot(plane.n) < -0.9 && std::abs(face.plane.distance(image_F)) < config_.wall_m &&
             s > face.s0 && s < face.s1;
    });
  }

  static std::size_t erase(CloudKeyframe& cloud, const std::vector<bool>& removed) {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < removed.size(); ++k) {
      if (removed[k]) continue;
      cloud.points_R[kept] = cloud.points_R[k];
      if (!cloud.lasers.empty()) cloud.lasers[kept] = cloud.lasers[k];
      ++kept;
    }
    cloud.points_R.resize(kept);
    if (!cloud.lasers.empty()) cloud.lasers.resize(kept);
    return removed.size() - kept;
  }

  std::vector<CloudKeyframe>& clouds_;
  const std::vector<WallFace> faces_;
  const std::span<const Plane> levels_;
  const MirrorGhostConfig& config_;
  VoxelIndex solid_;       ///< cells of faces that were hit
  std::vector<int> hits_;  ///< index = slot in solid_
  VoxelIndex seen_;
  std::vector<bool> direct_;  ///< index = slot in seen_
  std::vector<PenetratingPoint> penetrating_;
};

}  // namespace

std::size_t remove_mirror_ghosts(std::vector<CloudKeyframe>& clouds, std::span<const PlaneNode> walls,
                                 std::span<const Plane> levels, const Eigen::Vector3d& sensor_R,
                                 const MirrorGhostConfig& config) {
  if (!config.remove || walls.empty()) return 0;
  return MirrorGhostFilter(clouds, walls, levels, config).run(sensor_R);
}

}  // namespace plumbline::slam
