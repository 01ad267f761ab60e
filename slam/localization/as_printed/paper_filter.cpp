// SPDX-License-Identifier: Apache-2.0
#include "slam/localization/as_printed/paper_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/errors.h"

namespace plumbline::slam {

namespace {

constexpr double pi = std::numbers::pi;
// A particle outside of every room, where none may be.
constexpr double outside_cost = 30.0;

Eigen::Quaterniond tilt(double roll, double pitch) { return exp_so3({0.0, pitch, 0.0}) * exp_so3({roll, 0.0, 0.0}); }

}  // namespace

PaperFilter::PaperFilter(const PaperFilterConfig& config, const PaperSwitches& switches, const MethodInput& input,
                         const PlanIndex& index)
    : config_(config), switches_(switches), input_(input), index_(index) {
  for (const StoreyIndex& storey : index.storeys)
    storeys_.push_back(make_paper_storey(*input.plan, storey, index.config.wall_band_m, switches.faces));
}

void PaperFilter::update(const PlanScan& scan, const std::vector<PlaneObservation>& planes, const Pose& X_OR_last) {
  if (particles_.empty())
    start(scan, planes);
  else
    predict(scan, X_OR_last);
  std::vector<PlaneObservation> walls;
  std::copy_if(planes.begin(), planes.end(), std::back_inserter(walls),
               [](const PlaneObservation& plane) { return plane.vertical; });
  if (walls.empty()) return;
  update_weights(scan, walls);
  update_convergence(scan.u.t.norm());
  resample(scan.tick);
}

/// Uniform over the rooms, yaw from the prior or uniform.
void PaperFilter::start(const PlanScan& scan, const std::vector<PlaneObservation>& planes) {
  const Stream stream(input_.seed, "slam.localize.init");
  FilterConfig even;
  even.max_particles = config_.particles;
  even.density_per_m2 = 1.2 * config_.particles / index_.free_area();  // so that the number above decides
  particles_ = sample_initial_particles(index_, {.yaw_I = 0.0, .yaw_sigma = 0.0}, {}, even, input_.seed, scan.tick);
  rest_.assign(particles_.size(), {});
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const auto lane = static_cast<std::uint32_t>(i);
    const StoreyIndex& storey = index_.storeys[static_cast<std::size_t>(particles_[i].storey)];
    rest_[i].z = (storey.ceiling_z - storey.floor_z) * stream.uniform(scan.tick, lane, 20);
    rest_[i].roll = config_.tilt_rad * (2.0 * stream.uniform(scan.tick, lane, 21) - 1.0);
    rest_[i].pitch = config_.tilt_rad * (2.0 * stream.uniform(scan.tick, lane, 22) - 1.0);
    find_room(i);
    particles_[i].X_IH.yaw = sample_yaw(i, scan, planes, stream);
  }
}

double PaperFilter::sample_yaw(std::size_t i, const PlanScan& scan, const std::vector<PlaneObservation>& planes,
                               const Stream& stream) const {
  const auto lane = static_cast<std::uint32_t>(i);
  if (scan.prior_yaw_I) return wrap_angle(*scan.prior_yaw_I + scan.prior_yaw_sigma * stream.gauss(scan.tick, lane, 23));
  const double uniform = wrap_angle(2.0 * pi * stream.uniform(scan.tick, lane, 23));
  const std::vector<int>& walls = candidates(particles_[i].storey, rest_[i].room);
  if (switches_.yaw == PaperVariant::printed || planes.empty() || walls.empty() ||
      stream.uniform(scan.tick, lane, 24) < 0.5)
    return uniform;
  const auto pick = [&](std::size_t n, std::uint32_t draw) {
    return static_cast<std::size_t>(stream.uniform(scan.tick, lane, draw) * static_cast<double>(n));
  };
  const Eigen::Vector3d n_H = scan.q_HR * planes[pick(planes.size(), 25)].plane_R.n;
  const PaperStorey& storey = storeys_[static_cast<std::size_t>(particles_[i].storey)];
  const Plane& mapped = storey.walls[static_cast<std::size_t>(walls[pick(walls.size(), 26)])].plane_W;
  const double yaw_W = std::atan2(mapped.n.y(), mapped.n.x()) - std::atan2(n_H.y(), n_H.x());
  return wrap_angle(yaw_W - index_.X_WI.yaw() + pi / 12.0 * stream.gauss(scan.tick, lane, 27));
}

void PaperFilter::find_room(std::size_t i) {
  const PaperStorey& storey = storeys_[static_cast<std::size_t>(particles_[i].storey)];
  const Eigen::Vector2d p_W = heading(index_.X_WI) * particles_[i].X_IH.t;
  const int room = storey.room_at(p_W, switches_.outline);
  // In a door the last room is kept; farther out there is none.
  constexpr double door_m = 0.5;
  const bool in_door = switches_.roomless == PaperVariant::corrected && room < 0 && rest_[i].room >= 0 &&
                       boundary_distance(storey.rooms[static_cast<std::size_t>(rest_[i].room)].polygon_W, p_W) < door_m;
  if (!in_door) rest_[i].room = room;
}

/// x_t ~ p(x_t | x_t-1, u) [shaheer2023, eq. 4], u = x_t^-1 x_t-1 as printed [shaheer2023, eq. 5], or its inverse.
void PaperFilter::predict(const PlanScan& scan, const Pose& X_OR_last) {
  const Stream stream(input_.seed, "slam.localize.motion");
  const Pose forward = X_OR_last.inverse() * scan.X_OR;
  const Pose2 u = switches_.increment == PaperVariant::corrected ? scan.u : scan.u.inverse();
  const double walked = forward.t.norm(), turned = std::abs(scan.u.yaw);
  const double trans = config_.min_trans_m + config_.trans_per_m * walked;
  const double rot = config_.min_rot_rad + std::hypot(config_.rot_per_rad * turned, config_.rot_per_m * walked);
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const auto lane = static_cast<std::uint32_t>(i);
    const Eigen::Vector2d noise(stream.gauss(scan.tick, lane, 0), stream.gauss(scan.tick, lane, 1));
    particles_[i].X_IH =
        particles_[i].X_IH * Pose2{u.t + trans * noise, wrap_angle(u.yaw + rot * stream.gauss(scan.tick, lane, 2))};
    if (switches_.state == PaperVariant::printed) {
      rest_[i].z += forward.t.z() + trans * stream.gauss(scan.tick, lane, 3);
      rest_[i].roll += rot * stream.gauss(scan.tick, lane, 4);
      rest_[i].pitch += rot * stream.gauss(scan.tick, lane, 5);
    }
    find_room(i);
  }
}

Pose PaperFilter::pose_W(std::size_t i, const PlanScan& scan) const {
  const LocalParticle& particle = particles_[i];
  const bool free = switches_.state == PaperVariant::printed;
  const double floor = index_.storeys[static_cast<std::size_t>(particle.storey)].floor_z;
  const double robot_height = input_.calibration.sensor_height_m - (scan.q_HR * input_.calibration.X_RL.t).z();
  const double z = floor + (free ? rest_[i].z : robot_height);
  const Eigen::Quaterniond q = free ? tilt(rest_[i].roll, rest_[i].pitch) : scan.q_HR;
  return index_.X_WI * (Pose::from_xyz_yaw({particle.X_IH.t.x(), particle.X_IH.t.y(), z}, particle.X_IH.yaw) *
                        Pose{q, Eigen::Vector3d::Zero()});
}

const std::vector<int>& PaperFilter::candidates(int storey, int room) const {
  const PaperStorey& walls = storeys_[static_cast<std::size_t>(storey)];
  if (!switches_.rooms || room < 0) return walls.all;
  const PaperRoom& in = walls.rooms[static_cast<std::size_t>(room)];
  return switches_.roomless == PaperVariant::corrected ? in.with_neighbours : in.walls;
}

/// Half of the patch on the face, and nothing of the plan before its middle.
bool PaperFilter::on_face(int storey, const PaperWall& wall, const PlaneObservation& plane, const Pose& X_WR) const {
  constexpr double margin_m = 0.3;
  const Eigen::Vector2d e = (wall.p1_W - wall.p0_W).normalized();
  const double length = (wall.p1_W - wall.p0_W).norm();
  const double a = e.dot((X_WR * plane.p0_R).head<2>() - wall.p0_W),
               b = e.dot((X_WR * plane.p1_R).head<2>() - wall.p0_W);
  const double overlap = std::min(std::max(a, b), length + margin_m) - std::max(std::min(a, b), -margin_m);
  if (overlap < 0.5 * std::abs(a - b)) return false;
  const StoreyIndex& index = index_.storeys[static_cast<std::size_t>(storey)];
  const Pose2 X_IW = heading(index_.X_WI).inverse();
  const Eigen::Vector2d from = X_IW * (X_WR * input_.calibration.X_RL.t).head<2>();
  const Eigen::Vector2d to = X_IW * (X_WR * plane.centroid_R).head<2>();
  const double distance = (to - from).norm();
  if (distance < 1e-3) return false;
  const PlanRay ray{from, (to - from) / distance, index.floor_z + index_.config.wall_band_m, 0.0};
  const PlanHit hit = index.grid.cast(index.segments, ray, distance + margin_m);
  return hit.segment < 0 || hit.distance > distance - 2.0 * margin_m ||
         index.segments[static_cast<std::size_t>(hit.segment)].plan_face == wall.plan_face;
}

std::vector<PaperFilter::Landmark> PaperFilter::landmarks(int storey, int room, const Pose& X_LW) const {
  const PaperStorey& map = storeys_[static_cast<std::size_t>(storey)];
  std::vector<Landmark> landmarks;
  for (const int w : candidates(storey, room)) {
    const PaperWall& wall = map.walls[static_cast<std::size_t>(w)];
    const Plane plane = switches_.frame == PaperVariant::corrected ? X_LW * wall.plane_W : wall.plane_W;
    landmarks.push_back({paper_form(plane, switches_.form), axis_of(wall.plane_W.n), &wall});
  }
  return landmarks;
}

/// The landmark within the gate that is nearest in minimal form [shaheer2023, eq. 7] (ties: the first), or nothing.
std::optional<PaperFilter::Match> PaperFilter::match(int storey, const std::vector<Landmark>& landmarks,
                                                     const PlaneObservation& plane, const Pose& X_WR,
                                                     const Pose& X_LW) const {
  const Plane plane_W = X_WR * plane.plane_R;  // [shaheer2023, eq. 6]
  const AnglePlane seen =
      paper_form(switches_.frame == PaperVariant::corrected ? X_LW * plane_W : plane_W, switches_.form);
  const PlaneAxis axis = axis_of(plane_W.n);
  const Eigen::Vector3d sigma = sigmas();
  std::optional<Match> best;
  for (const Landmark& landmark : landmarks) {
    if (switches_.classes == PaperVariant::printed && landmark.axis != axis) continue;
    const Eigen::Vector3d e = paper_difference(seen, landmark.form, switches_.wrap);
    const double distance = e.cwiseQuotient(sigma).squaredNorm();
    if (distance >= (best ? best->distance : config_.gate)) continue;
    if (switches_.extent == PaperVariant::corrected && !on_face(storey, *landmark.wall, plane, X_WR)) continue;
    best = Match{distance, e};
  }
  return best;
}

/// What one plane adds to the log of the weight.
double PaperFilter::log_factor(const std::optional<Match>& match) const {
  const Eigen::Vector3d sigma = sigmas();
  const double log_det = 2.0 * std::log(sigma.prod()) + 3.0 * std::log(2.0 * pi);
  const double gauss = match ? -0.5 * match->distance - 0.5 * log_det : 0.0;
  if (switches_.planes == PaperVariant::corrected) {
    const double volume = 8.0 * std::pow(config_.gate, 1.5) * sigma.prod();
    return std::log((match ? (1.0 - config_.outlier) * std::exp(gauss) : 0.0) + config_.outlier / volume);
  }
  if (!match) return 0.0;
  if (switches_.weight == PaperVariant::corrected) return gauss;
  // [shaheer2023, eq. 8-9]: mu exp(-tau (phi + theta + d)), tau = 2 sigma^2, mu = (2 pi sigma^2)^-1/2.
  const double tau = 2.0 * config_.sigma_offset_m * config_.sigma_offset_m;
  return -tau * match->e.sum() - 0.5 * std::log(pi * tau);
}

double PaperFilter::log_weight(int storey, int room, const Pose& X_WR,
                               const std::vector<PlaneObservation>& planes) const {
  const Pose X_LW = (X_WR * Pose{Eigen::Quaterniond::Identity(), input_.calibration.X_RL.t}).inverse();
  const std::vector<Landmark> walls = landmarks(storey, room, X_LW);
  double sum = 0.0;
  for (const PlaneObservation& plane : planes) sum += log_factor(match(storey, walls, plane, X_WR, X_LW));
  return sum;
}

void PaperFilter::update_weights(const PlanScan& scan, const std::vector<PlaneObservation>& planes) {
  std::vector<double> log_weights(particles_.size());
  double top = -1e300;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    log_weights[i] = log_weight(particles_[i].storey, rest_[i].room, pose_W(i, scan), planes);
    if (switches_.roomless == PaperVariant::corrected && rest_[i].room < 0) log_weights[i] -= outside_cost;
    top = std::max(top, log_weights[i]);
  }
  constexpr double effective_share = 0.1;
  const double floor = effective_share * static_cast<double>(particles_.size());
  const double a = switches_.tempering == PaperVariant::corrected ? temper(particles_, log_weights, top, floor) : 1.0;
  for (std::size_t i = 0; i < particles_.size(); ++i) particles_[i].weight *= std::exp(a * (log_weights[i] - top));
  normalise(particles_);
  best_ = *std::max_element(particles_.begin(), particles_.end(),
                            [](const LocalParticle& p, const LocalParticle& q) { return p.weight < q.weight; });
}

/// [shaheer2023, section 3.3.6]: the best particle against the average of all; once is enough, and for good.
void PaperFilter::update_convergence(double walked) {
  if (switches_.convergence == PaperVariant::corrected) {
    ParticleSet copy = particles_;
    const Clustering clustering = find_clusters(copy, {});
    const bool converged = !clustering.clusters.empty() && clustering.clusters.front().compact &&
                           clustering.clusters.front().mass >= config_.top_mass;
    converged_travel_m_ = converged && converged_updates_ > 0 ? converged_travel_m_ + walked : 0.0;
    converged_updates_ = converged ? converged_updates_ + 1 : 0;
    if (converged_updates_ >= config_.updates && converged_travel_m_ >= config_.travel_m) converged_ = true;
    return;
  }
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  double c = 0.0, s = 0.0;
  for (const LocalParticle& particle : particles_) {
    mean += particle.X_IH.t / static_cast<double>(particles_.size());
    c += std::cos(particle.X_IH.yaw);
    s += std::sin(particle.X_IH.yaw);
  }
  const double turn = std::abs(wrap_angle(std::atan2(s, c) - best_.X_IH.yaw));
  if ((mean - best_.X_IH.t).norm() < config_.converged_m && turn < config_.converged_rad) converged_ = true;
}

void PaperFilter::resample(std::uint64_t tick) {
  const double n = static_cast<double>(particles_.size());
  const bool systematic = switches_.resampling == PaperVariant::corrected;
  if (systematic && effective_size(particles_) >= 0.5 * n) return;
  const Stream stream(input_.seed, "slam.localize.resample");
  std::vector<double> reached;
  double sum = 0.0;
  for (const LocalParticle& particle : particles_) reached.push_back(sum += particle.weight);
  ParticleSet drawn;
  std::vector<Rest> rest;
  const double start = stream.uniform(tick);
  for (std::size_t k = 0; k < particles_.size(); ++k) {
    const auto lane = static_cast<std::uint32_t>(k);
    const double target = sum * (systematic ? (static_cast<double>(k) + start) / n : stream.uniform(tick, lane, 1));
    const auto from =
        static_cast<std::size_t>(std::upper_bound(reached.begin(), reached.end() - 1, target) - reached.begin());
    drawn.push_back(particles_[from]);
    drawn.back().weight = 1.0 / n;
    rest.push_back(rest_[from]);
  }
  particles_ = std::move(drawn);
  rest_ = std::move(rest);
}

}  // namespace plumbline::slam
