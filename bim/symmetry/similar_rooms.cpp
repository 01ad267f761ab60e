// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/geometry/polygon_boolean.h"
#include "bim/geometry/pose.h"
#include "bim/symmetry/symmetry_scene.h"

namespace plumbline::bim {

namespace {

/// The inside of a room: its outline and the surfaces that face it.
struct Interior {
  int room = -1;
  const Room* of = nullptr;
  const SymmetryScene* scene = nullptr;
  Polygon2 outline;
  double area_m2 = 0.0;
  double surface_m2 = 0.0;
  std::vector<SurfaceRect> surfaces;
};

/// Appends the stretches of a surface in front of which the room lies.
void add_stretches(const SurfaceRect& rect, const SymmetryConfig& config, Interior& interior) {
  const Eigen::Vector2d e = rect.direction(), step = config.through_m * Eigen::Vector2d(e.y(), -e.x());
  const Eigen::Vector2d p = rect.p + step, d = rect.q - rect.p;
  std::vector<double> cuts = {0.0, 1.0};
  for (const Polygon2* rim : interior.of->rims())
    for (std::size_t k = 0; k < rim->size(); ++k) {
      const Eigen::Vector2d& a = (*rim)[k];
      const Eigen::Vector2d b = (*rim)[(k + 1) % rim->size()] - a;
      const double det = d.x() * -b.y() + d.y() * b.x();
      if (det == 0.0) continue;
      const Eigen::Vector2d w = a - p;
      const double s = (w.x() * -b.y() + w.y() * b.x()) / det, u = (d.x() * w.y() - d.y() * w.x()) / det;
      if (u >= 0.0 && u <= 1.0 && s > 0.0 && s < 1.0) cuts.push_back(s);
    }
  std::sort(cuts.begin(), cuts.end());
  double begin = -1.0;
  const auto close = [&](double end) {
    if (begin < 0.0 || (end - begin) * d.norm() <= config.exact_m) return;
    interior.surfaces.push_back({rect.p + begin * d, rect.p + end * d, rect.z0, rect.z1, rect.element});
    interior.surface_m2 += interior.surfaces.back().area();
  };
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const bool inside = interior.of->contains(p + 0.5 * (cuts[i] + cuts[i + 1]) * d);
    if (inside && begin < 0.0) begin = cuts[i];
    if (!inside) {
      close(cuts[i]);
      begin = -1.0;
    }
  }
  close(1.0);
}

Interior interior_of(const Building& building, int room, const SymmetryScene& scene, const SymmetryConfig& config) {
  Interior interior;
  interior.room = room;
  interior.scene = &scene;
  interior.of = &building.rooms[static_cast<std::size_t>(room)];
  interior.outline = interior.of->polygon;
  interior.area_m2 = interior.of->area_m2();
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : interior.outline) box.extend(p);
  box.min().array() -= config.through_m;
  box.max().array() += config.through_m;
  std::vector<int> near;
  scene.surfaces().near(box, near);
  for (const int i : near) add_stretches(scene.surfaces().rects()[static_cast<std::size_t>(i)], config, interior);
  return interior;
}

double distance(const std::vector<SurfaceRect>& rects, const Eigen::Vector3d& p, const Eigen::Vector2d& direction,
                double reach_m) {
  constexpr double other_way = -0.5;
  double best = reach_m;
  for (const SurfaceRect& rect : rects) {
    if (rect.direction().dot(direction) < other_way) continue;
    const double up = std::max({0.0, rect.z0 - p.z(), p.z() - rect.z1});
    best = std::min(best, std::hypot(segment_distance(rect.p, rect.q, p.head<2>()), up));
  }
  return best;
}

/// Largest deviation of the surfaces of `from`, taken through g, from those of `to`. Gives up above near_m.
Deviation largest_deviation(const Interior& from, const Interior& to, const Isometry2& g,
                            const SymmetryConfig& config) {
  Deviation largest;
  for (const SurfaceRect& rect : from.surfaces) {
    const SurfaceRect image = moved(g, rect);
    // Of a column that the other room lacks, its size counts and not the way to the walls.
    const double reach_m = std::min(config.reach_m, from.scene->size_m(rect.element));
    const int along = std::max(2, static_cast<int>(std::ceil(image.length() / config.sample_m)));
    for (int i = 0; i <= along; ++i) {
      const Eigen::Vector2d p = image.p + (image.q - image.p) * i / along;
      for (const double z : {image.z0, 0.5 * (image.z0 + image.z1), image.z1}) {
        const double d = distance(to.surfaces, {p.x(), p.y(), z}, image.direction(), reach_m);
        if (d > largest.size_m) largest = {from.scene->element_id(rect.element), g.inverse() * p, d};
        if (d > config.near_m + config.sliver_m) return largest;
      }
    }
  }
  return largest;
}

PolygonWithHoles2 image_of(const Isometry2& g, const Room& room) {
  PolygonWithHoles2 image{g * room.polygon, {}};
  for (const Polygon2& hole : room.holes) {
    // Images are counter-clockwise.
    Polygon2 rim = g * Polygon2(hole.rbegin(), hole.rend());
    image.holes.emplace_back(rim.rbegin(), rim.rend());
  }
  return image;
}

Similarity compare_rooms(const Interior& from, const Interior& to, const Isometry2& g, const SymmetryConfig& config) {
  Similarity similarity;
  std::vector<Deviation> deviations = {largest_deviation(from, to, g, config)};
  if (deviations.front().size_m <= config.near_m + config.sliver_m)
    deviations.push_back(largest_deviation(to, from, g.inverse(), config));
  for (const Deviation& deviation : deviations) {
    similarity.deviation_m = std::max(similarity.deviation_m, deviation.size_m);
    if (deviation.size_m > config.exact_m) similarity.deviations.push_back(deviation);
  }
  std::stable_sort(similarity.deviations.begin(), similarity.deviations.end(),
                   [](const Deviation& a, const Deviation& b) { return a.size_m > b.size_m; });
  if (similarity.deviation_m > config.near_m + config.sliver_m) return similarity;
  similarity.iou = 1.0;
  if (similarity.deviation_m > config.exact_m) {
    const bool solid = from.of->holes.empty() && to.of->holes.empty();
    const double shared = solid ? intersection_area(g * from.outline, to.outline)
                                : area(intersect({image_of(g, *from.of)}, {to.of->outline()}));
    similarity.iou = std::min(1.0, shared / (from.area_m2 + to.area_m2 - shared));
  }
  const bool exact = similarity.deviation_m <= config.exact_m;
  similarity.grade = exact                              ? SimilarityGrade::exact
                     : similarity.iou >= config.iou_min ? SimilarityGrade::near
                                                        : SimilarityGrade::different;
  return similarity;
}

/// Isometries that lay the longest edge of one outline onto an edge of the other, at either end.
std::vector<Isometry2> placements(const Polygon2& from, const Polygon2& to, const SymmetryConfig& config) {
  const auto edge = [](const Polygon2& polygon, std::size_t k) {
    return Eigen::Vector2d(polygon[(k + 1) % polygon.size()] - polygon[k]);
  };
  std::size_t longest = 0;
  for (std::size_t k = 1; k < from.size(); ++k)
    if (edge(from, k).norm() > edge(from, longest).norm() + config.exact_m) longest = k;
  const Eigen::Vector2d a = edge(from, longest);
  std::vector<Isometry2> result;
  for (std::size_t k = 0; k < to.size(); ++k) {
    const Eigen::Vector2d b = edge(to, k);
    if (std::abs(a.norm() - b.norm()) > config.near_m) continue;
    const double angle = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    result.push_back(Isometry2::taking(angle, false, from[longest], to[k]));
    if (std::abs(a.norm() - b.norm()) <= config.exact_m) continue;
    result.push_back(Isometry2::taking(angle, false, from[longest] + a, to[k] + b));
  }
  return result;
}

bool comparable(const Interior& a, const Interior& b, const SymmetryConfig& config) {
  const auto close = [&](double x, double y) { return std::min(x, y) >= config.room_share * std::max(x, y); };
  constexpr double surface_share = 0.8;  // a door or a column more
  return close(a.area_m2, b.area_m2) &&
         std::min(a.surface_m2, b.surface_m2) >= surface_share * std::max(a.surface_m2, b.surface_m2);
}

/// The best way to lay one room onto another; of equal ones the first.
std::optional<SimilarRoom> best_similarity(const Interior& from, const Interior& to, const SymmetryConfig& config) {
  std::optional<SimilarRoom> best;
  for (const Isometry2& g : placements(from.outline, to.outline, config)) {
    const Similarity similarity = compare_rooms(from, to, g, config);
    if (similarity.grade == SimilarityGrade::different) continue;
    if (!best || similarity.deviation_m < best->similarity.deviation_m - config.sliver_m)
      best = {to.room, g, similarity};
  }
  return best;
}

/// Adds a room to the class whose first room it is most like, at least in this grade (of equal ones the first), or
/// founds one.
void join_class(const Interior& interior, SimilarityGrade grade, const SymmetryConfig& config,
                std::vector<const Interior*>& firsts, std::vector<RoomClass>& classes) {
  std::optional<SimilarRoom> best;
  std::size_t chosen = 0;
  for (std::size_t c = 0; c < firsts.size(); ++c) {
    if (!comparable(*firsts[c], interior, config)) continue;
    const auto found = best_similarity(*firsts[c], interior, config);
    if (!found || found->similarity.grade > grade) continue;
    if (best && found->similarity.deviation_m >= best->similarity.deviation_m - config.sliver_m) continue;
    best = found;
    chosen = c;
    if (best->similarity.grade == SimilarityGrade::exact) break;
  }
  if (best) {
    classes[chosen].rooms.push_back(*best);
    return;
  }
  firsts.push_back(&interior);
  classes.push_back({{{interior.room, {}, {SimilarityGrade::exact, 1.0, 0.0, {}}}}, {}});
}

std::vector<Isometry2> own_turns(const Interior& room, const SymmetryConfig& config) {
  constexpr double smallest_turn = 1e-3;
  std::vector<Isometry2> turns;
  for (const Isometry2& g : placements(room.outline, room.outline, config))
    if (std::abs(g.angle) > smallest_turn && compare_rooms(room, room, g, config).grade == SimilarityGrade::exact)
      turns.push_back(g);
  return turns;
}

std::vector<Interior> interiors_of(const Building& building, const std::vector<SymmetryScene>& scenes,
                                   const SymmetryConfig& config) {
  std::vector<Interior> interiors;
  for (std::size_t i = 0; i < building.rooms.size(); ++i)
    for (const SymmetryScene& scene : scenes)
      if (scene.storey() == building.rooms[i].storey)
        interiors.push_back(interior_of(building, static_cast<int>(i), scene, config));
  return interiors;
}

}  // namespace

void find_similar_rooms(const Building& building, const std::vector<SymmetryScene>& scenes,
                        const SymmetryConfig& config, std::vector<RoomClass>& classes) {
  const std::vector<Interior> interiors = interiors_of(building, scenes, config);
  std::vector<RoomClass> exact, nearly;
  std::vector<const Interior*> firsts, first_firsts;
  for (const Interior& interior : interiors) join_class(interior, SimilarityGrade::exact, config, firsts, exact);
  for (const Interior* first : firsts) join_class(*first, SimilarityGrade::near, config, first_firsts, nearly);
  for (std::size_t c = 0; c < exact.size(); ++c) {
    if (exact[c].rooms.size() < 2) continue;
    exact[c].turns = own_turns(*firsts[c], config);
    classes.push_back(std::move(exact[c]));
  }
  for (RoomClass& like : nearly)
    if (like.rooms.size() > 1) classes.push_back(std::move(like));
}

}  // namespace plumbline::bim
