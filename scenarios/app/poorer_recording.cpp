// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/poorer_recording.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "bim/errors.h"

namespace plumbline::scenarios {

namespace {

/// Puts the records of `before` in front.
template <class T>
void prepend(std::vector<T>& records, std::vector<T>& before) {
  records.insert(records.begin(), before.begin(), before.end());
}

class PoorerRecording final : public slam::Recording {
 public:
  PoorerRecording(std::unique_ptr<slam::Recording> recording, const Poverty& poverty)
      : recording_(std::move(recording)), poverty_(poverty) {
    if (poverty_.every < 1) throw InternalError("every Nth scan: N must be at least 1");
  }

  [[nodiscard]] const slam::RecordingInfo& info() const override { return recording_->info(); }
  [[nodiscard]] bool has_odometry() const override { return recording_->has_odometry(); }
  [[nodiscard]] slam::Nanoseconds origin() const override { return recording_->origin(); }
  [[nodiscard]] slam::Taken taken() const override { return recording_->taken(); }
  [[nodiscard]] std::vector<std::string> left_out() const override { return recording_->left_out(); }
  [[nodiscard]] std::vector<std::string> assumed() const override { return recording_->assumed(); }

  [[nodiscard]] bool next(slam::SensorFrame& frame) override {
    slam::SensorFrame skipped, out;
    for (int left = first_ ? 0 : poverty_.every - 1; left >= 0; --left) {
      if (!recording_->next(out)) return false;
      prepend(out.imu, skipped.imu);
      prepend(out.odometry, skipped.odometry);
      prepend(out.covariances, skipped.covariances);
      if (left > 0) skipped = std::exchange(out, {});
    }
    first_ = false;
    impoverish(out.scan, poverty_);
    if (poverty_.no_rings || poverty_.no_times) out.packets.clear();  // they say both
    frame = std::move(out);
    return true;
  }

 private:
  std::unique_ptr<slam::Recording> recording_;
  Poverty poverty_;
  bool first_ = true;
};

}  // namespace

void impoverish(slam::Scan& scan, const Poverty& poverty) {
  if (poverty.no_rings) {
    scan.rings = 1;
    scan.columns = static_cast<int>(scan.size());
  }
  if (poverty.no_times) std::fill(scan.offset_ns.begin(), scan.offset_ns.end(), 0);
}

std::unique_ptr<slam::Recording> poorer(std::unique_ptr<slam::Recording> recording, const Poverty& poverty) {
  if (!poverty.any()) return recording;
  return std::make_unique<PoorerRecording>(std::move(recording), poverty);
}

}  // namespace plumbline::scenarios
