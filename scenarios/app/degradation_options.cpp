// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/degradation_options.h"

#include <algorithm>

namespace plumbline::scenarios {

void DegradationOptions::declare(CommandLine& line) {
  constexpr int most = 1000;
  constexpr double farthest_m = 10'000.0;
  line.option("--every", every, "uses every Nth scan, with all odometry and IMU in between [1]").range(1, most);
  line.option("--without", without,
              "drop rings (all returns in one ring) or times (every return gets the scan's stamp)")
      .one_of({"rings", "times"})
      .delimiter(',');
  line.option("--max-range", max_range_m, "drop returns farther than this, m [none]").range(0.1, farthest_m);
  line.option("--beams", beams,
              "keep the returns of N evenly spaced elevation cones, as a LiDAR with N rings would [all]")
      .range(1, most);
  line.option("--one-of", one_of, "keep one return in N, drawn at random [1]").range(1, most);
}

Degradation DegradationOptions::value() const {
  const auto lacks = [&](const char* what) { return std::find(without.begin(), without.end(), what) != without.end(); };
  return {.every = every,
          .no_rings = lacks("rings"),
          .no_times = lacks("times"),
          .within_m = max_range_m,
          .one_of = one_of,
          .beams = beams};
}

void describe(const Degradation& degradation, Tree& tree) {
  if (degradation.every != 1) tree.set("every", degradation.every);
  Tree without = Tree::list();
  if (degradation.no_rings) without.push("rings");
  if (degradation.no_times) without.push("times");
  if (degradation.no_rings || degradation.no_times) tree.set("without", without);
  if (degradation.within_m > 0.0) tree.set("max_range_m", degradation.within_m);
  if (degradation.beams != 0) tree.set("beams", degradation.beams);
  if (degradation.one_of != 1) tree.set("one_of", degradation.one_of);
}

}  // namespace plumbline::scenarios
