// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "scenarios/localizability/range_image.h"
#include "scenarios/localizability/search_area.h"

namespace plumbline::scenarios {

/// What candidate places are compared by.
struct Signature {
  std::array<float, 12> quantiles_m{};  ///< of all ranges: the same whatever the heading
  std::vector<float> level_m;           ///< of the level ring, by azimuth in W
  bool standable = false;               ///< nothing nearer than a robot's body all round, and a floor below
};

/// Of the view from a place, whatever its heading.
[[nodiscard]] Signature signature_of(const RangeImager& imager, const bim::RayScene& scene, const Eigen::Vector3d& p_W);

/// A place whose view is like another.
struct LikePlace {
  SensorPose place;
  int storey = 0;  ///< of the index
};

/// Grid of all places of a plan where a robot may stand, with their signatures.
class PlaceIndex {
 public:
  /// Throws InputError when the storeys have more than 2^18 places at this spacing.
  PlaceIndex(const bim::RayScene& plan, std::vector<SearchArea> storeys, double spacing_m, int threads);

  /// Places of a storey (-1: of all) whose view, turned, is like `seen`, best first (ties: grid order, then turn): at
  /// most max_seeds. `yaw` is the heading at which `seen` was taken, the result holds the headings it would have there.
  [[nodiscard]] std::vector<LikePlace> like(const Signature& seen, double yaw, int storey, bool yaw_known) const;

  [[nodiscard]] const RangeImager& imager() const { return imager_; }
  [[nodiscard]] const std::vector<SearchArea>& storeys() const { return storeys_; }
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  /// Cast to make it.
  [[nodiscard]] std::size_t beams() const { return beams_; }

 private:
  struct Entry {
    int storey = 0;
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
    Signature signature;
  };
  std::vector<SearchArea> storeys_;
  RangeImager imager_;
  std::vector<Entry> places_;
  std::size_t beams_ = 0;
};

}  // namespace plumbline::scenarios
