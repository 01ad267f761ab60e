// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "scenarios/localizability/place_index.h"

namespace plumbline::scenarios {

/// What is seen from a place, as built, and how well the plan explains it there.
struct Look {
  Place place;
  std::vector<double> range_m;  ///< of Viewer's default beams
  double own = 0.0;             ///< cost of the plan's view from the place itself
};

/// A place from which the plan explains a look nearly as well as from its own.
struct FoundTwin {
  Place place;
  double llr = 0.0;  ///< of the look: cost there less the look's own; at most drop_llr
};

/// Which storeys and headings a twin may have.
struct TwinSearch {
  int storey = -1;  ///< of the index; -1: all
  bool yaw_known = false;
};

/// Looks for places that a look cannot tell from its own [facts: localization 3.2]: candidates by signature, refined
/// on planes, judged by the log-likelihood ratio. Everything must outlive it. May be used by several threads.
class TwinFinder {
 public:
  TwinFinder(const PlaceIndex& index, const bim::RayScene& as_planned, const bim::RayScene& as_built);

  [[nodiscard]] Look look(const Place& place) const;
  /// Log-likelihood ratio of a look against another place, which speaks for the look's own where it is positive.
  [[nodiscard]] double llr(const Look& look, const Place& other) const;
  /// Nearly surely llr > drop_llr, told by a tenth of the beams.
  [[nodiscard]] bool plainly_unlike(const Look& look, const Place& other) const;
  /// Twins of a look, apart from itself and from `known` ones, in the order they were found.
  [[nodiscard]] std::vector<FoundTwin> find(const Look& look, const TwinSearch& search,
                                            std::span<const Place> known = {}) const;

 private:
  [[nodiscard]] bool refine(const View& seen, Place& place) const;

  const PlaceIndex& index_;
  const bim::RayScene& as_planned_;
  const bim::RayScene& as_built_;
  Viewer viewer_;
  Viewer coarse_;
};

}  // namespace plumbline::scenarios
