// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace plumbline::slam {

/// Keeps PCL from writing to stderr, from the first call on: what it says there, its return values say too. To be
/// called before PCL is used; from any thread.
void quiet_pcl();

}  // namespace plumbline::slam
