// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/read/partial_storeys.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

namespace plumbline::bim {
namespace {

constexpr double same_height_m = 0.1;

double height_m(const StepProduct& storey) {
  const double placed_m = storey.X_WP.translation().z();
  return storey.placed ? placed_m : storey.elevation_m.value_or(placed_m);
}

}  // namespace

void join_partial_storeys(StepModel& model) {
  std::map<std::int64_t, const StepProduct*> storeys;
  for (const StepProduct& product : model.products)
    if (product.kind == StepClass::storey) storeys[product.step_id] = &product;
  std::map<std::int64_t, std::int64_t> joined;  // part to the storey that it becomes
  for (const auto& [number, part] : storeys) {
    const StepProduct* whole = part;
    for (auto at = storeys.find(part->whole);
         at != storeys.end() && std::abs(height_m(*at->second) - height_m(*part)) < same_height_m;
         at = storeys.find(whole->whole))
      whole = at->second;
    if (whole == part) continue;
    joined[number] = whole->step_id;
    model.skipped.push_back({part->id, "left_out",
                             part->type + " #" + std::to_string(number) + ": is a part of the storey '" + whole->name +
                                 "' at the same height; what is on it belongs to that storey"});
  }
  for (StepProduct& product : model.products) {
    if (const auto at = joined.find(product.storey); at != joined.end()) product.storey = at->second;
    if (const auto at = joined.find(product.whole); at != joined.end()) product.whole = at->second;
  }
  std::erase_if(model.products, [&](const StepProduct& product) { return joined.contains(product.step_id); });
}

}  // namespace plumbline::bim
