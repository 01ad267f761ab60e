// SPDX-License-Identifier: Apache-2.0
#include "bim/symmetry/body_grid.h"

#include <algorithm>
#include <cmath>

namespace plumbline::bim {

BodyGrid::BodyGrid(const std::vector<Eigen::AlignedBox2d>& boxes) {
  constexpr double smallest_cell_m = 0.5;
  Eigen::AlignedBox2d all;
  for (const Eigen::AlignedBox2d& box : boxes) all.extend(box);
  if (all.isEmpty()) return;
  const Eigen::Vector2d span = all.sizes();
  const auto count = static_cast<double>(boxes.size());
  origin_ = all.min();
  // One cell a box on average, also where all stand in a row.
  cell_m_ = std::max({smallest_cell_m, std::sqrt(span.x() * span.y() / count), span.maxCoeff() / count});
  size_ = (span / cell_m_).array().floor().cast<int>() + 1;
  cells_.resize(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Eigen::Vector2i low = cell(boxes[i].min()), high = cell(boxes[i].max());
    for (int y = low.y(); y <= high.y(); ++y)
      for (int x = low.x(); x <= high.x(); ++x)
        cells_[static_cast<std::size_t>(y * size_.x() + x)].push_back(static_cast<int>(i));
  }
}

Eigen::Vector2i BodyGrid::cell(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d place = ((p - origin_) / cell_m_).array().floor();
  return {static_cast<int>(std::clamp(place.x(), 0.0, size_.x() - 1.0)),
          static_cast<int>(std::clamp(place.y(), 0.0, size_.y() - 1.0))};
}

void BodyGrid::near(const Eigen::AlignedBox2d& box, std::vector<int>& found) const {
  found.clear();
  if (cells_.empty()) return;
  const Eigen::Vector2i low = cell(box.min()), high = cell(box.max());
  for (int y = low.y(); y <= high.y(); ++y)
    for (int x = low.x(); x <= high.x(); ++x) {
      const std::vector<int>& here = cells_[static_cast<std::size_t>(y * size_.x() + x)];
      found.insert(found.end(), here.begin(), here.end());
    }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

}  // namespace plumbline::bim
