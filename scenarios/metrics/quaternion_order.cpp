// SPDX-License-Identifier: Apache-2.0
#include "scenarios/metrics/quaternion_order.h"

#include <array>
#include <cstdio>

namespace plumbline::scenarios::score {

namespace {

std::string in_m(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f m", value);
  return text.data();
}

std::optional<double> error_over_a_metre(const std::vector<slam::StampedPose>& poses_F, const Truth& truth) {
  const TrajectoryRules rules;
  const auto errors = relative_errors(associate(truth, poses_F, rules), truth, rules.rpe_distance_m);
  return errors ? std::optional(errors->translation_rmse_m) : std::nullopt;
}

}  // namespace

std::string wrong_order(slam::TrajectoryForm form, std::optional<double> as_read_m, std::optional<double> other_m,
                        const OrderRules& rules) {
  if (form == slam::TrajectoryForm::kitti || !as_read_m || !other_m) return {};
  if (*as_read_m < rules.least_error_m || *other_m > rules.most_of_as_read * *as_read_m) return {};
  const bool tum = form == slam::TrajectoryForm::tum;
  return std::string("its quaternions seem to be in the order ") + (tum ? "w x y z" : "x y z w") +
         ": read so, the error over each metre is " + in_m(*other_m) + "; read as " +
         (tum ? "x y z w, the order of a TUM file" : "w x y z, the order of a EuRoC file") + ", it is " +
         in_m(*as_read_m);
}

std::string wrong_order(slam::TrajectoryForm form, const std::vector<slam::StampedPose>& poses_F, const Truth& truth) {
  return wrong_order(form, error_over_a_metre(poses_F, truth),
                     error_over_a_metre(slam::in_other_order(poses_F, form), truth));
}

}  // namespace plumbline::scenarios::score
