// SPDX-License-Identifier: Apache-2.0
#include "scenarios/score/identifiability.h"

#include <algorithm>
#include <cmath>

#include "bim/mesh/mesh.h"
#include "bim/mesh/visible.h"
#include "bim/rays/scene.h"
#include "scenarios/identify/constants.h"
#include "scenarios/identify/identify.h"
#include "sim/world.h"

namespace plumbline::scenarios::score {

namespace {

/// The storey whose floor is nearest below the robot (ties: the lower index).
std::size_t storey_of(const bim::Building& building, const Pose& X_WR) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < building.storeys.size(); ++i) {
    const double here =
        std::abs(X_WR.t.z() - sim::World::calibration().sensor_height_m - building.storeys[i].elevation_m);
    const double there =
        std::abs(X_WR.t.z() - sim::World::calibration().sensor_height_m - building.storeys[best].elevation_m);
    if (here < there) best = i;
  }
  return best;
}

IdentifyStorey search_area(const bim::Building& building, std::size_t storey) {
  IdentifyStorey area;
  area.sensor_z_W = building.storeys[storey].elevation_m + sim::World::calibration().sensor_height_m;
  area.min = Eigen::Vector2d::Constant(1e9);
  area.max = Eigen::Vector2d::Constant(-1e9);
  for (const bim::Wall& wall : building.walls) {
    if (wall.storey != static_cast<int>(storey)) continue;
    area.min = area.min.cwiseMin(wall.a).cwiseMin(wall.b);
    area.max = area.max.cwiseMax(wall.a).cwiseMax(wall.b);
  }
  return area;
}

bim::RayScene scene_of(const bim::Building& building) {
  return bim::RayScene(bim::visible_mesh(building, bim::build_mesh(building)));
}

}  // namespace

std::optional<Identifiability> identifiability_of(const RunFiles& files, const Truth& truth) {
  if (files.scans.empty() || files.truth_W.empty()) return std::nullopt;
  const bim::Building& as_planned = files.site.as_planned;
  const bim::RayScene planned_scene = scene_of(as_planned);
  std::optional<bim::RayScene> built_scene;
  if (!files.site.changes.empty()) built_scene = scene_of(files.site.as_built);
  const std::size_t start = storey_of(as_planned, files.truth_W.front().X_FR);

  IdentifyInput input;
  input.as_planned = &planned_scene;
  input.as_built = built_scene ? &*built_scene : &planned_scene;
  input.yaw_known = files.scenario.prior.yaw == Knowledge::known;
  input.truth_sensor_z_W = search_area(as_planned, start).sensor_z_W;
  for (std::size_t i = 0; i < as_planned.storeys.size(); ++i)
    if (i == start || files.scenario.prior.storey == Knowledge::unknown)
      input.storeys.push_back(search_area(as_planned, i));

  std::vector<TruthSample> samples;
  for (const slam::Nanoseconds t : files.scans)
    samples.push_back({slam::seconds(t - files.scans.front()), truth.at(t)});
  const RunIdentifiability run = identify_run(input, samples);

  Identifiability result{run.identifiable, run.identifiable_at_s, run.identifiable_at_m, run.tellable_from_s(), {}};
  result.others_W = run.ambiguity_set(samples.back().t_s, samples.back().X_WR);
  return result;
}

}  // namespace plumbline::scenarios::score
