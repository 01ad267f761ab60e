// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_tapered.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <string_view>

#include "bim/formats/ifc/step/step_conics.h"
#include "bim/geometry/polygon.h"

namespace plumbline::bim {
namespace {

using Corners = std::vector<Eigen::Vector2d>;
using Kind = StepValue::Kind;

Eigen::Vector3d direction_of(const StepEntities& entities, const StepValue& reference, const Eigen::Vector3d& usual) {
  if (reference.kind != Kind::reference) return usual;
  return step_point(entities.attributes(reference, "IFCDIRECTION").at(0));
}

/// Where the placement of a parametric profile puts it; identity without one.
Eigen::Affine2d flat_frame(const StepEntities& entities, const StepValue& placement) {
  Eigen::Affine2d X = Eigen::Affine2d::Identity();
  if (placement.kind != Kind::reference) return X;
  const StepValue values = entities.attributes(placement, "IFCAXIS2PLACEMENT2D");
  X.translation() = cartesian_point(entities, values.at(0)).head<2>();
  const Eigen::Vector2d x = direction_of(entities, values.at(1), Eigen::Vector3d::UnitX()).head<2>().normalized();
  X.linear() << x.x(), -x.y(), x.y(), x.x();
  return X;
}

/// What a derived profile does to its parent [iso2018, IfcCartesianTransformationOperator2D].
std::optional<Eigen::Affine2d> operator_of(const StepEntities& entities, const StepValue& reference) {
  const StepEntities::Entity& entity = entities.entity(reference.as_reference());
  constexpr std::string_view plain = "IFCCARTESIANTRANSFORMATIONOPERATOR2D";
  if (!entity.type.starts_with(plain)) return std::nullopt;
  const StepValue values = entities.attributes(entity);
  const auto number_or = [&](std::size_t i, double usual) {
    return values.as_list().size() > i && values.at(i).kind == Kind::number ? values.at(i).number : usual;
  };
  const Eigen::Vector2d x = direction_of(entities, values.at(0), Eigen::Vector3d::UnitX()).head<2>().normalized();
  const Eigen::Vector2d left(-x.y(), x.x());
  const Eigen::Vector2d given = direction_of(entities, values.at(1), {left.x(), left.y(), 0.0}).head<2>();
  const double scale = number_or(3, 1.0);
  Eigen::Affine2d X;
  X.linear() << scale * x, number_or(4, scale) * (given.dot(left) < 0.0 ? Eigen::Vector2d(-left) : left);
  X.translation() = cartesian_point(entities, values.at(2)).head<2>();
  return X;
}

Corners rectangle(double half_x, double half_y) {
  return {{-half_x, -half_y}, {half_x, -half_y}, {half_x, half_y}, {-half_x, half_y}};
}

Corners i_shape(double half_x, double half_y, double web, double flange) {
  const double w = 0.5 * web, inner = half_y - flange;
  return {{-half_x, -half_y}, {half_x, -half_y}, {half_x, -inner}, {w, -inner}, {w, inner},   {half_x, inner},
          {half_x, half_y},   {-half_x, half_y}, {-half_x, inner}, {-w, inner}, {-w, -inner}, {-half_x, -inner}};
}

std::optional<Corners> polyline(const StepEntities& entities, const StepValue& curve) {
  if (entities.entity(curve.as_reference()).type != "IFCPOLYLINE") return std::nullopt;
  Corners corners;
  for (const StepValue& point : entities.attributes(curve.as_reference()).at(0).as_list())
    corners.push_back(cartesian_point(entities, point).head<2>());
  while (corners.size() > 1 && corners.back() == corners.front()) corners.pop_back();
  return corners.size() < 3 ? std::nullopt : std::optional(corners);
}

std::optional<Corners> corners_of(const StepEntities& entities, const StepValue& profile, int depth) {
  constexpr int most_deep = 8;
  const StepEntities::Entity& entity = entities.entity(profile.as_reference());
  const StepValue values = entities.attributes(entity);
  const auto size = [&](std::size_t i) { return values.at(i).as_number(); };
  std::optional<Corners> corners;
  Eigen::Affine2d X = Eigen::Affine2d::Identity();
  if (entity.type == "IFCARBITRARYCLOSEDPROFILEDEF") {
    corners = polyline(entities, values.at(2));
  } else if (entity.type == "IFCRECTANGLEPROFILEDEF") {
    X = flat_frame(entities, values.at(2));
    corners = rectangle(0.5 * size(3), 0.5 * size(4));
  } else if (entity.type == "IFCISHAPEPROFILEDEF") {
    X = flat_frame(entities, values.at(2));
    corners = i_shape(0.5 * size(3), 0.5 * size(4), size(5), size(6));
  } else if (entity.type == "IFCDERIVEDPROFILEDEF" && depth < most_deep) {
    const std::optional<Eigen::Affine2d> mapped = operator_of(entities, values.at(3));
    if (!mapped) return std::nullopt;
    X = *mapped;
    corners = corners_of(entities, values.at(2), depth + 1);
  }
  if (corners)
    for (Eigen::Vector2d& p : *corners) p = X * p;
  return corners;
}

}  // namespace

std::optional<std::vector<Eigen::Vector2d>> straight_profile(const StepEntities& entities, const StepValue& profile) {
  return corners_of(entities, profile, 0);
}

Eigen::Affine3d frame_at(const StepEntities& entities, const StepValue& placement) {
  Eigen::Affine3d X = Eigen::Affine3d::Identity();
  if (placement.kind != Kind::reference) return X;
  const StepValue place = entities.attributes(placement, "IFCAXIS2PLACEMENT3D");
  const Eigen::Vector3d z = direction_of(entities, place.at(1), Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d given = direction_of(entities, place.at(2), Eigen::Vector3d::UnitX());
  const Eigen::Vector3d x = (given - given.dot(z) * z).normalized();
  X.linear() << x, z.cross(x), z;
  X.translation() = cartesian_point(entities, place.at(0));
  return X;
}

std::optional<TaperedBody> tapered_body(const StepEntities& entities, const StepValue& attributes) {
  const std::optional<Corners> start = straight_profile(entities, attributes.at(0)),
                               end = straight_profile(entities, attributes.at(4));
  if (!start || !end || start->size() != end->size()) return std::nullopt;
  const Eigen::Affine3d X = frame_at(entities, attributes.at(1));
  const Eigen::Vector3d along =
      direction_of(entities, attributes.at(2), Eigen::Vector3d::UnitZ()).normalized() * attributes.at(3).as_number();
  TaperedBody body;
  for (std::size_t i = 0; i < start->size(); ++i) {
    const Eigen::Vector2d &a = (*start)[i], &b = (*end)[i];
    body.start.push_back(X * Eigen::Vector3d(a.x(), a.y(), 0.0));
    body.end.push_back(X * (Eigen::Vector3d(b.x(), b.y(), 0.0) + along));
  }
  // Faces look outward whichever way round a profile is drawn and extruded.
  if (signed_area(*start) * along.z() < 0.0)
    for (auto* corners : {&body.start, &body.end}) std::reverse(corners->begin(), corners->end());
  const auto is_number = [](const Eigen::Vector3d& p) { return p.allFinite(); };
  if (!std::all_of(body.start.begin(), body.start.end(), is_number) ||
      !std::all_of(body.end.begin(), body.end.end(), is_number))
    return std::nullopt;
  return body;
}

}  // namespace plumbline::bim
