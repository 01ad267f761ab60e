// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "sim/lidar/light.h"

namespace plumbline::sim {

/// One echo of a beam: the returns of surfaces that lie closer together than the detector resolves.
struct Echo {
  double range_m = 0.0;   ///< mean of its reflections, weighted by energy
  double strength = 0.0;  ///< sum over them
  double cosine = 1.0;    ///< mean, weighted by strength
  double energy = 0.0;
  Reflection main;  ///< the strongest (ties: nearest)
};

/// Echoes of one beam, nearest first: a reflection farther than separation_m from the first of an echo begins another.
/// May change the order of the reflections.
void find_echoes(std::span<Reflection> reflections, double separation_m, std::vector<Echo>& echoes);

}  // namespace plumbline::sim
