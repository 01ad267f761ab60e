// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "scenarios/localizability/place_index.h"

namespace plumbline::scenarios {

/// The scan at a pose in the building as built, and how well the plan explains it there.
struct ReferenceScan {
  SensorPose place;
  std::vector<double> range_m;      ///< of RangeImager's default beams
  std::vector<double> predicted_m;  ///< by the plan at the pose itself; empty where it is what was built
  std::vector<bool> loose;          ///< beams that end on what may have moved; empty: none
};

/// A pose at which the plan explains a scan nearly as well as at its own.
struct FoundAlias {
  SensorPose place;
  double llr = 0.0;  ///< of the scan; at most drop_llr
};

/// Which storeys and headings an alias may have.
struct AliasSearch {
  int storey = -1;  ///< of the index; -1: all
  bool yaw_known = false;
  bool thorough = false;  ///< for a run: gives up later, and candidates that end at one place count once
};

/// Looks for poses that a scan cannot tell from its own, docs/methods/localizability.md: candidates by signature,
/// refined on planes, judged by the log-likelihood ratio. Everything must outlive it. May be used by several threads.
/// Where plan and building differ, what the plan predicts at the pose is searched for besides what is seen there:
/// things that stand about hide what looks alike. `loose`: elements as built that may have moved and do not stand as
/// planned. `isometries`: of the plan; images under them are tried first, as they are.
class AliasFinder {
 public:
  AliasFinder(const PlaceIndex& index, const bim::RayScene& as_planned, const bim::RayScene& as_built,
              std::span<const char> loose = {}, std::span<const Pose> isometries = {});

  [[nodiscard]] ReferenceScan scan_at(const SensorPose& place) const;
  /// Log-likelihood ratio of the pose of a scan over another pose.
  [[nodiscard]] double llr(const ReferenceScan& scan, const SensorPose& other) const;
  /// Nearly surely llr > drop_llr, by a fortieth of the beams.
  [[nodiscard]] bool clearly_different(const ReferenceScan& scan, const SensorPose& other) const;
  /// Aliases of a scan, apart from itself and from `known` ones, in the order they were found.
  [[nodiscard]] std::vector<FoundAlias> find(const ReferenceScan& scan, const AliasSearch& search,
                                             std::span<const SensorPose> known = {}) const;
  /// Beams cast so far, and what else was computed in beams of the same cost. It depends on what was asked for alone.
  [[nodiscard]] std::uint64_t work() const { return work_; }
  /// Of one llr() with the clearly_different() before it.
  [[nodiscard]] std::uint64_t work_of_llr() const;

 private:
  /// A view of the scan's place by which aliases are looked for.
  struct View {
    Signature signature;
    RangeImage image;  ///< of the coarse beams
  };
  [[nodiscard]] std::vector<View> views_of(const SensorPose& place) const;
  [[nodiscard]] bool is_loose(int element) const;
  [[nodiscard]] double evidence(const ReferenceScan& scan, std::size_t beam, double other_m) const;
  /// The same where other_m may be that of a beam next to this one.
  [[nodiscard]] double evidence(const ReferenceScan& scan, std::size_t beam, const SensorPose& other,
                                double other_m) const;
  /// Images of a place under the isometries that lie over a floor of the storeys searched.
  [[nodiscard]] std::vector<SensorPose> images_of(const SensorPose& place, int storey) const;
  [[nodiscard]] bool refine(const RangeImage& seen, const SearchArea& storey, SensorPose& place) const;

  const PlaceIndex& index_;
  const bim::RayScene& as_planned_;
  const bim::RayScene& as_built_;
  std::span<const char> loose_;
  std::span<const Pose> isometries_;
  RangeImager imager_;
  RangeImager coarse_;
  mutable std::atomic<std::uint64_t> work_ = 0;
};

}  // namespace plumbline::scenarios
