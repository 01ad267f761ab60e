// SPDX-License-Identifier: Apache-2.0
#include "bim/generators/visibility.h"

#include <algorithm>
#include <cmath>

#include "bim/model/boxes.h"
#include "bim/symmetry/body_grid.h"
#include "bim/symmetry/symmetry_bodies.h"

namespace plumbline::bim {

namespace {

/// The segment p-q has a point inside the convex outline.
bool crosses(const Polygon2& outline, const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
  double s0 = 0.0, s1 = 1.0;
  for (std::size_t k = 0; k < outline.size() && s0 < s1; ++k) {
    const Eigen::Vector2d e = outline[(k + 1) % outline.size()] - outline[k];
    const Eigen::Vector2d n(e.y(), -e.x());
    const double height = n.dot(p - outline[k]), slope = n.dot(q - p);
    if (slope > 0.0)
      s1 = std::min(s1, -height / slope);
    else if (slope < 0.0)
      s0 = std::max(s0, -height / slope);
    else if (height >= 0.0)
      return false;
  }
  return s0 < s1;
}

/// What stands in the way at the height of the eye.
class View {
 public:
  View(std::vector<Polygon2> outlines) : outlines_(std::move(outlines)), grid_(boxes(outlines_)) {}

  [[nodiscard]] bool free(const Eigen::Vector2d& p, const Eigen::Vector2d& q) const {
    std::vector<int> near;
    grid_.near({Eigen::Vector2d(p.cwiseMin(q)), Eigen::Vector2d(p.cwiseMax(q))}, near);
    return std::none_of(near.begin(), near.end(),
                        [&](int i) { return crosses(outlines_[static_cast<std::size_t>(i)], p, q); });
  }

 private:
  static std::vector<Eigen::AlignedBox2d> boxes(const std::vector<Polygon2>& outlines) {
    std::vector<Eigen::AlignedBox2d> boxes;
    for (const Polygon2& outline : outlines) boxes.push_back(box_of(outline));
    return boxes;
  }

  std::vector<Polygon2> outlines_;
  BodyGrid grid_;
};

/// Places of a room where a robot can stand, furniture aside.
std::vector<Eigen::Vector2d> places_in(const Polygon2& outline, const VisibilityConfig& config) {
  std::vector<Eigen::Vector2d> places = {interior_point(outline)};
  const Eigen::AlignedBox2d box = box_of(outline);
  const int nx = static_cast<int>(box.sizes().x() / config.grid_m),
            ny = static_cast<int>(box.sizes().y() / config.grid_m);
  for (int i = 0; i <= nx; ++i) {
    for (int j = 0; j <= ny; ++j) {
      const Eigen::Vector2d p = box.min() + config.grid_m * Eigen::Vector2d(i, j);
      if (contains(outline, p) && boundary_distance(outline, p) >= config.clearance_m) places.push_back(p);
    }
  }
  return places;
}

}  // namespace

std::vector<std::string> rooms_that_see(const Building& building, int storey,
                                        const std::vector<Eigen::Vector2d>& points, const VisibilityConfig& config) {
  std::vector<Polygon2> outlines;
  for (const BodyPrism& prism : symmetry_bodies(building, storey).prisms)
    if (prism.z0 < config.sensor_height_m && prism.z1 > config.sensor_height_m) outlines.push_back(prism.outline);
  const View view(std::move(outlines));
  std::vector<std::string> rooms;
  for (const Room& room : building.rooms) {
    if (room.storey != storey) continue;
    const std::vector<Eigen::Vector2d> places = places_in(room.polygon, config);
    const bool sees = std::any_of(places.begin(), places.end(), [&](const Eigen::Vector2d& place) {
      return std::any_of(points.begin(), points.end(), [&](const Eigen::Vector2d& p) { return view.free(place, p); });
    });
    if (sees) rooms.push_back(room.id);
  }
  return rooms;
}

}  // namespace plumbline::bim
