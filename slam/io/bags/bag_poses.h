// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "slam/io/estimate.h"

namespace plumbline::slam {

/// Poses that a topic of a bag holds, as another program answered: nav_msgs/Odometry, geometry_msgs/PoseStamped or
/// PoseWithCovarianceStamped, one a message, or the last nav_msgs/Path. A pose that is repeated is taken once. Throws
/// InputError on another type or topic, which names those that there are, and where stamps go back.
[[nodiscard]] std::vector<StampedPose> read_bag_poses(const std::string& path, const std::string& topic);

}  // namespace plumbline::slam
