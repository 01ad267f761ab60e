// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>

namespace plumbline::bim {

/// Two or three of IFC++'s numbers as a vector, the third 0 when absent; nullopt when one is missing or not a number.
template <class Measures>
[[nodiscard]] std::optional<Eigen::Vector3d> vector_of(const Measures& measures) {
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  if (measures.size() < 2 || measures.size() > 3) return std::nullopt;
  for (std::size_t i = 0; i < measures.size(); ++i) {
    if (!measures[i]) return std::nullopt;
    v[static_cast<Eigen::Index>(i)] = measures[i]->m_value;
  }
  return v.allFinite() ? std::optional(v) : std::nullopt;
}

}  // namespace plumbline::bim
