// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/georeference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bim/median.h"

namespace plumbline::bim {
namespace {

/// Box around points; nullopt when one of them is not a number.
bool extend(Eigen::AlignedBox3d& box, const std::vector<Eigen::Vector3d>& points) {
  for (const Eigen::Vector3d& p : points) {
    if (!p.allFinite()) return false;
    box.extend(p);
  }
  return true;
}

bool within(const Eigen::AlignedBox3d& box, double furthest_m) {
  return box.isEmpty() ||
         (box.min().cwiseAbs().maxCoeff() <= furthest_m && box.max().cwiseAbs().maxCoeff() <= furthest_m);
}

using Coordinates = std::array<std::vector<double>, 3>;

/// Of one corner of each body, in W.
template <class Counts>
Coordinates corners_of(const StepModel& model, Counts&& counts) {
  Coordinates coordinates;
  for (const StepProduct& product : model.products) {
    if (!counts(product) || product.body.empty() || product.body.front().base.points.empty()) continue;
    const Eigen::Vector3d p_W = product.X_WP * product.body.front().base.points.front();
    for (std::size_t axis = 0; axis < 3; ++axis) coordinates[axis].push_back(p_W[static_cast<Eigen::Index>(axis)]);
  }
  return coordinates;
}

}  // namespace

bool within_reach(const StepProduct& product, const GeoreferenceConfig& config) {
  Eigen::AlignedBox3d in_world, body;
  if (!extend(in_world, product.axis_W) || !extend(in_world, {product.X_WP.translation()})) return false;
  for (const Shape& shape : product.body) {
    Eigen::AlignedBox3d cut;  // half spaces reach far
    if (!extend(body, shape.base.points)) return false;
    for (const std::vector<Facets>* others : {&shape.minus, &shape.within})
      for (const Facets& facets : *others)
        if (!extend(cut, facets.points)) return false;
    if (!within(cut, config.furthest_m)) return false;
  }
  return within(in_world, config.furthest_m) && within(body, config.furthest_m) &&
         (body.isEmpty() || body.sizes().maxCoeff() <= config.largest_m);
}

bool is_finite(const StepProduct& product) {
  Eigen::AlignedBox3d box;
  const auto finite = [&](const Facets& facets) { return extend(box, facets.points); };
  return extend(box, product.axis_W) && extend(box, {product.X_WP.translation()}) &&
         std::all_of(product.body.begin(), product.body.end(), [&](const Shape& shape) {
           return finite(shape.base) && std::all_of(shape.minus.begin(), shape.minus.end(), finite) &&
                  std::all_of(shape.within.begin(), shape.within.end(), finite);
         });
}

Eigen::Vector3d extent_of_building(const StepModel& model) {
  Eigen::AlignedBox3d box;
  for (const StepProduct& product : model.products) {
    if (product.kind != StepClass::wall && product.kind != StepClass::slab && product.kind != StepClass::space)
      continue;
    for (const Shape& shape : product.body)
      for (const Eigen::Vector3d& p : shape.base.points)
        if (const Eigen::Vector3d p_W = product.X_WP * p; p_W.allFinite()) box.extend(p_W);
  }
  return box.isEmpty() ? Eigen::Vector3d::Constant(-1.0) : Eigen::Vector3d(box.sizes());
}

std::optional<Eigen::Vector3d> move_to_origin(StepModel& model, const GeoreferenceConfig& config) {
  Coordinates coordinates =
      corners_of(model, [](const StepProduct& product) { return product.kind == StepClass::wall; });
  if (coordinates.front().empty())
    coordinates = corners_of(model, [](const StepProduct& product) {
      return product.kind == StepClass::slab || product.kind == StepClass::space || product.kind == StepClass::column;
    });
  if (coordinates.front().empty()) coordinates = corners_of(model, [](const StepProduct&) { return true; });
  if (coordinates.front().empty()) return std::nullopt;
  Eigen::Vector3d middle;
  for (std::size_t axis = 0; axis < 3; ++axis)
    middle[static_cast<Eigen::Index>(axis)] = std::round(upper_median(coordinates[axis]));
  Eigen::Vector3d move = Eigen::Vector3d::Zero();
  if (middle.head<2>().norm() > config.local_m) move.head<2>() = -middle.head<2>();
  if (std::abs(middle.z()) > config.local_m) move.z() = -middle.z();
  if (move.isZero(0.0)) return std::nullopt;
  for (StepProduct& product : model.products) {
    product.X_WP.translation() += move;
    if (product.elevation_m) *product.elevation_m += move.z();
    for (Eigen::Vector3d& p : product.axis_W) p += move;
  }
  return move;
}

}  // namespace plumbline::bim
