// SPDX-License-Identifier: Apache-2.0
#include "slam/io/clouds/quiet_pcl.h"

#include <pcl/console/print.h>

namespace plumbline::slam {

void quiet_pcl() {
  // Once, since PCL keeps its level in a plain variable.
  [[maybe_unused]] static const bool quiet = (pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS), true);
}

}  // namespace plumbline::slam
