// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenarios/spec/resolve.h"
#include "slam/io/lidar_model.h"
#include "slam/io/records.h"

namespace plumbline::scenarios {

/// Where the returns of packed scans lie. Column c of ring r was fired at azimuth0 + c turn_rad + azimuth_rad[r],
/// clockwise seen from above and 0 along x of L, in the direction (cosine, sine) of its elevation, from height_m[r]
/// above the origin of L. Fit for viewing: 1 cm, 0.02 degrees.
struct ScanGrid {
  int rings = 0;
  int columns = 0;                                          ///< kept of each scan
  int every = 1;                                            ///< column of the sensor is kept
  double unit_m = 0.01;                                     ///< of ranges
  double turn_rad = 0.0;                                    ///< from one kept column to the next
  double span_s = 0.0;                                      ///< from the first kept column to the scan's stamp
  double column_s = 0.0;                                    ///< from one kept column to the next
  std::vector<double> azimuth_rad, cosine, sine, height_m;  ///< by ring
};

/// A scan as a range image: 16 bits a return in units of the grid, 0 without one, ring by ring. Each value but a ring's
/// first is the difference to the one before, folded to be positive (0, -1, 1, -2 ...); all low bytes, then all high
/// bytes; deflated.
struct PackedScan {
  slam::Nanoseconds stamp = 0;
  double azimuth0 = 0.0;  ///< rad, of its first column
  std::string bytes;
};

/// Packs the scans of a run as they come, some 6 kB each.
class ScanPacker {
 public:
  ScanPacker(const slam::LidarModel& model, double rpm, bool vertical_offsets);

  void add(const slam::Scan& scan);

  [[nodiscard]] const ScanGrid& grid() const { return grid_; }
  [[nodiscard]] const std::vector<PackedScan>& scans() const { return scans_; }
  /// Bytes of a scan before they were deflated.
  [[nodiscard]] std::string ranges(std::size_t scan) const;

 private:
  ScanGrid grid_;
  std::vector<PackedScan> scans_;
};

/// For the scans of a scenario's LiDAR.
[[nodiscard]] ScanPacker packer_of(const ResolvedScenario& resolved);

}  // namespace plumbline::scenarios
