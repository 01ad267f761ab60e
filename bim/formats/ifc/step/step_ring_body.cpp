// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_ring_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "bim/formats/ifc/step/step_conics.h"
#include "bim/formats/ifc/step/step_tapered.h"

namespace plumbline::bim {
namespace {

using Kind = StepValue::Kind;
using OutlineRing = std::vector<Eigen::Vector3d>;

/// Volume within the rings, negative where their faces look inward.
double signed_volume(const RingBody& body) {
  double volume = 0.0;
  const auto add = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r) {
    volume += (p - body.rings[0][0]).dot((q - body.rings[0][0]).cross(r - body.rings[0][0])) / 6.0;
  };
  const std::size_t count = body.rings.size(), sides = body.closed ? count : count - 1;
  for (std::size_t k = 0; k < sides; ++k) {
    const OutlineRing &low = body.rings[k], &high = body.rings[(k + 1) % count];
    for (std::size_t i = 0; i < low.size(); ++i) {
      const std::size_t next = (i + 1) % low.size();
      add(low[i], low[next], high[next]);
      add(low[i], high[next], high[i]);
    }
  }
  if (body.closed) return volume;
  for (std::size_t i = 1; i + 1 < body.rings[0].size(); ++i) {
    add(body.rings.front()[0], body.rings.front()[i + 1], body.rings.front()[i]);
    add(body.rings.back()[0], body.rings.back()[i], body.rings.back()[i + 1]);
  }
  return volume;
}

/// Faces look outward; nullopt for what is no body.
std::optional<RingBody> outward(RingBody body) {
  for (const OutlineRing& ring : body.rings)
    for (const Eigen::Vector3d& p : ring)
      if (!p.allFinite()) return std::nullopt;
  const double volume = signed_volume(body);
  if (!(std::abs(volume) > 0.0)) return std::nullopt;
  if (volume < 0.0)
    for (OutlineRing& ring : body.rings) std::reverse(ring.begin(), ring.end());
  return body;
}

/// The points of a polyline from one parameter to another: the k-th point has the parameter k. Empty where there are no
/// such points.
OutlineRing stretch_of(const OutlineRing& points, double from, double to) {
  constexpr double same = 1e-9;
  const auto last = static_cast<double>(points.size() - 1);
  if (!(from >= 0.0 && to <= last + same && to > from)) return {};
  const auto at = [&](double t) -> Eigen::Vector3d {
    const auto k = std::min(static_cast<std::size_t>(t), points.size() - 2);
    return points[k] + (t - static_cast<double>(k)) * (points[k + 1] - points[k]);
  };
  OutlineRing stretch = {at(from)};
  for (std::size_t k = 0; k < points.size(); ++k)
    if (static_cast<double>(k) > from + same && static_cast<double>(k) < to - same) stretch.push_back(points[k]);
  stretch.push_back(at(std::min(to, last)));
  return stretch;
}

std::optional<double> curve_parameter(const StepValue& value, double usual) {
  if (value.kind == Kind::none) return usual;
  // IFC4X3 may give a length along the curve instead.
  if (value.kind == Kind::typed)
    return value.text == "IFCPARAMETERVALUE" ? std::optional(value.as_typed().as_number()) : std::nullopt;
  return value.kind == Kind::number ? std::optional(value.number) : std::nullopt;
}

OutlineRing directrix_of(const StepEntities& entities, const StepValue& attributes) {
  if (entities.entity(attributes.at(2).as_reference()).type != "IFCPOLYLINE") return {};
  OutlineRing points;
  for (const StepValue& point : entities.attributes(attributes.at(2).as_reference()).at(0).as_list()) {
    const Eigen::Vector3d p = cartesian_point(entities, point);
    if (points.empty() || p != points.back()) points.push_back(p);
  }
  if (points.size() < 2) return {};
  const std::optional<double> from = curve_parameter(attributes.at(3), 0.0),
                              to = curve_parameter(attributes.at(4), static_cast<double>(points.size() - 1));
  return from && to ? stretch_of(points, *from, *to) : OutlineRing{};
}

/// The outline where two lines meet, or where the only one begins or ends. Nullopt at a bend that is too sharp.
std::optional<OutlineRing> mitre(const std::vector<Eigen::Vector2d>& profile, const Eigen::Vector3d& at,
                                 const Eigen::Vector3d& before, const Eigen::Vector3d& after,
                                 const Eigen::Vector3d& normal) {
  constexpr double least_cosine = 0.2;
  const Eigen::Vector3d along = (before + after).normalized();
  const double cosine = along.dot(after);
  if (!(cosine > least_cosine)) return std::nullopt;
  const Eigen::Vector3d y = along.cross(normal) / cosine;
  OutlineRing ring;
  for (const Eigen::Vector2d& p : profile) ring.push_back(at + p.x() * normal + p.y() * y);
  return ring;
}

}  // namespace

std::optional<RingBody> tapered_revolution(const StepEntities& entities, const StepValue& attributes, double radian) {
  constexpr double step = 5.0 * M_PI / 180.0;
  const std::optional<std::vector<Eigen::Vector2d>> start = straight_profile(entities, attributes.at(0)),
                                                    end = straight_profile(entities, attributes.at(4));
  if (!start || !end || start->size() != end->size()) return std::nullopt;
  const StepValue axis = entities.attributes(attributes.at(2), "IFCAXIS1PLACEMENT");
  const Eigen::Vector3d origin = cartesian_point(entities, axis.at(0));
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  if (axis.at(1).kind == Kind::reference)
    direction = step_point(entities.attributes(axis.at(1), "IFCDIRECTION").at(0)).normalized();
  const double angle = curve_parameter(attributes.at(3), 0.0).value_or(0.0) * radian;
  if (!(std::abs(angle) > 0.0 && std::abs(angle) <= 2.0 * M_PI + 1e-6)) return std::nullopt;
  const Eigen::Affine3d X = frame_at(entities, attributes.at(1));
  const int count = std::max(1, static_cast<int>(std::ceil(std::abs(angle) / step)));
  if (static_cast<std::size_t>(count + 1) * start->size() > RingBody::most_corners) return std::nullopt;
  RingBody body;
  for (int k = 0; k <= count; ++k) {
    const double share = static_cast<double>(k) / count;
    const Eigen::AngleAxisd turn(share * angle, direction);
    OutlineRing& ring = body.rings.emplace_back();
    for (std::size_t i = 0; i < start->size(); ++i) {
      const Eigen::Vector2d p = (1.0 - share) * (*start)[i] + share * (*end)[i];
      ring.push_back(X * (origin + turn * (Eigen::Vector3d(p.x(), p.y(), 0.0) - origin)));
    }
  }
  return outward(std::move(body));
}

std::optional<RingBody> sweep_on_plane(const StepEntities& entities, const StepValue& attributes) {
  constexpr double level = 1e-6;
  const std::optional<std::vector<Eigen::Vector2d>> profile = straight_profile(entities, attributes.at(0));
  const StepEntities::Entity& surface = entities.entity(attributes.at(5).as_reference());
  if (!profile || surface.type != "IFCPLANE") return std::nullopt;
  const Eigen::Vector3d normal = frame_at(entities, entities.attributes(surface).at(0)).linear().col(2);
  OutlineRing line = directrix_of(entities, attributes);
  if (line.size() < 2 || line.size() * profile->size() > RingBody::most_corners) return std::nullopt;
  const double length = (line.front() - line[1]).norm();
  RingBody body;
  body.closed = line.size() > 3 && (line.front() - line.back()).norm() < level * length;
  if (body.closed) line.pop_back();
  std::vector<Eigen::Vector3d> along;
  for (std::size_t i = 0; i + (body.closed ? 0 : 1) < line.size(); ++i)
    along.emplace_back((line[(i + 1) % line.size()] - line[i]).normalized());
  if (std::any_of(along.begin(), along.end(), [&](const auto& e) { return !(std::abs(e.dot(normal)) < level); }))
    return std::nullopt;
  const Eigen::Affine3d X = frame_at(entities, attributes.at(1));
  for (std::size_t i = 0; i < line.size(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : body.closed ? along.size() - 1 : 0;
    std::optional<OutlineRing> ring =
        mitre(*profile, line[i], along[before], along[std::min(i, along.size() - 1)], normal);
    if (!ring) return std::nullopt;
    for (Eigen::Vector3d& p : *ring) p = X * p;
    body.rings.push_back(std::move(*ring));
  }
  return outward(std::move(body));
}

}  // namespace plumbline::bim
