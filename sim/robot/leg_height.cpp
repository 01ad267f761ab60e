// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/leg_height.h"

#include <algorithm>

namespace plumbline::sim {

void LegHeight::update(const SensorReading& reading, const Eigen::Quaterniond& q_OR,
                       const std::array<double, 4>& sole_m, const std::array<double, 4>& rolling, double dt) {
  climb_ += ((q_OR * reading.accelerometer_R).z() - config_.gravity) * dt;
  z_ += climb_ * dt;
  update_contacts(reading, dt);
  for (std::size_t leg = 0; leg < feet_.size(); ++leg)
    if (feet_[leg].anchored) feet_[leg].ground_O += rolling[leg] * dt;
  held_ = settled();
  if (held_) follow_feet(sole_m, dt);
}

void LegHeight::update_contacts(const SensorReading& reading, double dt) {
  for (std::size_t leg = 0; leg < feet_.size(); ++leg) {
    Foot& foot = feet_[leg];
    foot.off_s = reading.contact[leg] ? 0.0 : foot.off_s + dt;
    const bool stands = foot.stands ? foot.off_s < config_.lost_s : reading.contact[leg];
    foot.stood_s = stands && foot.stands ? foot.stood_s + dt : 0.0;
    foot.anchored = foot.anchored && stands;
    foot.stands = stands;
  }
}

bool LegHeight::settled() const {
  const auto stands = [](const Foot& foot) { return foot.stands; };
  const auto fresh = [this](const Foot& foot) { return foot.stands && foot.stood_s < config_.settle_s; };
  return std::any_of(feet_.begin(), feet_.end(), stands) && std::none_of(feet_.begin(), feet_.end(), fresh);
}

/// Critically damped towards the mean of what the anchored feet say; then the others are anchored. A foot without
/// contact may be lifting.
void LegHeight::follow_feet(const std::array<double, 4>& sole_m, double dt) {
  double error = 0.0;
  int count = 0;
  for (std::size_t leg = 0; leg < feet_.size(); ++leg) {
    if (!feet_[leg].anchored || feet_[leg].off_s > 0.0) continue;
    error += feet_[leg].ground_O - sole_m[leg] - z_;
    ++count;
  }
  if (count > 0) {
    z_ += 2.0 * config_.bandwidth_rad_s * dt * error / count;
    climb_ += config_.bandwidth_rad_s * config_.bandwidth_rad_s * dt * error / count;
  }
  for (std::size_t leg = 0; leg < feet_.size(); ++leg) {
    Foot& foot = feet_[leg];
    if (foot.anchored || foot.off_s > 0.0) continue;
    foot.ground_O = z_ + sole_m[leg];
    foot.anchored = true;
  }
}

}  // namespace plumbline::sim
