// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "slam/io/records.h"

namespace plumbline::scenarios {

/// FILE, or BAG,topic=TOPIC, and frame=W where its poses are in the plan's frame.
struct ReferenceSource {
  std::string file, topic;
  bool in_plan_frame = false;
};

/// Of what --reference says. Throws InputError.
[[nodiscard]] ReferenceSource reference_source(std::string text);

/// Its poses. `estimate`: its stamps are those of a reference without times. Throws InputError, also where the order of
/// its quaternions is plainly another.
[[nodiscard]] std::vector<slam::StampedPose> read_reference(const ReferenceSource& source,
                                                            const std::vector<slam::StampedPose>& estimate);

}  // namespace plumbline::scenarios
