// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/results.h"

namespace plumbline::scenarios {

std::string text_of(const Tree& map, std::string_view key) {
  const Tree* value = map.find(key);
  return value == nullptr ? "" : value->as_string();
}

std::optional<double> number_of(const Tree* map, std::string_view key) {
  const Tree* value = map == nullptr ? nullptr : map->find(key);
  if (value == nullptr || !value->is_scalar()) return std::nullopt;
  return value->as_double();
}

double start_s(const ReportInput& input) { return input.truth.empty() ? 0.0 : input.truth.front().t_s; }

const Tree* results_of(const Tree& results, const std::string& method) {
  const Tree* methods = results.find("methods");
  return methods == nullptr ? nullptr : methods->find(method);
}

const Tree* results_of(const ReportInput& input, const std::string& method) {
  return results_of(input.results, method);
}

}  // namespace plumbline::scenarios
