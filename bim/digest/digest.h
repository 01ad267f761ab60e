// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "bim/geometry/plane.h"
#include "bim/geometry/pose.h"

namespace plumbline {

/// 64-bit running hash of a stage's values, in the order they are added. -0 counts as +0; not-a-number throws
/// InternalError, since no stage may produce it.
class Digest {
 public:
  Digest& add(double value);
  Digest& add(std::int64_t value);
  Digest& add(std::uint64_t value);
  Digest& add(int value) { return add(static_cast<std::int64_t>(value)); }
  Digest& add(std::string_view text);
  Digest& add(const Pose& X);
  Digest& add(const Plane& plane);
  Digest& add(std::span<const double> values);
  Digest& add(const Eigen::Vector2d& v) { return add(v.x()).add(v.y()); }
  Digest& add(const Eigen::Vector3d& v) { return add(v.x()).add(v.y()).add(v.z()); }
  Digest& add_bytes(std::span<const std::uint8_t> bytes);

  [[nodiscard]] std::uint64_t value() const { return state_; }
  /// 16 lower-case hex digits.
  [[nodiscard]] std::string hex() const;

 private:
  std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

[[nodiscard]] std::string hex64(std::uint64_t value);

}  // namespace plumbline
