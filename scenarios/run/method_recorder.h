// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "scenarios/run/record.h"

namespace plumbline::scenarios {

/// Keeps what one method answers, for scoring and the report. A method that throws has crashed: it is asked no more.
class MethodRecorder {
 public:
  MethodRecorder(std::string name, bool localization);

  /// Calls `process`, which returns the output for the scan of this stamp, and keeps that.
  void on_scan(slam::Nanoseconds stamp, const std::function<slam::Output()>& process);
  /// Calls `estimate`, which returns the final estimate. Call once, after the last scan.
  [[nodiscard]] MethodRecord finish(const std::function<slam::Estimate()>& estimate);

 private:
  void keep(const slam::Output& output);
  void keep_lost(const slam::Output& output);
  void keep_belief(const slam::Output& output);

  MethodRecord record_;
  bool lost_ = false;  ///< after the last scan
  slam::Nanoseconds last_stamp_ = 0;
  slam::Nanoseconds particles_stamp_ = 0;
  slam::Nanoseconds walls_stamp_ = 0;
};

}  // namespace plumbline::scenarios
