// SPDX-License-Identifier: Apache-2.0
#include "slam/methods.h"

namespace plumbline::slam {

const MethodRow* find_method(std::string_view name, MethodTable table) {
  for (const MethodRow& row : table)
    if (row.name == name) return &row;
  return nullptr;
}

}  // namespace plumbline::slam
