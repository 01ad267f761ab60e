// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/ukf/ukf.h"

#include <cmath>
#include <numbers>

#include "bim/digest/digest.h"
#include "slam/baselines/ukf/unscented.h"

namespace plumbline::slam {

namespace {

using Eigen::VectorXd;

// Position, velocity, quaternion (w, x, y, z), accelerometer and gyroscope bias.
constexpr Eigen::Index p_at = 0, v_at = 3, q_at = 6, g_at = 13, states = 16;
constexpr int min_points = 50;                     // of a scan that is used
constexpr int min_ends = 30;                       // of a slice that is searched for
constexpr Nanoseconds longest_step = 200'000'000;  // without IMU records the last are no guide

Eigen::Quaterniond attitude(const VectorXd& x) {
  const Eigen::Quaterniond q(x[q_at], x[q_at + 1], x[q_at + 2], x[q_at + 3]);
  return q.norm() > 1e-6 ? q.normalized() : Eigen::Quaterniond::Identity();
}

void set_attitude(VectorXd& x, const Eigen::Quaterniond& q) { x.segment<4>(q_at) << q.w(), q.x(), q.y(), q.z(); }

Pose pose_of(const VectorXd& x) { return {attitude(x), x.segment<3>(p_at)}; }

/// (x, y, yaw) of the filter's covariance: yaw = 2 (q* dq)_z for an upright robot.
Eigen::Matrix3d planar(const UnscentedFilter& filter) {
  const Eigen::Quaterniond q = attitude(filter.mean());
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, states);
  J(0, p_at) = J(1, p_at + 1) = 1.0;
  J.block<1, 4>(2, q_at) << -2.0 * q.z(), 2.0 * q.y(), -2.0 * q.x(), 2.0 * q.w();
  return J * filter.covariance() * J.transpose();
}

class Ukf final : public PlanMethod {
 public:
  Ukf(const MethodInput& input, const UkfConfig& config)
      : PlanMethod("ukf", input, config.plan, config.map), config_(config) {
    for (const StoreyIndex& storey : index().storeys) {
      matchers_.emplace_back(storey, config.slice_height_m, config.search);
      maps_.emplace_back(storey, config.ndt);
    }
  }

  void on_imu(const Imu& imu) override;

 private:
  [[nodiscard]] PlanBelief update(const PlanScan& scan, Output& output) override;
  void search(const PlanScan& scan);
  void start(int storey, const Pose& X_IR);
  void advance(Nanoseconds stamp, const Imu& imu);
  void predict(const Imu& imu, double dt);
  void drift(double dt);
  void predict_by_odometry(const PlanScan& scan);
  void correct(const Pose& X_IR);
  void normalise();
  [[nodiscard]] Eigen::MatrixXd process_noise(double dt) const;

  UkfConfig config_;
  std::vector<GridMatcher> matchers_;  ///< by storey
  std::vector<NdtMap> maps_;
  std::optional<UnscentedFilter> filter_;
  int storey_ = 0;
  Pose X_OR_last_;
  Nanoseconds stamp_ = 0;   ///< the filter's time
  std::optional<Imu> imu_;  ///< the last one
  int bad_scans_ = 0;
};

Eigen::MatrixXd Ukf::process_noise(double dt) const {
  VectorXd q(states);
  q << Eigen::Vector3d::Constant(config_.q_position), Eigen::Vector3d::Constant(config_.q_velocity),
      Eigen::Vector4d::Constant(config_.q_attitude), VectorXd::Constant(6, config_.q_bias);
  return (dt * q).asDiagonal();
}

void Ukf::normalise() {
  VectorXd x = filter_->mean();
  set_attitude(x, attitude(x));
  filter_->set_mean(x);
}

void Ukf::on_imu(const Imu& imu) {
  const bool sane = imu.angular_velocity_R.norm() < 100.0 && imu.linear_acceleration_R.norm() < 1000.0;  // false: NaN
  if (!sane || config_.motion != UkfMotion::imu) return;
  if (filter_ && imu.stamp > stamp_) {
    advance(imu.stamp, imu);
    stamp_ = imu.stamp;
  }
  imu_ = imu;
}

/// On to a time by an IMU record, or without it where it is no guide to that time.
void Ukf::advance(Nanoseconds stamp, const Imu& imu) {
  const Nanoseconds step = stamp - stamp_;
  if (step <= 0) return;
  if (step <= longest_step && stamp - imu.stamp <= longest_step)
    predict(imu, seconds(step));
  else
    drift(seconds(step));
}

/// By the gyro alone: the reference's accelerations are too noisy to help, so the velocity stays.
void Ukf::predict(const Imu& imu, double dt) {
  filter_->predict(
      [&](const VectorXd& x) {
        VectorXd next = x;
        const Eigen::Quaterniond q = attitude(x);
        next.segment<3>(p_at) += dt * x.segment<3>(v_at);
        set_attitude(next, q * exp_so3(dt * (imu.angular_velocity_R - x.segment<3>(g_at))));
        return next;
      },
      process_noise(dt));
  normalise();
}

void Ukf::drift(double dt) {
  filter_->predict(
      [&](const VectorXd& x) {
        VectorXd next = x;
        next.segment<3>(p_at) += dt * x.segment<3>(v_at);
        return next;
      },
      process_noise(dt));
  normalise();
}

/// Motion since the last scan by odometry.
void Ukf::predict_by_odometry(const PlanScan& scan) {
  const Pose u = X_OR_last_.inverse() * scan.X_OR;
  const double dt = std::max(seconds(scan.deskewed.stamp - stamp_), 1e-3);
  filter_->predict(
      [&](const VectorXd& x) {
        VectorXd next = x;
        const Pose moved = pose_of(x) * u;
        next.segment<3>(p_at) = moved.t;
        set_attitude(next, moved.q);
        return next;
      },
      process_noise(dt));
  normalise();
}

void Ukf::start(int storey, const Pose& X_IR) {
  VectorXd x = VectorXd::Zero(states);
  x.segment<3>(p_at) = X_IR.t;
  set_attitude(x, X_IR.q);
  filter_.emplace(x, config_.p0 * Eigen::MatrixXd::Identity(states, states), config_.lambda);
  storey_ = storey;
  bad_scans_ = 0;
}

/// The best pose of all storeys (ties: the lowest storey); it is taken, however badly it fits, unless nothing fits.
void Ukf::search(const PlanScan& scan) {
  const ScanSlice slice = cut_scan(scan.deskewed, scan.q_HR, input().calibration.sensor_height_m, config_.slice);
  if (slice.ends_H.size() < static_cast<std::size_t>(min_ends)) return;
  const double half = scan.prior_yaw_I ? std::min(3.0 * scan.prior_yaw_sigma, std::numbers::pi) : std::numbers::pi;
  int best_score = 0;
  for (std::size_t s = 0; s < matchers_.size(); ++s) {
    const std::vector<double> yaws = matchers_[s].yaws(scan.prior_yaw_I.value_or(0.0), half);
    const GridMatch match = matchers_[s].best(slice.ends_H, yaws);
    if (match.score <= best_score) continue;
    best_score = match.score;
    start(static_cast<int>(s), pose_on_floor(static_cast<int>(s), matchers_[s].pose(match, yaws), scan.q_HR));
  }
}

void Ukf::correct(const Pose& X_IR) {
  VectorXd z(7);
  Eigen::Quaterniond q = X_IR.q;
  if (q.dot(attitude(filter_->mean())) < 0.0) q.coeffs() *= -1.0;  // one attitude, two quaternions
  z << X_IR.t, q.w(), q.x(), q.y(), q.z();
  VectorXd r(7);
  r << Eigen::Vector3d::Constant(config_.r_position), Eigen::Vector4d::Constant(config_.r_attitude);
  filter_->correct(
      [](const VectorXd& x) {
        VectorXd seen(7);
        seen << x.segment<3>(p_at), x.segment<4>(q_at);
        return seen;
      },
      z, r.asDiagonal());
  normalise();
}

PlanBelief Ukf::update(const PlanScan& scan, Output& output) {
  Stopwatch stopwatch;
  if (!filter_) {
    search(scan);
    record_stage("search", stopwatch, output);
  } else if (config_.motion == UkfMotion::odometry) {
    predict_by_odometry(scan);
  } else if (config_.motion == UkfMotion::imu && imu_) {
    advance(scan.deskewed.stamp, *imu_);
  } else if (scan.deskewed.stamp > stamp_) {
    drift(seconds(scan.deskewed.stamp - stamp_));
  }
  X_OR_last_ = scan.X_OR;
  stamp_ = scan.deskewed.stamp;
  PlanBelief belief;
  if (!filter_) return belief;
  const std::vector<Eigen::Vector3d> points = ndt_points(scan.deskewed, config_.ndt);
  bool fits = false;
  if (points.size() >= static_cast<std::size_t>(min_points)) {
    const NdtMatch match = maps_[static_cast<std::size_t>(storey_)].align(points, pose_of(filter_->mean()));
    correct(match.X_IR);
    fits = match.inliers >= config_.lost_inliers;
  }
  bad_scans_ = fits ? 0 : bad_scans_ + 1;
  record_stage("ndt", stopwatch, output);
  output.digests.push_back({"filter", Digest().add(pose_of(filter_->mean())).add(bad_scans_).value()});
  belief.state = bad_scans_ >= config_.lost_scans ? State::lost : State::converged;
  if (!filter_->mean().allFinite() || !filter_->covariance().allFinite()) {
    filter_.reset();
    belief.state = State::lost;
    return belief;
  }
  belief.X_IR = pose_of(filter_->mean());
  belief.hypotheses.push_back({1.0, storey_, *belief.X_IR, planar(*filter_)});
  if (belief.state == State::lost && config_.relocalize) filter_.reset();
  return belief;
}

}  // namespace

std::unique_ptr<Method> make_ukf(const MethodInput& input, const UkfConfig& config) {
  return std::make_unique<Ukf>(input, config);
}

}  // namespace plumbline::slam
