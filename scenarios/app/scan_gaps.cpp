// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/scan_gaps.h"

#include <algorithm>
#include <cmath>

#include "bim/config/tree.h"
#include "bim/median.h"

namespace plumbline::scenarios {

namespace {

std::string tenths(slam::Nanoseconds ns) { return format_number(std::round(10.0 * slam::seconds(ns)) / 10.0) + " s"; }

}  // namespace

void ScanGaps::add(slam::Nanoseconds stamp) { stamps_.push_back(stamp); }

std::optional<std::string> ScanGaps::warning() const {
  constexpr double least_s = 1.0, of_spacing = 5.0;  // a metre of a walk; some scans are missed by every driver
  if (stamps_.size() < 3) return std::nullopt;
  std::vector<double> spacings_s;
  for (std::size_t i = 1; i < stamps_.size(); ++i) spacings_s.push_back(slam::seconds(stamps_[i] - stamps_[i - 1]));
  const double least = std::max(least_s, of_spacing * upper_median(spacings_s));
  const auto gaps = std::count_if(spacings_s.begin(), spacings_s.end(), [&](double s) { return s > least; });
  if (gaps == 0) return std::nullopt;
  const auto longest = std::max_element(spacings_s.begin(), spacings_s.end()) - spacings_s.begin();
  const slam::Nanoseconds from = stamps_[static_cast<std::size_t>(longest)];
  const slam::Nanoseconds to = stamps_[static_cast<std::size_t>(longest) + 1];
  return "no scan for " + tenths(to - from) + " after " + tenths(from) +
         (gaps == 1 ? "" : ", the longest of " + std::to_string(gaps) + " such gaps");
}

}  // namespace plumbline::scenarios
