// SPDX-License-Identifier: Apache-2.0
#include "slam/mapping/mirror_ghosts.h"

#include <gtest/gtest.h>

namespace plumbline::slam {
namespace {

/// A room of 6 x 4 x 2.6 m round the frame's origin corner, its floor at z = 0; the sensor stands at (3, 2, 0.7).
class MirrorGhosts : public testing::Test {
 protected:
  MirrorGhosts() {
    add_wall({1, 0}, {0, 0}, {0, 4});
    add_wall({-1, 0}, {6, 0}, {6, 4});
    add_wall({0, 1}, {0, 0}, {6, 0});
    add_wall({0, -1}, {0, 4}, {6, 4});
    cloud_.X_FR = Pose::from_xyz_yaw({3, 2, 0.5}, 0.7);
    for (double z = 0.1; z < 1.4; z += 0.05)  // as high as the sensor sees of its own room
      for (double s = 0.05; s < 6.0; s += 0.05) {
        look_at({s, 0, z});
        if (s < 0.3 || s > 3.9) look_at({s, 4, z});  // between, panes and doors
        if (s >= 4.0) continue;
        look_at({0, s, z});
        look_at({6, s, z});
      }
  }

  void add_wall(const Eigen::Vector2d& n, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    walls_.push_back({static_cast<int>(walls_.size()), Plane{{n.x(), n.y(), 0.0}, -n.dot(a)}, a, b, 0.0, 1.4, 9});
  }
  void look_at(const Eigen::Vector3d& p_F) { cloud_.points_R.push_back((cloud_.X_FR.inverse() * p_F).cast<float>()); }
  /// What a ray through (x, z) of the wall y = 4 brings back from `far`, a plane y = far_y.
  void look_through(double x0, double x1, double z0, double z1, double far_y) {
    const Eigen::Vector3d eye(3, 2, 0.7);
    for (double x = x0; x < x1; x += 0.03)
      for (double z = z0; z < z1; z += 0.03) {
        const Eigen::Vector3d q(x, 4, z);
        look_at(eye + (q - eye) * ((far_y - eye.y()) / (q.y() - eye.y())));
        ++through_;
      }
  }
  std::size_t remove(const MirrorGhostConfig& config = {}) {
    std::vector<CloudKeyframe> clouds = {cloud_};
    const std::vector<Plane> levels = {{Eigen::Vector3d::UnitZ(), 0.0}, {-Eigen::Vector3d::UnitZ(), 2.6}};
    const std::size_t removed = remove_mirror_ghosts(clouds, walls_, levels, {0, 0, 0.2}, config);
    EXPECT_EQ(clouds[0].points_R.size() + removed, cloud_.points_R.size());
    return removed;
  }

  std::vector<PlaneNode> walls_;
  CloudKeyframe cloud_;
  std::size_t through_ = 0;
};

TEST_F(MirrorGhosts, LeaveARoomWithoutPanesAlone) { EXPECT_EQ(remove(), 0U); }

// A pane at y = 4.15 shows the wall y = 0 at y = 8.3; where it is seen higher than directly, too.
TEST_F(MirrorGhosts, OfTheRoomBehindAPaneGo) {
  look_through(2.4, 3.6, 0.9, 1.25, 8.3);
  EXPECT_EQ(remove(), through_);
  MirrorGhostConfig off;
  off.remove = false;
  EXPECT_EQ(remove(off), 0U);
}

// The pane itself gives back a little, from which comes a small plane that leans.
TEST_F(MirrorGhosts, GoThoughThePaneIsAPlaneOfItsOwn) {
  look_through(2.4, 3.6, 0.9, 1.25, 8.3);
  add_wall({0, -1}, {2.4, 4.15}, {3.6, 4.15});
  walls_.back().observations = 3;
  walls_.back().plane_F.n = Eigen::Vector3d(0.0, -1.0, 0.05).normalized();
  walls_.back().plane_F.d = -walls_.back().plane_F.n.dot(Eigen::Vector3d(3.0, 4.15, 1.0));
  EXPECT_EQ(remove(), through_);
}

TEST_F(MirrorGhosts, AreNotWhatAPaneLetsThrough) {
  look_through(2.4, 3.6, 0.9, 1.25, 11.0);
  EXPECT_EQ(remove(), 0U);
}

// A room of the same depth may lie behind a door, and the robot need not have entered it.
TEST_F(MirrorGhosts, AreNotLookedForBehindDoors) {
  look_through(2.4, 3.4, 0.03, 1.25, 8.3);
  EXPECT_EQ(remove(), 0U);
}

// From afar the floor behind a door is seen by few rays only.
TEST_F(MirrorGhosts, AreNotLookedForBehindDoorsWhoseFloorIsHardlySeen) {
  look_through(2.4, 3.4, 0.5, 1.25, 8.3);
  look_through(2.4, 2.8, 0.3, 0.5, 8.3);
  look_through(2.4, 2.5, 0.03, 0.3, 8.3);
  EXPECT_EQ(remove(), 0U);
}

TEST_F(MirrorGhosts, AboveALowSillGo) {
  look_through(2.4, 3.6, 0.2, 1.25, 8.3);
  EXPECT_EQ(remove(), through_);
}

// Some points lie low behind the wall under a window; that makes it no door.
TEST_F(MirrorGhosts, GoThoughStraysPassUnderTheWindow) {
  look_through(2.4, 3.6, 0.9, 1.25, 8.3);
  const Eigen::Vector3d eye(3, 2, 0.7);
  for (double z = 0.1; z < 0.9; z += 0.15, ++through_) look_at(eye + 1.25 * (Eigen::Vector3d(2.5, 4, z) - eye));
  EXPECT_EQ(remove(), through_);
  MirrorGhostConfig config;
  config.under_sill = 0.0;
  EXPECT_EQ(remove(config), 0U);
}

TEST_F(MirrorGhosts, OfSideWallsAloneGoWhereTheyStandHereToo) {
  std::size_t seen = 0;
  for (double y = 4.4; y < 7.5; y += 0.05)
    for (double z = 0.4; z < 1.2; z += 0.05, ++seen) look_at({0, y, z});
  EXPECT_EQ(remove(), seen);
}

TEST_F(MirrorGhosts, AreNotSideWallsThatGoOnFartherThanHere) {
  for (double y = 8.5; y < 12.0; y += 0.05)
    for (double z = 0.4; z < 1.2; z += 0.05) look_at({0, y, z});
  EXPECT_EQ(remove(), 0U);
}

TEST_F(MirrorGhosts, AreNotWhatWasSeenDirectlyToo) {
  look_through(2.4, 3.6, 0.9, 1.25, 8.3);
  CloudKeyframe entered;
  entered.X_FR = Pose::from_xyz_yaw({3, 6, 0.5}, 0.0);
  for (const Eigen::Vector3f& p_R : cloud_.points_R) {
    const Eigen::Vector3d p_F = cloud_.X_FR * p_R.cast<double>();
    if (p_F.y() > 8.0) entered.points_R.push_back((entered.X_FR.inverse() * p_F).cast<float>());
  }
  std::vector<CloudKeyframe> clouds = {cloud_, entered};
  EXPECT_EQ(remove_mirror_ghosts(clouds, walls_, {}, {0, 0, 0.2}, {}), 0U);
}

// A polished box in the room shows what no plane of it holds; nothing is seen through the wall behind it all the same.
TEST_F(MirrorGhosts, BehindAWallsSolidPartGo) {
  std::size_t seen = 0;
  for (double y = 1.0; y < 3.0; y += 0.05)
    for (double z = 0.3; z < 1.2; z += 0.05, ++seen) look_at({7.0 + y, y, z});
  EXPECT_EQ(remove(), seen);
}

// What is seen through a door's edge crosses a cell that the wall is seen in too.
TEST_F(MirrorGhosts, AreNotWhatIsSeenPastADoorsEdge) {
  look_through(3.8, 4.0, 0.03, 1.25, 9.7);
  EXPECT_EQ(remove(), 0U);
}

// Of a wall that is glass from corner to corner little is seen.
TEST_F(MirrorGhosts, BesideTheSeenPartOfAWallGoUpToTheCorner) {
  walls_[3].p0.x() = 0.5;
  look_through(0.1, 3.6, 0.9, 1.25, 8.3);
  EXPECT_EQ(remove(), through_);
  MirrorGhostConfig config;
  config.corner_m = 0.0;
  EXPECT_LT(remove(config), through_);
}

TEST_F(MirrorGhosts, NeedWallsAndPoints) {
  std::vector<CloudKeyframe> clouds = {cloud_};
  EXPECT_EQ(remove_mirror_ghosts(clouds, {}, {}, {0, 0, 0.2}, {}), 0U);
  clouds.clear();
  EXPECT_EQ(remove_mirror_ghosts(clouds, walls_, {}, {0, 0, 0.2}, {}), 0U);
}

}  // namespace
}  // namespace plumbline::slam
