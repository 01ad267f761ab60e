// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "bim/config/visit.h"
#include "slam/scan/motion.h"

namespace plumbline::slam {

/// Whose beams measured a scan without rings: programs after LOAM sort its returns into rings by elevation.
enum class Beams { automatic, vlp16, hdl32, hdl64, none };
[[nodiscard]] constexpr std::array<std::string_view, 5> names_of(Beams) {
  return {"auto", "vlp16", "hdl32", "hdl64", "none"};
}

constexpr Field beam_model_field{
    .doc = "LiDAR by whose beams returns of scans without rings get one; auto: by the elevations seen; none: no rings"};

/// 0 where the LiDAR is not known.
[[nodiscard]] int rings_of(Beams beams);
/// The nearest beam, 0 the lowest; -1 beyond the outer ones by more than half a step.
[[nodiscard]] int ring_of(Beams beams, double elevation_rad);
/// Whose beams have these elevations, rad, by the range that they span and how close they come to single beams; none
/// where they are fewer than 1000, or unlike those of each.
[[nodiscard]] Beams beams_of(const std::vector<double>& elevations);

/// The LiDAR of a recording's scans without rings: as given, else of the first scan that tells.
class BeamsOfRecording {
 public:
  /// Returns of an HDL-64E below ring lowest_of_64 get no ring.
  explicit BeamsOfRecording(Beams given, int lowest_of_64 = 0) : beams_(given), lowest_of_64_(lowest_of_64) {}
  /// none where the scan has rings.
  [[nodiscard]] Beams of(const Scan& scan);
  /// The scan in rings, each by azimuth, clockwise from behind; nothing where the scan has rings, or gets none.
  [[nodiscard]] std::optional<DeskewedScan> in_rings(const DeskewedScan& scan);

 private:
  [[nodiscard]] Beams known(const std::vector<double>& elevations);

  Beams beams_;
  int lowest_of_64_;
};

}  // namespace plumbline::slam
