// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/lidar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "bim/errors.h"
#include "bim/random/stream.h"
#include "sim/lidar/airborne.h"
#include "sim/lidar/beams.h"
#include "sim/lidar/detector.h"
#include "sim/lidar/echo.h"
#include "sim/lidar/edges.h"
#include "sim/lidar/footprint.h"
#include "sim/lidar/light.h"

namespace plumbline::sim {

namespace {

using slam::ReturnMode;
using slam::ReturnWord;

constexpr std::int64_t full_turn = 360'000'000'000;  // 1e-9 degrees
constexpr double units_to_rad = std::numbers::pi / 180.0 * 1e-9;
constexpr std::int64_t units_per_cdeg = 10'000'000;
constexpr double room_step_m = 0.05;     // a return is in the room where its light came from
constexpr std::size_t batch_beams = 64;  // beams that are traced together

/// A beam that can give several echoes: it is traced after the beams of one diffuse surface.
struct MultiEchoBeam {
  std::uint32_t column = 0;
  std::uint32_t laser = 0;
  bool bundle = false;  ///< cast as sub-rays
};

}  // namespace

struct Lidar::Impl {
  LidarConfig config;
  const slam::LidarModel& model;
  const bim::RayScene& scene;
  std::vector<Surface> surfaces;
  const RoomLookup* rooms;
  Detector detector;
  std::optional<Airborne> airborne;
  Beams centres;
  EdgeFinder edges;
  SubRays footprint;

  // Memory of one sweep, used again.
  std::int64_t first_firing = 0;
  std::vector<std::uint8_t> bundle;  ///< by beam, as words: cast as sub-rays
  std::vector<MultiEchoBeam> multi_echo;
  std::vector<RaySegment> segments;
  std::vector<bim::Ray> segment_rays;
  std::vector<bim::Hit> segment_hits;
  std::vector<Reflection> reflections;
  std::vector<Reflection> grouped;
  std::vector<std::pair<std::uint32_t, std::size_t>> order;
  std::vector<Echo> echoes;
  Light light;

  Impl(const LidarConfig& config_in, double rpm, Seed seed, const bim::RayScene& scene_in,
       std::vector<Surface> surfaces_in, const RoomLookup* rooms_in);

  [[nodiscard]] std::size_t slot(std::size_t column, std::size_t laser) const {
    return column * model.lasers.size() + static_cast<std::size_t>(model.lasers[laser].ring);
  }
  void start(std::int64_t first, std::span<const Pose> poses, Sweep& sweep);
  void fire_single_echo(Sweep& sweep);
  void fire_multi_echo(std::span<const MultiEchoBeam> beams, Sweep& sweep);
  void group_by_beam();
  void add_segments(const MultiEchoBeam& beam, std::uint32_t number);
  void receive(const MultiEchoBeam& beam, Sweep& sweep);
  void add_airborne(Sweep& sweep) const;
  void label(std::size_t slot, const Reflection& reflection, ReturnLabels& labels) const;
  void pack(Sweep& sweep) const;
};

Lidar::Impl::Impl(const LidarConfig& config_in, double rpm, Seed seed, const bim::RayScene& scene_in,
                  std::vector<Surface> surfaces_in, const RoomLookup* rooms_in)
    : config(config_in),
      model(slam::lidar_model(config.model)),
      scene(scene_in),
      surfaces(std::move(surfaces_in)),
      rooms(rooms_in),
      detector(config, seed),
      centres(model, rpm,
              static_cast<std::int64_t>(Stream(seed, "sim.lidar.phase").uniform(0) * static_cast<double>(full_turn))),
      edges(config, scene),
      footprint(footprint_of(config)),
      light(scene, surfaces, config) {
  (void)slam::firings_per_message(model, rpm);
  if (config.airborne_per_m > 0.0) airborne.emplace(config, seed);
}

void Lidar::Impl::start(std::int64_t first, std::span<const Pose> poses, Sweep& sweep) {
  first_firing = first;
  const std::size_t size = poses.size() * model.lasers.size();
  sweep.words.assign(size, {});
  sweep.last.assign(config.returns == ReturnMode::dual ? size : 0, {});
  sweep.azimuth.resize(poses.size());
  sweep.azimuth_cdeg.resize(poses.size());
  sweep.labels.element.assign(size, -1);
  sweep.labels.triangle.assign(size, -1);
  sweep.labels.path.assign(size, 0);
  sweep.labels.point_W.assign(size, Eigen::Vector3d::Zero());
  sweep.labels.room.assign(size, -1);
  for (std::size_t c = 0; c < poses.size(); ++c) {
    const std::int64_t units = centres.azimuth(first + static_cast<std::int64_t>(c));
    const std::int64_t cdeg = (units + units_per_cdeg / 2) / units_per_cdeg;
    sweep.azimuth_cdeg[c] = static_cast<std::uint16_t>(cdeg % (full_turn / units_per_cdeg));
    sweep.azimuth[c] = static_cast<double>(units) * units_to_rad;
  }
}

/// Measures the beams that hit one diffuse surface; collects the others in multi_echo.
void Lidar::Impl::fire_single_echo(Sweep& sweep) {
  multi_echo.clear();
  const std::size_t lasers = model.lasers.size();
  for (std::size_t column = 0; column < centres.columns(); ++column) {
    const auto c = static_cast<std::int64_t>(column);
    for (std::size_t k = 0; k < lasers; ++k) {
      const std::size_t i = centres.index(c, k);
      const bim::Hit& hit = centres.hit(i);
      const bool wide = bundle[column * lasers + k] != 0;
      if (!wide && hit.element < 0) continue;
      const Surface surface = hit.element < 0 ? Surface{} : light.surface(hit.element);
      if (wide || (config.optics && !surface.is_diffuse())) {
        multi_echo.push_back({static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(k), wide});
        continue;
      }
      const double cosine = std::abs(hit.normal_W.dot(centres.ray(i).direction_W));
      const ReturnWord word = detector.measure(first_firing + c, k, 0, hit.range_m, surface.reflectivity, cosine);
      if (word.distance == 0) continue;
      sweep.words[column * lasers + k] = word;
      if (config.returns == ReturnMode::dual) sweep.last[column * lasers + k] = word;
      Reflection reflection;
      reflection.element = hit.element;
      reflection.triangle = hit.triangle;
      reflection.direction_W = centres.ray(i).direction_W;
      reflection.point_W = centres.ray(i).origin_W + hit.range_m * centres.ray(i).direction_W;
      label(slot(column, k), reflection, sweep.labels);
    }
  }
}

/// Sub-rays of a beam, or its central ray where it needs no footprint.
void Lidar::Impl::add_segments(const MultiEchoBeam& beam, std::uint32_t number) {
  const std::size_t i = centres.index(beam.column, beam.laser);
  RaySegment segment;
  segment.beam = number;
  segment.ray = centres.ray(i);
  if (!beam.bundle) {
    segments.push_back(segment);
    return;
  }
  segment.gain = 1.0 / static_cast<double>(footprint.size());
  const Tangents tangents = centres.tangents(beam.column, beam.laser);
  for (const SubRay& sub : footprint) {
    segment.ray = sub_ray(centres.ray(i), tangents, sub);
    segments.push_back(segment);
  }
}

/// Brings the reflections of each beam together, in the order in which they were found.
void Lidar::Impl::group_by_beam() {
  const auto by_beam = [](const Reflection& a, const Reflection& b) { return a.beam < b.beam; };
  if (std::is_sorted(reflections.begin(), reflections.end(), by_beam)) return;
  order.clear();
  for (std::size_t i = 0; i < reflections.size(); ++i) order.emplace_back(reflections[i].beam, i);
  std::sort(order.begin(), order.end());
  grouped.clear();
  for (const auto& [beam, i] : order) grouped.push_back(reflections[i]);
  reflections.swap(grouped);
}

void Lidar::Impl::fire_multi_echo(std::span<const MultiEchoBeam> beams, Sweep& sweep) {
  segments.clear();
  reflections.clear();
  for (std::size_t i = 0; i < beams.size(); ++i) add_segments(beams[i], static_cast<std::uint32_t>(i));
  segment_rays.clear();
  for (const RaySegment& segment : segments) segment_rays.push_back(segment.ray);
  segment_hits.resize(segments.size());
  scene.cast(segment_rays, model.range_max_m, segment_hits);
  light.trace(segments, segment_hits, reflections);
  group_by_beam();
  for (std::size_t begin = 0; begin < reflections.size();) {
    std::size_t end = begin + 1;
    while (end < reflections.size() && reflections[end].beam == reflections[begin].beam) ++end;
    find_echoes(std::span(reflections).subspan(begin, end - begin), config.echo_separation_m, echoes);
    receive(beams[reflections[begin].beam], sweep);
    begin = end;
  }
}

/// Detects the echoes of one beam and keeps those of the return mode.
void Lidar::Impl::receive(const MultiEchoBeam& beam, Sweep& sweep) {
  struct Detected {
    ReturnWord word;
    const Echo* echo = nullptr;
  };
  Detected strongest, second, last;
  for (std::size_t rank = 0; rank < echoes.size(); ++rank) {
    const Echo& echo = echoes[rank];
    const ReturnWord word = detector.measure(first_firing + beam.column, beam.laser, static_cast<std::uint32_t>(rank),
                                             echo.range_m, echo.strength, echo.cosine);
    if (word.distance == 0) continue;
    last = {word, &echo};
    if (strongest.echo == nullptr || echo.energy > strongest.echo->energy)
      second = std::exchange(strongest, last);
    else if (second.echo == nullptr || echo.energy > second.echo->energy)
      second = last;
  }
  if (last.echo == nullptr) return;
  const std::size_t i = beam.column * model.lasers.size() + beam.laser;
  if (config.returns == ReturnMode::last) strongest = last;
  if (config.returns == ReturnMode::dual) {
    sweep.last[i] = last.word;
    if (last.echo == strongest.echo && second.echo != nullptr) strongest = second;
  }
  sweep.words[i] = strongest.word;
  const bool last_seems_stronger =
      config.returns == ReturnMode::dual && !slam::seems_stronger(strongest.word, last.word);
  label(slot(beam.column, beam.laser), (last_seems_stronger ? last : strongest).echo->main, sweep.labels);
}

/// A particle before the first surface gives its return in place of the strongest, and of the last where that is lost.
void Lidar::Impl::add_airborne(Sweep& sweep) const {
  const std::size_t lasers = model.lasers.size();
  for (std::size_t column = 0; column < centres.columns(); ++column) {
    const auto c = static_cast<std::int64_t>(column);
    for (std::size_t k = 0; k < lasers; ++k) {
      const std::optional<double> range_m = airborne->at(first_firing + c, k);
      const std::size_t beam = centres.index(c, k);
      const bim::Hit& hit = centres.hit(beam);
      if (!range_m || (hit.element >= 0 && *range_m >= hit.range_m)) continue;
      const std::size_t i = column * lasers + k;
      const ReturnWord word = airborne->word(*range_m);
      if (config.returns == ReturnMode::last && sweep.words[i].distance != 0) continue;
      sweep.words[i] = word;
      if (config.returns == ReturnMode::dual) {
        if (sweep.last[i].distance == 0) sweep.last[i] = word;
        if (!slam::seems_stronger(word, sweep.last[i])) continue;
      }
      Reflection reflection;
      reflection.flags = light_path::airborne;
      reflection.direction_W = centres.ray(beam).direction_W;
      reflection.point_W = centres.ray(beam).origin_W + *range_m * reflection.direction_W;
      label(slot(column, k), reflection, sweep.labels);
    }
  }
}

void Lidar::Impl::label(std::size_t slot, const Reflection& reflection, ReturnLabels& labels) const {
  labels.element[slot] = reflection.element;
  labels.triangle[slot] = reflection.triangle;
  labels.path[slot] = reflection.flags;
  labels.point_W[slot] = reflection.point_W;
  if (rooms != nullptr) labels.room[slot] = rooms->at(reflection.point_W - room_step_m * reflection.direction_W);
}

void Lidar::Impl::pack(Sweep& sweep) const {
  sweep.packets.clear();
  if (model.product == 0) return;
  const auto firings = static_cast<std::size_t>(slam::firings_in_packet(model, config.returns));
  const std::size_t lasers = model.lasers.size();
  sweep.packets.resize(centres.columns() / firings);
  for (std::size_t p = 0; p < sweep.packets.size(); ++p) {
    const std::size_t f = p * firings;
    const auto words = std::span<const ReturnWord>(sweep.words).subspan(f * lasers, firings * lasers);
    const auto last = sweep.last.empty()
                          ? std::span<const ReturnWord>()
                          : std::span<const ReturnWord>(sweep.last).subspan(f * lasers, firings * lasers);
    slam::encode_packet(model, config.returns, (first_firing + static_cast<std::int64_t>(f)) * model.firing_period_ns,
                        std::span<const std::uint16_t>(sweep.azimuth_cdeg).subspan(f, firings), words, last,
                        sweep.packets[p]);
  }
}

Lidar::Lidar(LidarPreset preset, double rpm, Seed seed, const bim::RayScene& scene)
    : Lidar(lidar_config(preset), rpm, seed, scene) {}
Lidar::Lidar(const LidarConfig& config, double rpm, Seed seed, const bim::RayScene& scene,
             std::vector<Surface> surfaces, const RoomLookup* rooms)
    : impl_(std::make_unique<Impl>(config, rpm, seed, scene, std::move(surfaces), rooms)) {}
Lidar::~Lidar() = default;

const slam::LidarModel& Lidar::model() const { return impl_->model; }

void Lidar::sweep(std::int64_t first_firing, std::span<const Pose> X_WL, Sweep& sweep) const {
  const auto per_packet = static_cast<std::size_t>(impl_->model.firings_per_packet);
  if (first_firing < 0 || X_WL.empty() || X_WL.size() % per_packet != 0)
    throw InternalError("Lidar::sweep: poses of whole packets are needed");
  impl_->start(first_firing, X_WL, sweep);
  impl_->centres.cast(first_firing, X_WL, impl_->scene);
  impl_->bundle.assign(X_WL.size() * impl_->model.lasers.size(),
                       impl_->config.footprint == Footprint::everywhere ? 1 : 0);
  if (impl_->config.footprint == Footprint::edges) impl_->edges.find(impl_->centres, impl_->bundle);
  impl_->fire_single_echo(sweep);
  const std::span<const MultiEchoBeam> multi_echo = impl_->multi_echo;
  for (std::size_t i = 0; i < multi_echo.size(); i += batch_beams)
    impl_->fire_multi_echo(multi_echo.subspan(i, std::min(batch_beams, multi_echo.size() - i)), sweep);
  if (impl_->airborne) impl_->add_airborne(sweep);
  impl_->pack(sweep);
}

Sweep Lidar::sweep(std::int64_t first_firing, std::span<const Pose> X_WL) const {
  Sweep out;
  sweep(first_firing, X_WL, out);
  return out;
}

slam::Scan Lidar::decode(std::int64_t first_firing, const Sweep& sweep, bool vertical_offsets) const {
  if (!sweep.packets.empty()) return slam::decode_message(sweep.packets, vertical_offsets);
  return slam::scan_of_words(impl_->model, first_firing * impl_->model.firing_period_ns, sweep.azimuth, sweep.words,
                             vertical_offsets);
}

}  // namespace plumbline::sim
