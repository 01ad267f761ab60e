// SPDX-License-Identifier: Apache-2.0
#include "scenarios/score/walk_end.h"

#include <algorithm>
#include <cmath>

namespace plumbline::scenarios::score {

namespace {

constexpr double at_the_end_m = 1.0;   ///< the robot stops this near to the end of its route
constexpr double most_of_it = 0.5;     ///< of a route whose end is near its start, it has then walked at least this
constexpr double on_storey_m = 1.5;    ///< of a base over its storey's floor, at most
constexpr std::size_t most_named = 5;  ///< rooms

const bim::Room* room_named(const std::vector<bim::Room>& rooms, const std::string& id) {
  const auto found = std::find_if(rooms.begin(), rooms.end(), [&](const bim::Room& room) { return room.id == id; });
  return found == rooms.end() ? nullptr : &*found;
}

std::string tenths(double value) { return format_number(std::round(10.0 * value) / 10.0); }

/// Names of the rooms of the route that the robot never was in.
std::vector<std::string> rooms_not_entered(const FinishedRun& run) {
  std::vector<std::string> names;
  const bim::PlannedAndBuilt& site = run.building->variants();
  for (const std::string& id : run.walk.route_rooms) {
    const bim::Room* room = room_named(site.as_built.rooms, id);
    if (room == nullptr) room = room_named(site.as_planned.rooms, id);
    if (room == nullptr) continue;
    const bool entered =
        std::any_of(run.record.truth_W.begin(), run.record.truth_W.end(), [&](const slam::StampedPose& pose) {
          const double above = pose.X_FR.t.z() - room->z0_m;
          return above > 0.0 && above < on_storey_m && room->contains(Eigen::Vector2d(pose.X_FR.t.head<2>()));
        });
    if (!entered) names.push_back(room->name.empty() ? room->id : room->name);
  }
  return names;
}

double walked_m(const std::vector<slam::StampedPose>& truth_W) {
  double sum = 0.0;
  for (std::size_t i = 1; i < truth_W.size(); ++i) sum += (truth_W[i].X_FR.t - truth_W[i - 1].X_FR.t).head<2>().norm();
  return sum;
}

}  // namespace

std::vector<std::string> warnings_of_walk(const FinishedRun& run) {
  std::vector<std::string> warnings = walk_warnings(run.walk);
  if (run.building && run.building->variants().as_built.walls.empty())
    warnings.push_back("no walls are known in the building: `walls.*` are not scored");
  if (run.scenario.kidnap || !run.record.failure.empty() || run.record.truth_W.empty()) return warnings;
  constexpr double before_s = 1.0;  // of the end of the time, at most: the last scan of a walk that is cut short
  if (slam::seconds(run.record.truth_W.back().stamp) < run.scenario.duration_s - before_s) return warnings;
  const double left_m = (run.record.truth_W.back().X_FR.t.head<2>() - run.walk.end_W).norm();
  const std::vector<std::string> names = rooms_not_entered(run);
  const bool is_done = names.empty() && walked_m(run.record.truth_W) >= most_of_it * run.walk.planned_m;
  if (left_m < at_the_end_m && is_done) return warnings;
  std::string text = std::string(cut_short_mark) + " (" + tenths(run.scenario.duration_s) + " s)";
  for (std::size_t i = 0; i < std::min(names.size(), most_named); ++i)
    text += (i == 0 ? ", before it came to " : ", ") + names[i];
  if (names.size() > most_named) text += " and " + std::to_string(names.size() - most_named) + " more rooms";
  const double enough_s = walk_duration(run.walk.planned_m, run.walk.stairs_m, run.scenario.speed_mps);
  warnings.push_back(text + "; `duration_s: " + tenths(std::max(enough_s, run.scenario.duration_s)) +
                     "` would do for all of its route");
  return warnings;
}

}  // namespace plumbline::scenarios::score
