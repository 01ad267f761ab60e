// SPDX-License-Identifier: Apache-2.0
#include "bim/symmetry/symmetry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/geometry/pose.h"
#include "bim/symmetry/symmetry_scene.h"

namespace plumbline::bim {

namespace {

constexpr double half_turn_rounding = 1e-3;  ///< rad, what a storey's own rounding amounts to

/// A turn that directions of surfaces do not show, about a small shift.
bool is_identity(const Isometry2& g, const SymmetryScene& scene, const SymmetryConfig& config) {
  return !g.mirrored && std::abs(g.angle) < config.direction_max &&
         (g * scene.centroid() - scene.centroid()).norm() < config.near_m;
}

/// The same motion, found from two surfaces whose directions are rounded.
bool is_same(const StoreySymmetry& a, const StoreySymmetry& b, const SymmetryScene& from,
             const SymmetryConfig& config) {
  return std::abs(wrap_angle(a.isometry.angle - b.isometry.angle)) < config.direction_max &&
         (a.isometry * from.centroid() - b.isometry * from.centroid()).norm() < config.match_m;
}

/// Storeys that a robot may walk on and see something.
/// Adds to `left_out` what is in none of them.
std::vector<SymmetryScene> scenes_of(const Building& building, const SymmetryConfig& config,
                                     std::vector<std::string>& left_out) {
  std::vector<SymmetryScene> scenes;
  for (std::size_t i = 0; i < building.storeys.size(); ++i) {
    const int storey = static_cast<int>(i);
    const bool rooms = std::any_of(building.rooms.begin(), building.rooms.end(),
                                   [&](const Room& room) { return room.storey == storey; });
    if (building.storeys[i].kind != StoreyKind::habitable || (!building.rooms.empty() && !rooms)) continue;
    SymmetryScene scene(building, storey, config);
    left_out.insert(left_out.end(), scene.left_out().begin(), scene.left_out().end());
    if (scene.volume_m3() > 0.0) scenes.push_back(std::move(scene));
  }
  return scenes;
}

/// Adds a motion where it holds; of two that are the same the one that deviates less stays.
void try_motion(const SymmetryScene& from, const SymmetryScene& to, const Isometry2& g, const SymmetryConfig& config,
                std::vector<StoreySymmetry>& found) {
  if (&from == &to && is_identity(g, from, config)) return;
  const Similarity similarity = compare(from, to, g, config);
  if (similarity.grade == SimilarityGrade::different) return;
  const StoreySymmetry fresh{from.storey(), to.storey(), g, similarity};
  const auto same = std::find_if(found.begin(), found.end(),
                                 [&](const StoreySymmetry& other) { return is_same(other, fresh, from, config); });
  if (same == found.end())
    found.push_back(fresh);
  else if (similarity.deviation_m < same->similarity.deviation_m)
    *same = fresh;
}

std::vector<StoreySymmetry> found_between(const SymmetryScene& from, const SymmetryScene& to, bool mirrored,
                                          const SymmetryConfig& config) {
  std::vector<StoreySymmetry> found;
  for (const Isometry2& g : candidates(from, to, mirrored, config)) try_motion(from, to, g, config, found);
  if (&from == &to && !mirrored) {
    // Rounded directions may show a turn and not its inverse.
    const std::vector<StoreySymmetry> shown = found;
    for (const StoreySymmetry& symmetry : shown) {
      const StoreySymmetry inverse{symmetry.from, symmetry.to, symmetry.isometry.inverse(), {}};
      const auto same = [&](const StoreySymmetry& other) { return is_same(other, inverse, from, config); };
      if (std::none_of(found.begin(), found.end(), same)) try_motion(from, to, inverse.isometry, config, found);
    }
  }
  // A half turn is one of +pi, whichever way it was rounded.
  for (StoreySymmetry& symmetry : found)
    if (symmetry.isometry.angle < half_turn_rounding - std::numbers::pi)
      symmetry.isometry.angle += 2.0 * std::numbers::pi;
  std::stable_sort(found.begin(), found.end(), [](const StoreySymmetry& a, const StoreySymmetry& b) {
    return a.isometry.angle < b.isometry.angle;
  });
  return found;
}

void append(const std::vector<StoreySymmetry>& found, std::vector<StoreySymmetry>& list) {
  list.insert(list.end(), found.begin(), found.end());
}

/// Each storey is compared with the first of every kind seen so far.
std::vector<StoreySymmetry> find_copies(const std::vector<SymmetryScene>& scenes, const SymmetryConfig& config) {
  std::vector<StoreySymmetry> copies;
  std::vector<const SymmetryScene*> kinds;
  for (const SymmetryScene& scene : scenes) {
    std::vector<StoreySymmetry> found;
    for (const SymmetryScene* kind : kinds) {
      const double ratio = scene.volume_m3() / kind->volume_m3();
      if (ratio < config.iou_min || ratio > 1.0 / config.iou_min) continue;
      found = found_between(*kind, scene, false, config);
      if (!found.empty()) break;
    }
    if (found.empty()) kinds.push_back(&scene);
    append(found, copies);
  }
  return copies;
}

/// What holds on every storey at once; the residuals are those of the worst, the share in common that of all together.
std::vector<BuildingSymmetry> find_common(const std::vector<SymmetryScene>& scenes,
                                          const std::vector<StoreySymmetry>& own, const SymmetryConfig& config) {
  std::vector<BuildingSymmetry> common;
  for (const StoreySymmetry& symmetry : own) {
    if (symmetry.from != scenes.front().storey()) continue;
    BuildingSymmetry whole{symmetry.isometry, symmetry.similarity};
    double shared = 0.0, both = 0.0;
    for (const SymmetryScene& scene : scenes) {
      const Similarity here = compare(scene, scene, symmetry.isometry, config);
      whole.similarity.grade = std::max(whole.similarity.grade, here.grade);
      whole.similarity.deviation_m = std::max(whole.similarity.deviation_m, here.deviation_m);
      if (scene.storey() != symmetry.from)
        whole.similarity.deviations.insert(whole.similarity.deviations.end(), here.deviations.begin(),
                                           here.deviations.end());
      const double inner = 2.0 * scene.volume_m3() * here.iou / (1.0 + here.iou);
      shared += inner;
      both += 2.0 * scene.volume_m3() - inner;
    }
    if (whole.similarity.grade == SimilarityGrade::different) continue;
    whole.similarity.iou = shared / both;
    std::stable_sort(whole.similarity.deviations.begin(), whole.similarity.deviations.end(),
                     [](const Deviation& a, const Deviation& b) { return a.size_m > b.size_m; });
    if (static_cast<int>(whole.similarity.deviations.size()) > config.deviations_max)
      whole.similarity.deviations.resize(static_cast<std::size_t>(config.deviations_max));
    common.push_back(std::move(whole));
  }
  return common;
}

}  // namespace

SymmetryReport analyse_symmetry(const Building& as_planned, const SymmetryConfig& config) {
  SymmetryReport report;
  const std::vector<SymmetryScene> scenes = scenes_of(as_planned, config, report.left_out);
  if (scenes.empty()) return report;
  for (const SymmetryScene& scene : scenes) append(found_between(scene, scene, false, config), report.storeys);
  for (const SymmetryScene& scene : scenes) append(found_between(scene, scene, true, config), report.reflections);
  report.copies = find_copies(scenes, config);
  report.building = find_common(scenes, report.storeys, config);
  find_similar_rooms(as_planned, scenes, config, report.rooms);
  return report;
}

}  // namespace plumbline::bim
