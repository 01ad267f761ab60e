// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/replay/replay_tracks.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>

#include "bim/model/rooms.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/metrics/storey.h"
#include "scenarios/report/replay/replay_scene.h"
#include "scenarios/score/handover.h"

namespace plumbline::scenarios {

namespace {

constexpr double mm = 0.001, ms = 0.001, mrad = 0.001;
constexpr double quaternion_unit = 1e-5;  // 0.02 mrad: 0.4 mm at 20 m
constexpr double error_unit = 1e-4;       // 0.1 mm
constexpr double share_unit = 1e-4;

/// Poses as columns of differences.
class Track {
 public:
  explicit Track(const Eigen::Vector3d& origin) : origin_(origin) {}

  void add(slam::Nanoseconds stamp, const Pose& X_WR, double error_m, bool lost) {
    t_.add(slam::seconds(stamp));
    const Eigen::Vector3d p = X_WR.t - origin_;
    for (int k = 0; k < 3; ++k) position_[static_cast<std::size_t>(k)].add(p[k]);
    const double sign = X_WR.q.w() < 0.0 ? -1.0 : 1.0;
    for (int k = 0; k < 4; ++k) rotation_[static_cast<std::size_t>(k)].add(sign * X_WR.q.coeffs()[k]);
    error_.add(error_m);
    lost_.add(lost ? 1.0 : 0.0);
  }

  [[nodiscard]] Tree take() {
    Tree tree = Tree::map();
    tree.set("t", t_.take());
    for (std::size_t k = 0; k < 3; ++k) tree.set(std::string(1, "xyz"[k]), position_[k].take());
    for (std::size_t k = 0; k < 4; ++k) tree.set("q" + std::to_string(k), rotation_[k].take());
    return tree.set("e", error_.take()).set("lost", lost_.take());
  }

 private:
  Eigen::Vector3d origin_;
  DeltaColumn t_{ms}, error_{error_unit}, lost_{1.0};
  std::array<DeltaColumn, 3> position_{DeltaColumn{mm}, DeltaColumn{mm}, DeltaColumn{mm}};
  std::array<DeltaColumn, 4> rotation_{DeltaColumn{quaternion_unit}, DeltaColumn{quaternion_unit},
                                       DeltaColumn{quaternion_unit}, DeltaColumn{quaternion_unit}};
};

Tree track_of(const MethodRecord& method, const score::Truth& truth, const Eigen::Vector3d& origin) {
  const std::vector<score::PosePair> pairs = score::associate(truth, method.causal, {});
  Track track(origin);
  if (pairs.empty()) return track.take();
  const Pose X_WF = method.localization ? Pose() : score::umeyama(pairs);
  const Pose shown_X_WF = method.localization ? Pose() : score::place_map(pairs);
  for (const score::PosePair& pair : pairs) {
    const slam::Nanoseconds stamp = truth.scans[pair.scan];
    track.add(stamp, shown_X_WF * pair.X_FR, (X_WF * pair.X_FR.t - pair.X_WR.t).norm(), said_lost(method, stamp));
  }
  return track.take();
}

Tree states_of(const std::vector<BeliefRecord>& beliefs) {
  Tree list = Tree::list();
  std::optional<std::pair<slam::State, std::size_t>> before;
  for (const BeliefRecord& belief : beliefs) {
    const std::pair now{belief.state, belief.hypotheses.size()};
    if (before == now) continue;
    list.push(Tree(Tree::List{whole(slam::seconds(belief.stamp), ms), static_cast<int>(now.first),
                              static_cast<std::int64_t>(now.second)}));
    before = now;
  }
  return list;
}

/// [[x0, y0, x1, y1 of the patch at the hypothesis], [ids of faces], right]; a wrong one has the wall that was seen,
/// too.
Tree walls_of(const slam::Hypothesis& hypothesis, const Pose& X_WR_true, const FinishedRun& run,
              const Eigen::Vector3d& origin) {
  Tree list = Tree::list();
  const std::vector<bool> right = score::right_matches(hypothesis.walls, X_WR_true, *run.building->plan_as_planned(),
                                                       run.building->plan_as_built());
  const std::vector<std::string> seen = score::walls_seen(hypothesis.walls, X_WR_true, run.building->plan_as_built());
  for (std::size_t i = 0; i < hypothesis.walls.size(); ++i) {
    const slam::WallMatch& match = hypothesis.walls[i];
    Tree patch = Tree::list(), faces = Tree::list();
    for (const Eigen::Vector3d& p_R : {match.p0_R, match.p1_R}) {
      const Eigen::Vector3d p = hypothesis.X_WR * p_R - origin;
      for (int k = 0; k < 2; ++k) patch.push(whole(p[k], mm));
    }
    for (const int face : match.faces) faces.push(face);
    Tree::List wall{std::move(patch), std::move(faces), right[i] ? 1 : 0};
    if (!right[i]) wall.emplace_back(seen[i]);
    list.push(Tree(std::move(wall)));
  }
  return list;
}

/// [share, x, y, z, yaw, room, [xx, xy, yy of the covariance, cm^2], walls]
Tree hypothesis_of(const slam::Hypothesis& hypothesis, const Pose& X_WR_true, const FinishedRun& run,
                   const Eigen::Vector3d& origin) {
  const Eigen::Vector3d p = hypothesis.X_WR.t - origin;
  Tree list = Tree::list();
  list.push(whole(hypothesis.mass, share_unit));
  for (int k = 0; k < 3; ++k) list.push(whole(p[k], mm));
  list.push(whole(hypothesis.X_WR.yaw(), mrad)).push(bim::room_name(run.building->as_built().rooms, hypothesis.room));
  const Eigen::Matrix3d& c = hypothesis.covariance;
  list.push(Tree(Tree::List{whole(c(0, 0), 1e-4), whole(c(0, 1), 1e-4), whole(c(1, 1), 1e-4)}));
  return list.push(walls_of(hypothesis, X_WR_true, run, origin));
}

/// The scans whose hypotheses are kept: one a second, where the state or their number changes, and those with
/// particles.
std::set<std::size_t> kept_of(const std::vector<BeliefRecord>& beliefs) {
  constexpr slam::Nanoseconds every = 1'000'000'000;
  std::set<std::size_t> kept;
  slam::Nanoseconds last = -every;
  for (std::size_t i = 0; i < beliefs.size(); ++i) {
    const bool changes = i == 0 || beliefs[i].state != beliefs[i - 1].state ||
                         beliefs[i].hypotheses.size() != beliefs[i - 1].hypotheses.size();
    const bool walls = std::any_of(beliefs[i].hypotheses.begin(), beliefs[i].hypotheses.end(),
                                   [](const slam::Hypothesis& hypothesis) { return !hypothesis.walls.empty(); });
    if (!changes && !walls && beliefs[i].particles.empty() && beliefs[i].stamp - last < every) continue;
    kept.insert(i);
    last = beliefs[i].stamp;
  }
  return kept;
}

Tree belief_of(const MethodRecord& method, const FinishedRun& run, const score::Truth& truth,
               const Eigen::Vector3d& origin) {
  constexpr std::size_t shown = 6;  // hypotheses; the page says how many more there are
  Tree sets = Tree::list(), particles = Tree::list();
  for (const std::size_t i : kept_of(method.beliefs)) {
    check_interrupt();
    const BeliefRecord& belief = method.beliefs[i];
    const Pose X_WR = truth.at(belief.stamp);
    const Tree t = whole(slam::seconds(belief.stamp), ms);
    Tree hypotheses = Tree::list();
    for (std::size_t k = 0; k < std::min(shown, belief.hypotheses.size()); ++k)
      hypotheses.push(hypothesis_of(belief.hypotheses[k], X_WR, run, origin));
    sets.push(Tree(Tree::List{t, static_cast<std::int64_t>(belief.hypotheses.size()), std::move(hypotheses)}));
    if (belief.particles.empty()) continue;
    Tree drawn = Tree::list();
    for (const slam::Particle& particle : belief.particles)
      drawn.push(whole(particle.x - origin.x(), 0.01)).push(whole(particle.y - origin.y(), 0.01));
    particles.push(Tree(Tree::List{t, std::move(drawn)}));
  }
  return Tree::map()
      .set("states", states_of(method.beliefs))
      .set("sets", std::move(sets))
      .set("particles", std::move(particles));
}

Tree point_of(const Pose& X_WF, const Eigen::Vector3d& p_F, const Eigen::Vector3d& origin) {
  const Eigen::Vector3d p = X_WF * p_F - origin;
  return Tree(Tree::List{whole(p.x(), mm), whole(p.y(), mm), whole(p.z(), mm)});
}

Tree keyframes_of(const Tree& graph, const Pose& X_WF, const Eigen::Vector3d& origin) {
  Tree list = Tree::list();
  for (const Tree& keyframe : graph.find("keyframes")->as_list()) {
    const Tree::List& X = keyframe.find("X_MR")->as_list();
    const Eigen::Vector3d p(X.at(0).as_double(), X.at(1).as_double(), X.at(2).as_double());
    Tree at = point_of(X_WF, p, origin);
    list.push(at.push(whole(keyframe.find("stamp_ns")->as_double() * 1e-9, ms)));
  }
  return list;
}

/// Pairs of indices, without repetition, in order.
Tree pairs_of(const Tree& graph, const char* factors, const char* from, const char* to) {
  std::set<std::pair<std::int64_t, std::int64_t>> pairs;
  if (const Tree* list = graph.find(factors))
    for (const Tree& factor : list->as_list()) {
      const Tree& end = *factor.find(to);
      if (end.is_list())
        for (const Tree& one : end.as_list()) pairs.emplace(factor.find(from)->as_int(), one.as_int());
      else
        pairs.emplace(factor.find(from)->as_int(), end.as_int());
    }
  Tree out = Tree::list();
  for (const auto& [a, b] : pairs) out.push(a).push(b);
  return out;
}

}  // namespace

Tree replay_tracks(const FinishedRun& run, const score::RunScore& score, const Eigen::Vector3d& origin) {
  Tree tracks = Tree::map();
  Track truth(origin);
  for (const slam::Nanoseconds stamp : score.truth.scans) truth.add(stamp, score.truth.at(stamp), 0.0, false);
  tracks.set("truth", truth.take());
  for (const MethodRecord& method : run.record.methods)
    if (method.name != "truth") tracks.set(method.name, track_of(method, score.truth, origin));
  return tracks;
}

Tree replay_beliefs(const FinishedRun& run, const score::RunScore& score, const Eigen::Vector3d& origin) {
  Tree beliefs = Tree::map();
  for (const MethodRecord& method : run.record.methods)
    if (!method.beliefs.empty()) beliefs.set(method.name, belief_of(method, run, score.truth, origin));
  return beliefs;
}

Pose map_pose(const MethodRecord& method, const score::MethodScore& score) {
  return method.localization || !score.trajectory ? Pose() : score.trajectory->X_WF_final;
}

Tree replay_graph(const MethodRecord& method, const score::MethodScore& score, const Tree& graph,
                  const Eigen::Vector3d& origin) {
  if (graph.find("keyframes") == nullptr) return {};
  const Pose X_WF = map_pose(method, score);
  Tree walls = Tree::list(), rooms = Tree::list(), floors = Tree::list();
  for (const slam::PlaneNode& plane : method.estimate.planes) {
    const double z = 0.5 * (plane.z0 + plane.z1);
    walls.push(Tree(Tree::List{plane.id, point_of(X_WF, {plane.p0.x(), plane.p0.y(), z}, origin),
                               point_of(X_WF, {plane.p1.x(), plane.p1.y(), z}, origin), plane.observations}));
  }
  for (const slam::RoomNode& room : method.estimate.rooms) {
    const double z = score::height_of_room(method.estimate, room).value_or(0.0);
    rooms.push(Tree(Tree::List{room.id, point_of(X_WF, {room.center_F.x(), room.center_F.y(), z}, origin)}));
  }
  for (const slam::FloorNode& floor : method.estimate.floors)
    floors.push(Tree(Tree::List{floor.id, point_of(X_WF, floor.center_F, origin)}));
  return Tree::map()
      .set("keyframes", keyframes_of(graph, X_WF, origin))
      .set("walls", std::move(walls))
      .set("rooms", std::move(rooms))
      .set("floors", std::move(floors))
      .set("keyframe_wall", pairs_of(graph, "plane_factors", "keyframe", "plane"))
      .set("room_wall", pairs_of(graph, "room_factors", "room", "planes"))
      .set("floor_room", pairs_of(graph, "floor_factors", "floor", "room"));
}

}  // namespace plumbline::scenarios
