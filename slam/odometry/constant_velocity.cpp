// SPDX-License-Identifier: Apache-2.0
#include "slam/odometry/constant_velocity.h"

#include <algorithm>
#include <optional>

namespace plumbline::slam {

namespace {

/// Farther ahead a step's noise dominates: after a gap the search starts near the last pose.
constexpr double most_steps = 3.0;

class ConstantVelocity final : public Method {
 public:
  explicit ConstantVelocity(std::unique_ptr<Method> method) : method_(std::move(method)) {}

  void on_imu(const Imu& imu) override { method_->on_imu(imu); }

  [[nodiscard]] Output on_scan(const Scan& scan) override {
    if (!last_) start(scan);
    predict(scan.stamp);
    Output output = method_->on_scan(scan);
    if (output.X_FR) keep({scan.stamp, *output.X_FR});
    return output;
  }

  [[nodiscard]] Estimate finish() override { return method_->finish(); }

 private:
  /// Odometry from the first return of the first scan on.
  void start(const Scan& scan) {
    Nanoseconds first = scan.stamp;
    for (const std::int32_t offset : scan.offset_ns) first = std::min(first, scan.stamp + offset);
    if (first < scan.stamp && !predicted_) method_->on_odometry({first, X_OR_});
  }

  void predict(Nanoseconds stamp) {
    if (last_ && before_ && last_->stamp > before_->stamp) {
      const double steps =
          static_cast<double>(stamp - last_->stamp) / static_cast<double>(last_->stamp - before_->stamp);
      const double share = std::min(steps, most_steps);
      X_OR_ = X_OR_ * interpolate(Pose{}, before_->X_FR.inverse() * last_->X_FR, share);
      X_OR_.q.normalize();
    }
    method_->on_odometry({stamp, X_OR_});
    predicted_ = true;
  }

  void keep(const StampedPose& pose) {
    before_ = last_;
    last_ = pose;
  }

  std::unique_ptr<Method> method_;
  std::optional<StampedPose> before_;  ///< the answer before the last
  std::optional<StampedPose> last_;
  Pose X_OR_;
  bool predicted_ = false;
};

}  // namespace

std::unique_ptr<Method> with_constant_velocity(std::unique_ptr<Method> method) {
  return std::make_unique<ConstantVelocity>(std::move(method));
}

}  // namespace plumbline::slam
