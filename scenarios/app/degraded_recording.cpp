// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/degraded_recording.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "bim/errors.h"
#include "bim/random/stream.h"

namespace plumbline::scenarios {

namespace {

/// Puts the records of `before` in front.
template <class T>
void prepend(std::vector<T>& records, std::vector<T>& before) {
  records.insert(records.begin(), before.begin(), before.end());
}

double elevation(const Eigen::Vector3d& point_L) { return std::atan2(point_L.z(), point_L.head<2>().norm()); }

/// Elevations of so many beams, rad: evenly spread over those of the scan's returns but for the outer twentieths.
std::vector<double> beams_of(const slam::Scan& scan, int beams) {
  constexpr double outer = 0.05;
  std::vector<double> all;
  for (std::size_t i = 0; i < scan.size(); ++i)
    if (scan.range_m[i] > 0.0) all.push_back(elevation(scan.point_L[i]));
  if (all.empty()) return {};
  std::sort(all.begin(), all.end());
  const auto at = [&](double share) {
    return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
  };
  const double least = at(outer), largest = at(1.0 - outer);
  std::vector<double> spread;
  for (int k = 0; k < beams; ++k) spread.push_back(least + (largest - least) * (k + 0.5) / beams);
  return spread;
}

class DegradedRecording final : public slam::Recording {
 public:
  DegradedRecording(std::unique_ptr<slam::Recording> recording, const Degradation& degradation)
      : recording_(std::move(recording)), degradation_(degradation) {
    if (degradation_.every < 1) throw InternalError("every Nth scan: N must be at least 1");
  }

  [[nodiscard]] const slam::RecordingInfo& info() const override { return recording_->info(); }
  [[nodiscard]] bool has_odometry() const override { return recording_->has_odometry(); }
  [[nodiscard]] slam::Nanoseconds origin() const override { return recording_->origin(); }
  [[nodiscard]] slam::Taken taken() const override { return recording_->taken(); }
  [[nodiscard]] std::vector<std::string> left_out() const override { return recording_->left_out(); }
  [[nodiscard]] std::vector<std::string> assumed() const override { return recording_->assumed(); }

  [[nodiscard]] bool next(slam::SensorFrame& frame) override {
    slam::SensorFrame skipped, out;
    for (int left = first_ ? 0 : degradation_.every - 1; left >= 0; --left) {
      if (!recording_->next(out)) return false;
      prepend(out.imu, skipped.imu);
      prepend(out.odometry, skipped.odometry);
      prepend(out.covariances, skipped.covariances);
      if (left > 0) skipped = std::exchange(out, {});
    }
    first_ = false;
    if (degradation_.thins()) thin(out.scan);
    impoverish(out.scan);
    if (degradation_.no_rings || degradation_.no_times || degradation_.thins()) out.packets.clear();  // they say all
    frame = std::move(out);
    return true;
  }

 private:
  void impoverish(slam::Scan& scan) const {
    if (degradation_.no_rings) {
      scan.rings = 1;
      scan.columns = static_cast<int>(scan.size());
    }
    if (degradation_.no_times) std::fill(scan.offset_ns.begin(), scan.offset_ns.end(), 0);
  }

  void thin(slam::Scan& scan) {
    if (beams_.empty() && degradation_.beams > 0) beams_ = beams_of(scan, degradation_.beams);
    for (std::size_t i = 0; i < scan.size(); ++i) {
      if (scan.range_m[i] <= 0.0 || is_kept(scan, i)) continue;
      scan.range_m[i] = 0.0;
      scan.point_L[i].setZero();
    }
  }

  [[nodiscard]] bool is_kept(const slam::Scan& scan, std::size_t i) const {
    constexpr double half_width_rad = 0.12 * std::numbers::pi / 180.0;
    if (degradation_.within_m > 0.0 && scan.range_m[i] > degradation_.within_m) return false;
    if (degradation_.beams > 0 && std::none_of(beams_.begin(), beams_.end(), [&](double beam) {
          return std::abs(elevation(scan.point_L[i]) - beam) < half_width_rad;
        }))
      return false;
    return degradation_.one_of == 1 ||
           draws_.uniform(static_cast<std::uint64_t>(scan.stamp), static_cast<std::uint32_t>(i)) * degradation_.one_of <
               1.0;
  }

  std::unique_ptr<slam::Recording> recording_;
  Degradation degradation_;
  Stream draws_{1, "recording.thinned"};  // not of the run's seed: methods of any seed get the same returns
  std::vector<double> beams_;             ///< of the first scan with returns
  bool first_ = true;
};

}  // namespace

std::unique_ptr<slam::Recording> degraded(std::unique_ptr<slam::Recording> recording, const Degradation& degradation) {
  if (!degradation.any()) return recording;
  return std::make_unique<DegradedRecording>(std::move(recording), degradation);
}

}  // namespace plumbline::scenarios
