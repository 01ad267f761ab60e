// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/planned_walk.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bim/median.h"
#include "scenarios/host/parallel.h"
#include "scenarios/localizability/floor.h"
#include "sim/route/pure_pursuit.h"
#include "sim/world.h"

namespace plumbline::scenarios {

namespace {

constexpr double sample_m = 0.1;
constexpr double route_rounding_m = 0.02;  ///< the heights of a route are no further off those of the floors

/// A robot that walks along the waypoints.
class Walker {
 public:
  Walker(const sim::WorldConfig& world, std::vector<bim::WalkedFloors> floors)
      : floors_(std::move(floors)), speed_mps_(world.speed_mps), duration_s_(world.duration_s) {}

  void stand(const Eigen::Vector3d& floor_W, double yaw) {
    p_ = floor_W;
    yaw_ = yaw;
    add();
  }

  void walk_to(const Eigen::Vector3d& goal_W) {
    const sim::PurePursuitConfig rule;
    const Eigen::Vector3d way = goal_W - p_;
    const double length = way.head<2>().norm();
    if (length < 1e-6) return;
    const double heading = std::atan2(way.y(), way.x());
    const double turn = std::abs(wrap_angle(heading - yaw_));
    if (turn > rule.turn_start) t_ += turn / rule.yaw_rate_max;
    yaw_ = heading;
    const Eigen::Vector3d start = p_;
    const int steps = std::max(1, static_cast<int>(std::ceil(length / sample_m)));
    for (int i = 1; i <= steps && t_ < duration_s_; ++i) {
      p_ = start + way * i / steps;
      t_ += length / steps / speed_mps_;
      add();
    }
  }

  [[nodiscard]] std::vector<TruthSample> samples() const { return samples_; }

 private:
  void add() { samples_.push_back({t_, Pose::from_xyz_yaw(p_, yaw_), sensor_z_W(floors_, p_, route_rounding_m)}); }

  std::vector<bim::WalkedFloors> floors_;
  double speed_mps_;
  double duration_s_;
  double t_ = 0.0;
  double yaw_ = 0.0;
  Eigen::Vector3d p_ = Eigen::Vector3d::Zero();
  std::vector<TruthSample> samples_;
};

std::vector<TruthSample> walk_in(const bim::Building& plan, const sim::WorldConfig& world) {
  Walker walker(world, storey_floors(plan));
  if (world.waypoints.empty()) return {};
  walker.stand(world.waypoints.front().p_W, world.start_yaw);
  for (const sim::Waypoint& waypoint : world.waypoints) walker.walk_to(waypoint.p_W);
  return walker.samples();
}

/// storey: the one the walk begins on.
LocalizabilityInput input_of(const ResolvedScenario& resolved, int storey, const VisibleBuilding& visible) {
  LocalizabilityInput input;
  input.as_planned = &visible.planned.scene;
  input.as_built = &visible.as_built().scene;
  input.loose = visible.loose;
  input.isometries = visible.isometries;
  const bim::Building& plan = resolved.building->as_planned();
  for (std::size_t i = 0; i < plan.storeys.size(); ++i)
    if (static_cast<int>(i) == storey || resolved.scenario.prior.storey == Knowledge::unknown)
      if (const SearchArea area = search_area(plan, i); !area.empty()) input.storeys.push_back(area);
  if (input.storeys.empty())
    throw InputError({resolved.scenario.building, 0, 0},
                     "has no walls or rooms in which a pose could be searched for; a plan or an .ifc would be right");
  return input;
}

WalkAnswers answer_by(const ResolvedScenario& resolved, PlanEvidence by) {
  const VisibleBuilding visible = visible_building(*resolved.building, by);
  LocalizabilityInput input = input_of(resolved, resolved.world.storey, visible);
  const std::vector<TruthSample> walk = planned_walk(resolved);
  WalkAnswers answers;
  answers.seed = resolved.scenario.seed;
  answers.unknown = compute_localizability(input, walk);
  input.yaw_known = true;
  answers.compass = compute_localizability(input, walk);
  answers.length_m = answers.unknown.steps.empty() ? 0.0 : answers.unknown.steps.back().distance_m;
  const std::vector<TruthSample> after = planned_walk_after(resolved);
  if (!after.empty())
    answers.set_down = compute_localizability(input_of(resolved, resolved.world_after->storey, visible), after);
  return answers;
}

SeedAnswers answer(const std::string& scenario, std::uint64_t seed) {
  Overrides overrides;
  overrides.seed = seed;
  overrides.methods = std::vector<std::string>{"truth"};
  const ResolvedScenario resolved = resolve(scenario, overrides);
  SeedAnswers answers{answer_by(resolved, PlanEvidence::building), std::nullopt};
  if (resolved.building->movables_tell()) answers.with_furniture = answer_by(resolved, PlanEvidence::with_furniture);
  return answers;
}

const RunIdentifiability* part_of(const WalkAnswers& walk, WalkPart part) {
  if (part == WalkPart::set_down) return walk.set_down ? &*walk.set_down : nullptr;
  return part == WalkPart::compass ? &walk.compass : &walk.unknown;
}

Tree tree_of(const RunIdentifiability& run) {
  Tree tree = Tree::map();
  tree.set("identifiable", run.identifiable);
  if (run.identifiable_at_s) tree.set("at_s", *run.identifiable_at_s).set("at_m", *run.identifiable_at_m);
  if (!run.steps.empty()) tree.set("aliases", static_cast<int>(run.steps.front().alive.size()));
  return tree;
}

void set_answers(const WalkAnswers& walk, Tree& tree) {
  tree.set("unknown", tree_of(walk.unknown)).set("compass", tree_of(walk.compass));
  if (walk.set_down) tree.set("set_down", tree_of(*walk.set_down));
}

}  // namespace

std::vector<TruthSample> planned_walk(const ResolvedScenario& resolved) {
  return walk_in(resolved.building->as_planned(), resolved.world);
}

std::vector<TruthSample> planned_walk_after(const ResolvedScenario& resolved) {
  if (!resolved.world_after) return {};
  const std::vector<TruthSample> before = planned_walk(resolved);
  sim::WorldConfig world = *resolved.world_after;
  world.duration_s -= (before.empty() ? 0.0 : before.back().t_s) + resolved.scenario.kidnap->away_s;
  return walk_in(resolved.building->as_planned(), world);
}

std::vector<SeedAnswers> localizability_of_walks(const std::string& scenario, int seeds, int threads) {
  std::vector<SeedAnswers> walks(static_cast<std::size_t>(std::max(seeds, 0)));
  for_each_index(walks.size(), threads, [&](std::size_t i) { walks[i] = answer(scenario, i + 1); });
  return walks;
}

WalkSummary summary_of(const std::vector<SeedAnswers>& walks, WalkPart part, PlanEvidence by) {
  WalkSummary summary;
  std::vector<double> at_s, at_m;
  for (const SeedAnswers& walk : walks) {
    const bool other = by == PlanEvidence::with_furniture && walk.with_furniture;
    const RunIdentifiability* run = part_of(other ? *walk.with_furniture : walk.building, part);
    if (run == nullptr) continue;
    ++summary.walks;
    if (!run->identifiable) continue;
    ++summary.identifiable;
    if (*run->identifiable_at_m == 0.0) ++summary.at_once;
    at_s.push_back(*run->identifiable_at_s);
    at_m.push_back(*run->identifiable_at_m);
  }
  summary.median_at_s = at_s.empty() ? 0.0 : median(at_s);
  summary.median_at_m = at_m.empty() ? 0.0 : median(at_m);
  return summary;
}

std::string walks_text(const std::vector<SeedAnswers>& walks) {
  const WalkSummary after = summary_of(walks, WalkPart::set_down);
  std::string text;
  const auto add = [&](const char* name, const WalkSummary& s) {
    char line[160];
    std::snprintf(line, sizeof line, "%-8s %7d %12.0f %% %7.0f %% ", name, s.walks,
                  100.0 * s.identifiable / std::max(s.walks, 1), 100.0 * s.at_once / std::max(s.walks, 1));
    text += line;
    std::snprintf(line, sizeof line, "%10.1f %10.1f\n", s.median_at_s, s.median_at_m);
    text += s.identifiable > 0 ? line : "         -          -\n";
  };
  const auto add_table = [&](const char* title, PlanEvidence by) {
    text += std::string(title) + "\nheading    walks  identifiable   at once   median s   median m\n";
    add("unknown", summary_of(walks, WalkPart::unknown, by));
    add("compass", summary_of(walks, WalkPart::compass, by));
    if (after.walks > 0) add("set down", summary_of(walks, WalkPart::set_down, by));
  };
  add_table("By the building alone:", PlanEvidence::building);
  if (std::any_of(walks.begin(), walks.end(), [](const SeedAnswers& walk) { return walk.with_furniture.has_value(); }))
    add_table("With the furniture as planned:", PlanEvidence::with_furniture);
  else
    text += "Nothing in the plan may have moved.\n";
  if (after.walks == 0) return text;
  return text +
         "The robot is kidnapped on its way: unknown and compass are of the walk before, set down is of the walk "
         "after,\ncounted from where it is set down, with the heading unknown.\n";
}

Tree walks_json(const std::vector<SeedAnswers>& walks) {
  Tree list = Tree::list();
  for (const SeedAnswers& walk : walks) {
    Tree tree = Tree::map();
    tree.set("seed", std::to_string(walk.building.seed)).set("length_m", walk.building.length_m);
    set_answers(walk.building, tree);
    if (walk.with_furniture) {
      Tree other = Tree::map();
      set_answers(*walk.with_furniture, other);
      tree.set("with_furniture", std::move(other));
    }
    list.push(std::move(tree));
  }
  return Tree::map().set("walks", std::move(list));
}

}  // namespace plumbline::scenarios
