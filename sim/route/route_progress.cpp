// SPDX-License-Identifier: Apache-2.0
#include "sim/route/route_progress.h"

#include <cmath>

namespace plumbline::sim {

bool Progress::stalled(std::size_t segment, bool stairs, double left_m, double error, double t_s) {
  const bool nearer = left_m < least_left_m_ - config_.distance_m;
  if (!started_ || segment != segment_ || nearer) {
    started_ = true;
    segment_ = segment;
    least_left_m_ = left_m;
    least_error_ = std::abs(error);
    since_s_ = t_s;
  } else if (std::abs(error) < least_error_ - config_.angle) {
    least_error_ = std::abs(error);
    since_s_ = t_s;
  }
  return t_s - since_s_ > (stairs ? config_.stuck_on_stairs_s : config_.stuck_s);
}

}  // namespace plumbline::sim
