// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_conics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumbline::bim {
namespace {

using Kind = StepValue::Kind;

constexpr double corner_rad = std::numbers::pi / 18.0, finest_rad = std::numbers::pi / 360.0;

/// Directions of an IfcAxis2Placement2D or 3D: x in the first column.
std::optional<Eigen::Affine3d> frame_at(const StepEntities& entities, const StepEntities::Entity& entity) {
  const StepValue values = entities.attributes(entity);
  const auto direction = [&](const StepValue& value, const Eigen::Vector3d& standard) -> Eigen::Vector3d {
    if (value.kind != Kind::reference) return standard;
    return step_point(entities.attributes(value, "IFCDIRECTION").at(0));
  };
  Eigen::Vector3d z = Eigen::Vector3d::UnitZ(), x = Eigen::Vector3d::UnitX();
  if (entity.type == "IFCAXIS2PLACEMENT3D") {
    z = direction(values.at(1), z);
    x = direction(values.at(2), z.cross(x).norm() > 1e-9 ? x : Eigen::Vector3d(Eigen::Vector3d::UnitZ()));
  } else if (entity.type == "IFCAXIS2PLACEMENT2D") {
    x = direction(values.at(1), x);
  } else {
    return std::nullopt;
  }
  const Eigen::Vector3d y = z.cross(x);
  if (!(y.norm() > 1e-9)) return std::nullopt;
  Eigen::Affine3d X = Eigen::Affine3d::Identity();
  X.linear().col(2) = z.normalized();
  X.linear().col(1) = y.normalized();
  X.linear().col(0) = X.linear().col(1).cross(X.linear().col(2));
  X.translation() = cartesian_point(entities, values.at(0));
  return X;
}

}  // namespace

Eigen::Vector3d step_point(const StepValue& list) {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  const std::vector<StepValue>& items = list.as_list();
  for (std::size_t i = 0; i < std::min<std::size_t>(items.size(), 3); ++i)
    p[static_cast<Eigen::Index>(i)] = items[i].as_number();
  return p;
}

Eigen::Vector3d cartesian_point(const StepEntities& entities, const StepValue& reference) {
  return step_point(entities.attributes(reference, "IFCCARTESIANPOINT").at(0));
}

double StepConic::angle_of(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d q = X.inverse() * p;
  return std::atan2(q.y() / ry, q.x() / rx);
}

Eigen::Vector3d StepConic::at(double angle) const {
  return X * Eigen::Vector3d(rx * std::cos(angle), ry * std::sin(angle), 0.0);
}

std::optional<StepConic> conic_of(const StepEntities& entities, const StepEntities::Entity& entity) {
  const bool circle = entity.type == "IFCCIRCLE";
  if (!circle && entity.type != "IFCELLIPSE") return std::nullopt;
  const StepValue values = entities.attributes(entity);
  const StepEntities::Entity& placement = entities.entity(values.at(0).as_reference());
  const std::optional<Eigen::Affine3d> X = frame_at(entities, placement);
  const double rx = values.at(1).as_number(), ry = circle ? rx : values.at(2).as_number();
  if (!X || !(rx > 0.0 && ry > 0.0)) return std::nullopt;
  return StepConic{*X, rx, ry, placement.type == "IFCAXIS2PLACEMENT2D"};
}

int arc_pieces(double angle, double radius, double depth) {
  const double cut = std::sqrt(8.0 * depth / radius);
  if (!std::isfinite(angle) || std::isnan(cut)) throw InputError({}, "an arc of no finite angle and radius");
  const double piece = std::clamp(cut, finest_rad, corner_rad);
  return std::max(2, static_cast<int>(std::ceil(std::abs(angle) / piece - 1e-6)));
}

std::vector<Eigen::Vector3d> arc_between(const StepConic& conic, const Eigen::Vector3d& first,
                                         const Eigen::Vector3d& last, bool forward, double depth) {
  const double from = conic.angle_of(first);
  double turn = conic.angle_of(last) - from;
  constexpr double whole = 2.0 * std::numbers::pi;
  while (forward && turn <= 1e-9) turn += whole;
  while (!forward && turn >= -1e-9) turn -= whole;
  const int count = arc_pieces(turn, std::max(conic.rx, conic.ry), depth);
  std::vector<Eigen::Vector3d> line = {first};
  for (int i = 1; i < count; ++i) line.push_back(conic.at(from + turn * i / count));
  line.push_back(last);
  return line;
}

}  // namespace plumbline::bim
