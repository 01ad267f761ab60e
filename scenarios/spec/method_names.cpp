// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/method_names.h"

namespace plumbline::scenarios {

std::vector<std::string> method_names(slam::MethodTable table) {
  std::vector<std::string> names;
  for (const slam::MethodRow& row : table) names.emplace_back(row.name);
  names.emplace_back(truth_method);
  return names;
}

}  // namespace plumbline::scenarios
