// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/scan/motion.h"

namespace plumbline::slam {

/// Standard deviation of a scan's ranges, m, from how the next columns of its rings bend: surfaces hardly do within a
/// step. 0 where no ring returns from three columns in a row.
[[nodiscard]] double range_noise(const DeskewedScan& scan);

}  // namespace plumbline::slam
