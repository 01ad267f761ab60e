// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/scenario_failure.h"

#include <locale>
#include <sstream>

namespace plumbline::sim {

ScenarioFailure scenario_failure(const std::string& what, double time_s, const Eigen::Vector3d& p_W) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.setf(std::ios::fixed);
  out.precision(2);
  out << what << " at " << time_s << " s at (" << p_W.x() << ", " << p_W.y() << ", " << p_W.z() << ")";
  return ScenarioFailure(out.str());
}

}  // namespace plumbline::sim
