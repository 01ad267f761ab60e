// SPDX-License-Identifier: Apache-2.0
#include "slam/baselines/lego_loam/range_image.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace plumbline::slam::lego {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

struct Step {
  int row, column;
};
constexpr Step around[] = {{-1, 0}, {0, 1}, {0, -1}, {1, 0}};

/// Grows one segment from a cell; the cells that it joined, the seed first.
std::vector<Step> grow(const RangeImage& image, const std::vector<double>& row_angles, const RangeImageConfig& config,
                       Step seed, std::vector<bool>& seen) {
  const double column_angle = 2.0 * std::numbers::pi / image.columns;
  const auto index = [&](Step s) { return static_cast<std::size_t>(s.row * image.columns + s.column); };
  std::vector<Step> cells = {seed};
  seen[index(seed)] = true;
  for (std::size_t k = 0; k < cells.size(); ++k)
    for (const Step& step : around) {
      const Step next{cells[k].row + step.row, (cells[k].column + step.column + image.columns) % image.columns};
      if (next.row < 0 || next.row >= image.rows || seen[index(next)]) continue;
      if (image.at(next.row, next.column).cell != Cell::open) continue;
      const double angle =
          step.row == 0 ? column_angle : row_angles[static_cast<std::size_t>(std::min(cells[k].row, next.row))];
      if (!joined(image.at(cells[k].row, cells[k].column).range_m, image.at(next.row, next.column).range_m, angle,
                  config))
        continue;
      seen[index(next)] = true;
      cells.push_back(next);
    }
  return cells;
}

/// Rows are counted where a cell is joined: the seed's only with another cell of it.
bool is_valid(const std::vector<Step>& cells, const RangeImageConfig& config) {
  if (cells.size() >= static_cast<std::size_t>(config.least_cells)) return true;
  if (cells.size() < static_cast<std::size_t>(config.least_cells_of_rows)) return false;
  std::set<int> rows;
  for (std::size_t k = 1; k < cells.size(); ++k) rows.insert(cells[k].row);
  return rows.size() >= static_cast<std::size_t>(config.least_rows);
}

double azimuth(const Eigen::Vector3d& p) { return std::atan2(p.y(), p.x()); }

/// Of azimuth, from a return to the next one of its ring.
std::vector<double> steps_of_columns(const Scan& scan) {
  const auto rings = static_cast<std::size_t>(std::max(1, scan.rings));
  std::vector<double> steps;
  for (std::size_t i = 0; i + rings < scan.size(); ++i) {
    if (!(scan.range_m[i] > 0.0) || !(scan.range_m[i + rings] > 0.0)) continue;
    const double step =
        std::abs(std::remainder(azimuth(scan.point_L[i + rings]) - azimuth(scan.point_L[i]), 2.0 * std::numbers::pi));
    if (step > 0.0) steps.push_back(step);
  }
  return steps;
}

/// The same of returns in the order of a file.
std::vector<double> steps_of_rings(const Scan& scan, Beams beams) {
  std::vector<std::vector<double>> rings(static_cast<std::size_t>(rings_of(beams)));
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const int ring = scan.range_m[i] > 0.0 ? ring_of(beams, elevation(scan.point_L[i])) : -1;
    if (ring >= 0) rings[static_cast<std::size_t>(ring)].push_back(azimuth(scan.point_L[i]));
  }
  std::vector<double> steps;
  for (std::vector<double>& ring : rings) {
    std::sort(ring.begin(), ring.end());
    for (std::size_t k = 1; k < ring.size(); ++k)
      if (ring[k] > ring[k - 1]) steps.push_back(ring[k] - ring[k - 1]);
  }
  return steps;
}

}  // namespace

int RangeImageConfig::ground_rows(int rings) const {
  const int rows = ground_rings > 0 ? ground_rings : static_cast<int>(std::lround(7.0 / 16.0 * rings));
  return std::min(rows, rings - 1);
}

int columns_of(const Scan& scan, Beams beams) {
  constexpr int reference = 1800, least = 36, most = 20000;
  std::vector<double> steps = beams == Beams::none ? steps_of_columns(scan) : steps_of_rings(scan, beams);
  if (steps.empty()) return reference;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  const double of_turn = 2.0 * std::numbers::pi / *middle + 0.5;  // 1800 may come as 1799.99
  const int columns = static_cast<int>(std::min(of_turn, static_cast<double>(most)));
  return columns >= 100 ? columns / 100 * 100 : std::max(columns, least);
}

RangeImage range_image(const Scan& scan, const Pose& X_RL, const RangeImageConfig& config, Beams beams) {
  const bool by_beams = beams != Beams::none;
  RangeImage image{by_beams ? rings_of(beams) : std::max(1, scan.rings),
                   config.columns > 0 ? config.columns : columns_of(scan, beams),
                   {}};
  image.cells.resize(static_cast<std::size_t>(image.rows) * static_cast<std::size_t>(image.columns));
  std::int32_t first_ns = 0;
  for (const std::int32_t offset : scan.offset_ns) first_ns = std::min(first_ns, offset);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3d& p_L = scan.point_L[i];
    const double range_m = p_L.norm();
    if (!(scan.range_m[i] > 0.0) || !(range_m >= config.min_range_m) || !(range_m <= config.max_range_m)) continue;
    ImagePoint point{X_RL * p_L, p_L, range_m};
    if (first_ns < 0 && i < scan.offset_ns.size())
      point.share = std::clamp(1.0 - static_cast<double>(scan.offset_ns[i]) / first_ns, 0.0, 1.0);
    const double turn = std::atan2(p_L.y(), p_L.x()) / (2.0 * std::numbers::pi);
    point.row = by_beams ? ring_of(beams, elevation(p_L)) : static_cast<int>(i % static_cast<std::size_t>(image.rows));
    if (point.row < 0) continue;
    // Clockwise as the reference's, from behind.
    point.column = static_cast<int>(std::lround((0.5 - turn) * image.columns)) % image.columns;
    point.cell = Cell::open;
    image.at(point.row, point.column) = point;
  }
  return image;
}

void mark_ground(RangeImage& image, const RangeImageConfig& config) {
  for (int row = 0; row < config.ground_rows(image.rows); ++row)
    for (int column = 0; column < image.columns; ++column) {
      ImagePoint& low = image.at(row, column);
      ImagePoint& high = image.at(row + 1, column);
      if (low.cell == Cell::empty || high.cell == Cell::empty) continue;
      const Eigen::Vector3d way = high.p_L - low.p_L;
      const double slope = std::atan2(way.z(), way.head<2>().norm());
      if (std::abs(slope / degree - config.mount_deg) <= config.ground_deg) low.cell = high.cell = Cell::ground;
    }
}

bool joined(double range_a_m, double range_b_m, double angle, const RangeImageConfig& config) {
  const double far = std::max(range_a_m, range_b_m), near = std::min(range_a_m, range_b_m);
  return std::atan2(near * std::sin(angle), far - near * std::cos(angle)) > config.segment_deg * degree;
}

std::vector<double> row_angles(const RangeImage& image) {
  std::vector<double> elevation;
  for (int row = 0; row < image.rows; ++row) {
    double sum = 0.0;
    int n = 0;
    for (int column = 0; column < image.columns; ++column) {
      const ImagePoint& point = image.at(row, column);
      if (point.cell == Cell::empty) continue;
      sum += std::atan2(point.p_L.z(), point.p_L.head<2>().norm());
      ++n;
    }
    // A row without returns has no neighbours either: its angle is of no consequence.
    elevation.push_back(n > 0 ? sum / n : 0.0);
  }
  std::vector<double> angles;
  for (std::size_t row = 0; row + 1 < elevation.size(); ++row)
    angles.push_back(std::abs(elevation[row + 1] - elevation[row]));
  return angles;
}

void mark_segments(RangeImage& image, const std::vector<double>& row_angles, const RangeImageConfig& config) {
  std::vector<bool> seen(image.cells.size(), false);
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.columns; ++column) {
      if (image.at(row, column).cell != Cell::open || seen[static_cast<std::size_t>(row * image.columns + column)])
        continue;
      const std::vector<Step> cells = grow(image, row_angles, config, {row, column}, seen);
      const Cell cell = is_valid(cells, config) ? Cell::segment : Cell::clutter;
      for (const Step& s : cells) image.at(s.row, s.column).cell = cell;
    }
}

SegmentedCloud segmented_cloud(const Scan& scan, const Pose& X_RL, const RangeImageConfig& config, Beams beams) {
  RangeImage image = range_image(scan, X_RL, config, beams);
  SegmentedCloud cloud;
  cloud.rows.resize(static_cast<std::size_t>(image.rows));
  if (image.rows < 2) return cloud;
  mark_ground(image, config);
  mark_segments(image, row_angles(image), config);
  constexpr int outlier_step = 5, whole_ends = 5;
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.columns; ++column) {
      const ImagePoint& point = image.at(row, column);
      cloud.ground += point.cell == Cell::ground;
      const bool kept_ground =
          point.cell == Cell::ground &&
          (column % config.ground_step == 0 || column <= whole_ends || column >= image.columns - whole_ends);
      if (point.cell == Cell::segment || kept_ground) cloud.rows[static_cast<std::size_t>(row)].push_back(point);
      if (point.cell == Cell::clutter && row > config.ground_rows(image.rows) && column % outlier_step == 0)
        cloud.outliers.push_back(point);
    }
  return cloud;
}

}  // namespace plumbline::slam::lego
