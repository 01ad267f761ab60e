// SPDX-License-Identifier: Apache-2.0
#include "scenarios/identify/identify.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "scenarios/identify/views.h"

namespace plumbline::scenarios {

namespace {

constexpr double rad = std::numbers::pi / 180.0;
constexpr const IdentifyConstants& k = identify_constants;

/// A place and heading of the levelled sensor.
struct Place {
  Eigen::Vector3d position_W = Eigen::Vector3d::Zero();
  double yaw = 0.0;
  [[nodiscard]] Pose pose() const { return Pose::from_xyz_yaw(position_W, yaw); }
};

struct Seed {
  double cost = 0.0;
  std::size_t order = 0;
  Place place;
};

bool same_place(const Place& a, const Place& b, double metres, double degrees) {
  return (a.position_W - b.position_W).norm() <= metres && std::abs(wrap_angle(a.yaw - b.yaw)) <= degrees * rad;
}

Place levelled(const Pose& X_WR, double z) { return {{X_WR.t.x(), X_WR.t.y(), z}, X_WR.yaw()}; }

/// A robot can stand here: nothing nearer than its body all round, and a floor below.
bool standable(const View& view) {
  const auto n = static_cast<std::size_t>(k.azimuths);
  const std::size_t level = 4 * n;  // the ring at +1 degree
  for (std::size_t a = 0; a < n; ++a)
    if (view.range_m[level + a] < k.min_clearance_m) return false;
  return std::any_of(view.range_m.begin(), view.range_m.begin() + static_cast<std::ptrdiff_t>(n),
                     [](double r) { return r < 5.0; });
}

/// Grid places of all storeys with every heading asked for, cheapest first (ties: grid order).
std::vector<Seed> find_seeds(const Viewer& viewer, const IdentifyInput& input, const View& seen, const Place& truth) {
  std::vector<Seed> seeds;
  std::size_t order = 0;
  for (const auto& storey : input.storeys)
    for (double x = storey.min.x() + 0.5 * k.grid_m; x < storey.max.x(); x += k.grid_m)
      for (double y = storey.min.y() + 0.5 * k.grid_m; y < storey.max.y(); y += k.grid_m) {
        const Eigen::Vector3d p(x, y, storey.sensor_z_W);
        // Looking along the true heading makes azimuths comparable; other headings are cyclic shifts.
        const View expected = viewer.look(*input.as_planned, p, truth.yaw);
        if (!standable(expected)) continue;
        const int span = input.yaw_known ? 0 : 180;
        const int step = static_cast<int>(k.yaw_step_deg);
        for (int turn = -span; turn <= std::max(0, span - step); turn += step)
          seeds.push_back({viewer.cost(seen, expected, turn), order++, {p, truth.yaw + turn * rad}});
      }
  std::sort(seeds.begin(), seeds.end(),
            [](const Seed& a, const Seed& b) { return std::tie(a.cost, a.order) < std::tie(b.cost, b.order); });
  if (seeds.size() > static_cast<std::size_t>(k.max_seeds)) seeds.resize(static_cast<std::size_t>(k.max_seeds));
  return seeds;
}

/// Gauss-Newton on (x, y, yaw): the seen points against the planes that the plan's own view predicts.
Place refine(const Viewer& viewer, const IdentifyInput& input, const View& seen, Place place) {
  double gate = 1.0;
  for (int iteration = 0; iteration < k.refine_iterations; ++iteration) {
    const View expected = viewer.look(*input.as_planned, place.position_W, place.yaw);
    Eigen::Matrix3d H = 1e-9 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    const Pose X_WS = place.pose();
    for (std::size_t i = 0; i < seen.range_m.size(); ++i) {
      if (!std::isfinite(seen.range_m[i]) || !std::isfinite(expected.range_m[i])) continue;
      const Eigen::Vector3d d_W = X_WS.q * viewer.directions()[i];
      const Eigen::Vector3d& n = expected.normal_W[i];
      const double e = n.dot(d_W) * (seen.range_m[i] - expected.range_m[i]);
      if (std::abs(e) > gate) continue;
      const Eigen::Vector3d arm = seen.range_m[i] * d_W;
      const Eigen::Vector3d J(n.x(), n.y(), n.y() * arm.x() - n.x() * arm.y());
      H += J * J.transpose();
      g += J * e;
    }
    const Eigen::Vector3d step = H.ldlt().solve(-g);
    if (!step.allFinite()) break;
    place.position_W.head<2>() += step.head<2>();
    place.yaw = wrap_angle(place.yaw + step.z());
    gate = std::max(0.1, 0.75 * gate);
  }
  return place;
}

std::vector<Twin> find_twins(const Viewer& viewer, const IdentifyInput& input, const Place& truth) {
  const Viewer coarse(k.refine_azimuths);
  const View seen = viewer.look(*input.as_built, truth.position_W, truth.yaw);
  const View seen_coarse = coarse.look(*input.as_built, truth.position_W, truth.yaw);
  const double own = viewer.cost(seen, viewer.look(*input.as_planned, truth.position_W, truth.yaw));
  std::vector<Place> found;
  std::vector<Twin> twins;
  for (const Seed& seed : find_seeds(viewer, input, seen, truth)) {
    const Place place = refine(coarse, input, seen_coarse, seed.place);
    if (input.yaw_known && std::abs(wrap_angle(place.yaw - truth.yaw)) > k.known_yaw_deg * rad) continue;
    if (same_place(place, truth, k.distinct_m, k.distinct_deg)) continue;
    const auto known = [&](const Place& other) { return same_place(place, other, 0.3, 6.0); };
    if (std::any_of(found.begin(), found.end(), known)) continue;
    const double llr = viewer.cost(seen, viewer.look(*input.as_planned, place.position_W, place.yaw)) - own;
    if (llr > k.drop_llr) continue;
    found.push_back(place);
    twins.push_back({place.pose() * truth.pose().inverse(), 0.0});
  }
  return twins;
}

/// Poses at which a scan is compared: the first, then one per step_m walked.
std::vector<std::pair<double, const TruthSample*>> stations(const std::vector<TruthSample>& truth) {
  std::vector<std::pair<double, const TruthSample*>> out;
  double walked = 0.0;
  double last = -k.step_m;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (i > 0) walked += (truth[i].X_WR.t - truth[i - 1].X_WR.t).head<2>().norm();
    if (walked - last < k.step_m) continue;
    last = walked;
    out.emplace_back(walked, &truth[i]);
  }
  return out;
}

void conclude(RunIdentifiability& run) {
  run.identifiable = !run.steps.empty() && run.steps.back().alive.empty();
  if (!run.identifiable) return;
  std::size_t first = run.steps.size() - 1;
  while (first > 0 && run.steps[first - 1].alive.empty()) --first;
  run.identifiable_at_s = run.steps[first].t_s;
  run.identifiable_at_m = run.steps[first].distance_m;
}

}  // namespace

std::vector<Pose> RunIdentifiability::ambiguity_set(double t_s, const Pose& X_WR) const {
  const IdentifyStep* now = nullptr;
  for (const auto& step : steps)
    if (step.t_s <= t_s) now = &step;
  std::vector<Pose> poses;
  if (now != nullptr)
    for (const Twin& twin : now->alive) poses.push_back(twin.twin * X_WR);
  return poses;
}

std::optional<double> RunIdentifiability::tellable_from_s() const {
  std::optional<double> from;
  for (const auto& step : steps) {
    const bool strong =
        std::any_of(step.alive.begin(), step.alive.end(), [](const Twin& t) { return t.llr < k.weak_llr; });
    if (strong)
      from.reset();
    else if (!from)
      from = step.t_s;
  }
  return from;
}

RunIdentifiability identify_run(const IdentifyInput& input, const std::vector<TruthSample>& truth) {
  RunIdentifiability run;
  const Viewer viewer;
  std::vector<Twin> twins;
  for (const auto& [walked, sample] : stations(truth)) {
    const Place place = levelled(sample->X_WR, sample->sensor_z_W);
    if (run.steps.empty()) twins = find_twins(viewer, input, place);
    if (!twins.empty()) {
      const View seen = viewer.look(*input.as_built, place.position_W, place.yaw);
      const double own = viewer.cost(seen, viewer.look(*input.as_planned, place.position_W, place.yaw));
      for (Twin& twin : twins) {
        const Pose X = twin.twin * place.pose();
        twin.llr += viewer.cost(seen, viewer.look(*input.as_planned, X.t, X.yaw())) - own;
      }
      std::erase_if(twins, [](const Twin& twin) { return twin.llr > k.drop_llr; });
    }
    run.steps.push_back({sample->t_s, walked, twins});
  }
  conclude(run);
  return run;
}

}  // namespace plumbline::scenarios
