// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_method/coarse_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace plumbline::slam {

namespace {

constexpr std::size_t azimuths = 120, elevations = 60;
constexpr std::size_t most_returns = 6000;  // so many tell enough of a scan

std::size_t cell_of(double share, std::size_t cells) {
  return std::min(static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * static_cast<double>(cells)), cells - 1);
}

}  // namespace

CoarseView::CoarseView(const Scan& scan) : range_m_(azimuths * elevations, 0.0F) {
  std::vector<int> count(range_m_.size(), 0);
  const std::size_t step = (scan.size() / most_returns) | 1U;  // odd, so that no ring is left out of 16, 32, 64
  for (std::size_t i = 0; i < scan.size(); i += step) {
    if (scan.range_m[i] <= 0.0) continue;
    const Eigen::Vector3d& p_L = scan.point_L[i];
    const double turn = 0.5 + 0.5 * std::atan2(p_L.y(), p_L.x()) / std::numbers::pi;
    const double rise = 0.5 + std::atan2(p_L.z(), p_L.head<2>().norm()) / std::numbers::pi;
    const std::size_t cell = cell_of(turn, azimuths) * elevations + cell_of(rise, elevations);
    range_m_[cell] += static_cast<float>(scan.range_m[i]);
    ++count[cell];
  }
  for (std::size_t c = 0; c < range_m_.size(); ++c)
    if (count[c] > 0) range_m_[c] /= static_cast<float>(count[c]);
}

double CoarseView::unchanged_share(const CoarseView& other) const {
  constexpr float same_m = 0.04F;  // twice the noise of a LiDAR; a cell holds a few returns
  const std::size_t cells = std::min(range_m_.size(), other.range_m_.size());
  std::size_t either = 0, both = 0, same = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    const float a = range_m_[c], b = other.range_m_[c];
    if (a > 0.0F || b > 0.0F) ++either;
    if (a <= 0.0F || b <= 0.0F) continue;
    ++both;
    if (std::abs(a - b) < same_m) ++same;
  }
  return both == 0 || 2 * both < either ? 0.0 : static_cast<double>(same) / static_cast<double>(both);
}

}  // namespace plumbline::slam
