// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "bim/config/visit.h"
#include "bim/geometry/pose.h"
#include "slam/io/records.h"
#include "slam/scan/beams.h"

namespace plumbline::slam::lego {

/// Values of the reference for a VLP-16 [shan2018].
struct RangeImageConfig {
  int columns = 0;
  double min_range_m = 1.0;
  double max_range_m = 100.0;
  int ground_rings = 0;
  double ground_deg = 10.0;
  double mount_deg = 0.0;
  double segment_deg = 60.0;
  int least_cells = 30;
  int least_cells_of_rows = 5;
  int least_rows = 3;
  int ground_step = 5;

  /// Rows that are compared with the one above: 7 of 16, unless given.
  [[nodiscard]] int ground_rows(int rings) const;

  template <class V>
  void visit(V& v) {
    v("columns", columns,
      Field{.doc = "columns of the range image; 0: as many as a turn has beams, 1800 of a VLP-16",
            .min = 0,
            .max = 20000});
    v("min_range_m", min_range_m, Field{.doc = "least range of a return that is used", .min = 0.0});
    v("max_range_m", max_range_m, Field{.doc = "largest range of a return that is used", .min = 1.0, .max = 1000.0});
    v("ground_rings", ground_rings,
      Field{.doc = "lowest rings that may show the ground; 0: 7 of 16", .min = 0, .max = 1000, .basic = true});
    v("ground_deg", ground_deg,
      Field{.doc = "largest slope from ring to ring of the ground", .min = 0.0, .max = 90.0, .basic = true});
    v("mount_deg", mount_deg,
      Field{.doc = "tilt of the sensor that is taken off that slope", .min = -90.0, .max = 90.0});
    v("segment_deg", segment_deg,
      Field{.doc = "least angle between a beam and the line to its neighbour of one segment", .min = 1.0, .max = 90.0});
    v("least_cells", least_cells, Field{.doc = "least cells of a segment", .min = 1});
    v("least_cells_of_rows", least_cells_of_rows, Field{.doc = "or of one on least_rows rows", .min = 1});
    v("least_rows", least_rows, Field{.doc = "rows of such a segment", .min = 1});
    v("ground_step", ground_step, Field{.doc = "columns from one ground point that is kept to the next", .min = 1});
  }
};

enum class Cell { empty, open, ground, segment, clutter };

/// A return in the image.
struct ImagePoint {
  Eigen::Vector3d p_R = Eigen::Vector3d::Zero();  ///< when it was measured
  Eigen::Vector3d p_L = Eigen::Vector3d::Zero();
  double range_m = 0.0;
  double share = 1.0;  ///< of the sweep's time that had passed, 1 at the scan's stamp
  int row = 0, column = 0;
  Cell cell = Cell::empty;
};

/// A scan by ring and azimuth; a cell's last return stays.
struct RangeImage {
  int rows = 0, columns = 0;
  std::vector<ImagePoint> cells;  ///< row * columns + column

  [[nodiscard]] const ImagePoint& at(int row, int column) const {
    return cells[static_cast<std::size_t>(row * columns + column)];
  }
  [[nodiscard]] ImagePoint& at(int row, int column) { return cells[static_cast<std::size_t>(row * columns + column)]; }
};

/// So many columns that neighbouring beams never leave one empty: by the scan's median step of azimuth, rounded down to
/// a hundred as the reference's 1800 of a VLP-16 at 10 Hz; 1800 where a scan does not tell.
[[nodiscard]] int columns_of(const Scan& scan, Beams beams = Beams::none);
/// beams: of a scan without rings.
[[nodiscard]] RangeImage range_image(const Scan& scan, const Pose& X_RL, const RangeImageConfig& config,
                                     Beams beams = Beams::none);
/// Marks cells that lie level with the one above.
void mark_ground(RangeImage& image, const RangeImageConfig& config);
/// Whether ranges of two cells an angle apart, rad, are of one segment.
[[nodiscard]] bool joined(double range_a_m, double range_b_m, double angle, const RangeImageConfig& config);
/// Marks what is neither ground nor empty as segments or clutter. row_angles: rad between a row and the next.
void mark_segments(RangeImage& image, const std::vector<double>& row_angles, const RangeImageConfig& config);
/// Mean elevation from row to row, rad.
[[nodiscard]] std::vector<double> row_angles(const RangeImage& image);

/// What is left of a scan.
struct SegmentedCloud {
  std::vector<std::vector<ImagePoint>> rows;  ///< by column: segments whole, ground thinned
  std::vector<ImagePoint> outliers;           ///< every fifth column of clutter above the ground rows
  int ground = 0;                             ///< cells of ground
};
[[nodiscard]] SegmentedCloud segmented_cloud(const Scan& scan, const Pose& X_RL, const RangeImageConfig& config,
                                             Beams beams = Beams::none);

}  // namespace plumbline::slam::lego
