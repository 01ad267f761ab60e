// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/lego_loam/two_step.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>

#include "bim/geometry/symmetric.h"
#include "slam/loam/degeneracy.h"

namespace plumbline::slam::lego {

namespace {

using Rotations = std::array<Eigen::Matrix3d, 4>;  ///< R, and its derivatives by roll, pitch and yaw

Rotations rotations(const Eigen::Vector3d& rpy) {
  const auto turn = [](double angle, int axis, bool derivative) {
    const double c = std::cos(angle), s = std::sin(angle);
    Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    if (!derivative) R(axis, axis) = 1.0;
    R(a, a) = R(b, b) = derivative ? -s : c;
    R(a, b) = derivative ? -c : -s;
    R(b, a) = derivative ? c : s;
    return R;
  };
  Rotations result;
  for (int k = 0; k < 4; ++k)
    result[static_cast<std::size_t>(k)] = turn(rpy[2], 2, k == 3) * turn(rpy[1], 1, k == 2) * turn(rpy[0], 0, k == 1);
  return result;
}

/// A point tied to a line (along d) or a plane (across n) through an anchor.
struct Match {
  const ImagePoint* point = nullptr;
  Eigen::Vector3d anchor, direction;
};

class Former {
 public:
  Former(const std::vector<FormerPoint>& points, const TwoStepConfig& config) : points_(points), config_(config) {}

  /// The nearest point that is asked for, or none (ties: the first).
  template <class Wanted>
  [[nodiscard]] const FormerPoint* nearest(const Eigen::Vector3d& p, const Wanted& wanted) const {
    double best = config_.max_distance2_m2;
    const FormerPoint* found = nullptr;
    for (const FormerPoint& point : points_) {
      const double distance2 = (point.p - p).squaredNorm();
      if (distance2 >= best || !wanted(point)) continue;
      best = distance2;
      found = &point;
    }
    return found;
  }
  [[nodiscard]] const FormerPoint* nearest(const Eigen::Vector3d& p) const {
    return nearest(p, [](const FormerPoint&) { return true; });
  }
  [[nodiscard]] const FormerPoint* beside(const Eigen::Vector3d& p, const FormerPoint& a) const {
    return nearest(
        p, [&](const FormerPoint& b) { return b.row != a.row && std::abs(b.row - a.row) <= config_.max_rings; });
  }
  [[nodiscard]] const FormerPoint* same_row(const Eigen::Vector3d& p, const FormerPoint& a) const {
    return nearest(p, [&](const FormerPoint& b) { return b.row == a.row && &b != &a; });
  }

 private:
  const std::vector<FormerPoint>& points_;
  const TwoStepConfig& config_;
};

std::optional<Match> on_line(const ImagePoint& point, const Eigen::Vector3d& p, const Former& former) {
  const FormerPoint* a = former.nearest(p);
  const FormerPoint* b = a ? former.beside(p, *a) : nullptr;
  if (!b || (b->p - a->p).norm() < 1e-3) return std::nullopt;
  return Match{&point, a->p, (b->p - a->p).normalized()};
}

std::optional<Match> on_plane(const ImagePoint& point, const Eigen::Vector3d& p, const Former& former) {
  const FormerPoint* a = former.nearest(p);
  const FormerPoint* b = a ? former.same_row(p, *a) : nullptr;
  const FormerPoint* c = b ? former.beside(p, *a) : nullptr;
  if (!c) return std::nullopt;
  const Eigen::Vector3d n = (b->p - a->p).cross(c->p - a->p);
  if (n.norm() < 0.05 * (b->p - a->p).norm() * (c->p - a->p).norm() || n.norm() < 1e-6) return std::nullopt;
  return Match{&point, a->p, n.normalized()};
}

enum class Step { ground, edges };

/// One of the two steps.
class Solver {
 public:
  Solver(Step step, const std::vector<ImagePoint>& points, const std::vector<FormerPoint>& former,
         const TwoStepConfig& config)
      : step_(step),
        free_(step == Step::ground ? std::array<int, 3>{0, 1, 5} : std::array<int, 3>{2, 3, 4}),
        points_(points),
        former_(former, config),
        config_(config) {}

  /// False where there are too few matches: nothing moves.
  bool solve(Motion& motion) {
    Motion found = motion;
    for (int i = 0; i < config_.iterations; ++i) {
      if (i % config_.renewed_every == 0) match(found);
      if (matches_.size() < static_cast<std::size_t>(config_.least_matches)) return false;
      const std::optional<Eigen::Vector3d> step = gauss_newton(found, i);
      if (!step) return false;
      for (int k = 0; k < 3; ++k) value(found, free_[static_cast<std::size_t>(k)]) += (*step)[k];
      if (is_small(*step)) break;
    }
    motion = found;
    return true;
  }
  [[nodiscard]] int degenerate() const { return good_.degenerate; }

 private:
  static double& value(Motion& motion, int k) { return k < 3 ? motion.rpy[k] : motion.t[k - 3]; }

  void match(const Motion& motion) {
    matches_.clear();
    for (const ImagePoint& point : points_) {
      const Eigen::Vector3d p = motion.at(point.share) * point.p_R;
      const std::optional<Match> found =
          step_ == Step::ground ? on_plane(point, p, former_) : on_line(point, p, former_);
      if (found) matches_.push_back(*found);
    }
  }

  [[nodiscard]] std::optional<Eigen::Vector3d> gauss_newton(const Motion& motion, int iteration) {
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    int used = 0;
    // As in the reference, a point tells of the whole motion what it shows of its share.
    const Rotations whole = rotations(motion.rpy);
    for (const Match& match : matches_) {
      const double s = match.point->share;
      const Rotations R = rotations(s * motion.rpy);
      Eigen::Matrix3d across = match.direction * match.direction.transpose();
      if (step_ == Step::edges) across = Eigen::Matrix3d::Identity() - across;
      const Eigen::Vector3d off = across * (R[0] * match.point->p_R + s * motion.t - match.anchor);
      double weight = 1.0;
      if (iteration >= config_.renewed_every) {
        const double scale = step_ == Step::edges ? 1.0 : std::sqrt(match.point->range_m);
        weight = 1.0 - 1.8 * off.norm() / scale;
      }
      if (!(weight > 0.1)) continue;
      Eigen::Matrix3d J;
      for (int k = 0; k < 3; ++k) {
        const int variable = free_[static_cast<std::size_t>(k)];
        J.col(k) = variable < 3 ? Eigen::Vector3d(whole[static_cast<std::size_t>(variable) + 1] * match.point->p_R)
                                : Eigen::Vector3d::Unit(variable - 3);
      }
      H += weight * weight * J.transpose() * across * J;
      g += weight * weight * J.transpose() * off;
      ++used;
    }
    if (used < config_.least_matches) return std::nullopt;
    if (iteration == 0) good_ = loam::good_directions(H, config_.least_eigenvalue);
    const Eigen::Vector3d step = -solve_ldlt(Eigen::Matrix3d(H + 1e-12 * Eigen::Matrix3d::Identity()), g);
    if (!step.allFinite()) return std::nullopt;
    return Eigen::Vector3d(config_.step_share * (good_.projection * step));
  }

  [[nodiscard]] bool is_small(const Eigen::Vector3d& step) const {
    double angle2 = 0.0, way2 = 0.0;
    for (int k = 0; k < 3; ++k) (free_[static_cast<std::size_t>(k)] < 3 ? angle2 : way2) += step[k] * step[k];
    return std::sqrt(angle2) < 0.1 * std::numbers::pi / 180.0 && std::sqrt(way2) < 1e-3;
  }

  Step step_;
  std::array<int, 3> free_;  ///< of roll, pitch, yaw, x, y, z
  const std::vector<ImagePoint>& points_;
  Former former_;
  const TwoStepConfig& config_;
  std::vector<Match> matches_;
  loam::GoodDirections good_{Eigen::MatrixXd::Identity(3, 3), 0};
};

}  // namespace

Pose Motion::at(double share) const { return {Eigen::Quaterniond(rotations(share * rpy)[0]), share * t}; }

std::vector<FormerPoint> at_end(const std::vector<ImagePoint>& points, const Motion& motion) {
  const Pose X_end = motion.at(1.0).inverse();
  std::vector<FormerPoint> result;
  result.reserve(points.size());
  for (const ImagePoint& point : points) result.push_back({X_end * (motion.at(point.share) * point.p_R), point.row});
  return result;
}

TwoStepResult two_step(const Features& now, const FormerScan& former, const Motion& guess,
                       const TwoStepConfig& config) {
  TwoStepResult result{guess};
  if (former.edges.size() <= static_cast<std::size_t>(config.least_edges) ||
      former.flats.size() <= static_cast<std::size_t>(config.least_flats))
    return result;
  Solver ground(Step::ground, now.flat, former.flats, config);
  result.by_ground = ground.solve(result.motion);
  Solver edges(Step::edges, now.sharp, former.edges, config);
  result.by_edges = edges.solve(result.motion);
  result.degenerate = ground.degenerate() + edges.degenerate();
  return result;
}

}  // namespace plumbline::slam::lego
