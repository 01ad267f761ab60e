// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_plain_shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "bim/formats/ifc/step/step_conics.h"
#include "bim/formats/ifc/step/step_edits.h"
#include "bim/formats/ifc/step/step_entities.h"
#include "bim/formats/ifc/step/step_ring_body.h"
#include "bim/formats/ifc/step/step_tapered.h"
#include "bim/formats/ifc/step/step_units.h"

namespace plumbline::bim {
namespace {

using Kind = StepValue::Kind;

constexpr std::string_view operator_type = "IFCCARTESIANTRANSFORMATIONOPERATOR",
                           extrusion_type = "IFCEXTRUDEDAREASOLID", composite_type = "IFCCOMPOSITEPROFILEDEF",
                           mirrored_type = "IFCMIRROREDPROFILEDEF", girder_type = "IFCASYMMETRICISHAPEPROFILEDEF",
                           block_type = "IFCBLOCK", pyramid_type = "IFCRECTANGULARPYRAMID",
                           tapered_revolution_type = "IFCREVOLVEDAREASOLIDTAPERED",
                           surface_sweep_type = "IFCSURFACECURVESWEPTAREASOLID";
constexpr std::array<std::string_view, 4> swept_types{extrusion_type, "IFCREVOLVEDAREASOLID",
                                                      "IFCFIXEDREFERENCESWEPTAREASOLID", surface_sweep_type};

/// Part of a direction across others, of length 1; nullopt where nothing of it is.
std::optional<Eigen::Vector3d> across(Eigen::Vector3d v, const std::vector<Eigen::Vector3d>& others) {
  for (const Eigen::Vector3d& other : others) v -= v.dot(other) * other;
  if (!(v.norm() > 1e-9)) return std::nullopt;
  return v.normalized();
}

/// Directions of an operator in columns, of what it gives of them [iso2018, IfcBaseAxis]. Without its second axis it
/// turns and does not mirror.
std::optional<Eigen::Matrix3d> base_axes(const std::array<std::optional<Eigen::Vector3d>, 3>& given, bool flat) {
  using V = Eigen::Vector3d;
  const std::optional<V> z = across(given[2].value_or(V::UnitZ()), {});
  if (!z) return std::nullopt;
  std::optional<V> x;
  if (given[0]) {
    x = across(*given[0], {*z});
  } else if (flat && given[1]) {
    x = across(given[1]->cross(*z), {});
  } else {
    x = across(V::UnitX(), {*z});
    if (!x) x = across(V::UnitY(), {*z});
  }
  if (!x) return std::nullopt;
  const V right = z->cross(*x);
  Eigen::Matrix3d axes;
  axes << *x, (given[1] && given[1]->dot(right) < 0.0 ? V(-right) : right), *z;
  return axes;
}

class PlainShapes {
 public:
  PlainShapes(const std::string& text, const std::string& file) : entities_(text, file), edits_(text, entities_) {}

  std::string read() {
    take_each(entities_, [&](const StepEntities::Entity& entity) { take(entity); });
    return edits_.done();
  }

 private:
  void take(const StepEntities::Entity& entity) {
    if (!edits_.has_room(4 * most_parts)) return;
    if (entity.type.starts_with(operator_type)) {
      take_operator(entity);
    } else if (entity.type == mirrored_type) {
      take_mirrored(entity);
    } else if (entity.type == girder_type) {
      take_girder(entity);
    } else if (entity.type == block_type || entity.type == pyramid_type) {
      take_cornered(entity);
    } else if (entity.type == tapered_revolution_type) {
      if (!radian_) radian_ = assigned_unit(entities_, "PLANEANGLEUNIT").value_or(1.0);
      take_ring_body(entity, tapered_revolution(entities_, entities_.attributes(entity), *radian_));
    } else if (entity.type == surface_sweep_type &&
               take_ring_body(entity, sweep_on_plane(entities_, entities_.attributes(entity)))) {
      return;
    } else if (entity.type.starts_with(extrusion_type) ||
               std::find(swept_types.begin(), swept_types.end(), entity.type) != swept_types.end()) {
      take_swept(entity);
    }
  }

  std::string direction(const Eigen::Vector3d& v, bool flat) {
    return edits_.add("IFCDIRECTION((" + StepEdits::real(v.x()) + "," + StepEdits::real(v.y()) +
                      (flat ? "" : "," + StepEdits::real(v.z())) + "))");
  }

  std::string flat_point(const Eigen::Vector2d& p) {
    return edits_.add("IFCCARTESIANPOINT((" + StepEdits::real(p.x()) + "," + StepEdits::real(p.y()) + "))");
  }

  Eigen::Vector3d direction_of(const StepValue& reference) const {
    return step_point(entities_.attributes(reference, "IFCDIRECTION").at(0));
  }

  static std::string joined(const StepEntities::Entity& entity, const std::vector<std::string>& arguments) {
    std::string text(entity.type);
    for (std::size_t i = 0; i < arguments.size(); ++i) text += (i > 0 ? "," : "(") + arguments[i];
    return text + ")";
  }

  static std::vector<std::string> arguments_of(const StepValue& values) {
    std::vector<std::string> arguments;
    for (const StepValue& value : values.as_list()) arguments.push_back(step_argument(value));
    return arguments;
  }

  /// IFC++ turns by the axes only where all of them are given.
  void take_operator(const StepEntities::Entity& entity) {
    const bool flat = entity.type.substr(operator_type.size()).starts_with("2D");
    const StepValue values = entities_.attributes(entity);
    const std::vector<std::size_t> places = flat ? std::vector<std::size_t>{0, 1} : std::vector<std::size_t>{0, 1, 4};
    std::array<std::optional<Eigen::Vector3d>, 3> given;
    std::size_t count = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (values.at(places[i]).kind != Kind::reference) continue;
      given[i] = direction_of(values.at(places[i]));
      ++count;
    }
    if (count == 0 || count == places.size()) return;
    const std::optional<Eigen::Matrix3d> axes = base_axes(given, flat);
    if (!axes) return;
    std::vector<std::string> arguments = arguments_of(values);
    for (std::size_t i = 0; i < places.size(); ++i)
      arguments[places[i]] = direction(axes->col(static_cast<Eigen::Index>(i)), flat);
    edits_.replace(entity, joined(entity, arguments));
  }

  void take_mirrored(const StepEntities::Entity& entity) {
    const std::string parent = step_argument(entities_.attributes(entity).at(2));
    const std::string x = direction(-Eigen::Vector3d::UnitX(), true), y = direction(Eigen::Vector3d::UnitY(), true);
    const std::string mirror = edits_.add(std::string(operator_type) + "2D(" + x + "," + y + "," +
                                          flat_point(Eigen::Vector2d::Zero()) + ",$)");
    edits_.replace(entity, "IFCDERIVEDPROFILEDEF(.AREA.,$," + parent + "," + mirror + ",$)");
  }

  /// Without its roundings.
  void take_girder(const StepEntities::Entity& entity) {
    const StepValue values = entities_.attributes(entity);
    const double low = values.at(3).as_number() / 2.0, half = values.at(4).as_number() / 2.0;
    const double web = values.at(5).as_number() / 2.0, low_flange = values.at(6).as_number();
    const double high = values.at(8).as_number() / 2.0;
    const double high_flange = values.at(9).kind == Kind::number ? values.at(9).number : low_flange;
    if (!(std::min({low, high, low_flange, high_flange}) > 0.0 && web > 0.0 && web < std::min(low, high) &&
          low_flange + high_flange < 2.0 * half))
      return;
    Eigen::Affine2d X = Eigen::Affine2d::Identity();
    if (values.at(2).kind == Kind::reference) {
      const StepValue place = entities_.attributes(values.at(2), "IFCAXIS2PLACEMENT2D");
      X.translation() = cartesian_point(entities_, place.at(0)).head<2>();
      if (place.at(1).kind == Kind::reference) {
        const Eigen::Vector3d x = direction_of(place.at(1)).normalized();
        X.linear() << x.x(), -x.y(), x.y(), x.x();
      }
    }
    std::vector<Eigen::Vector2d> right = {{low, -half},
                                          {low, low_flange - half},
                                          {web, low_flange - half},
                                          {web, half - high_flange},
                                          {high, half - high_flange},
                                          {high, half}};
    std::string first, outline;
    const auto append = [&](const Eigen::Vector2d& p) {
      const std::string point = flat_point(X * p);
      if (first.empty()) first = point;
      outline += (outline.empty() ? "" : ",") + point;
    };
    for (const Eigen::Vector2d& p : right) append(p);
    std::reverse(right.begin(), right.end());
    for (const Eigen::Vector2d& p : right) append({-p.x(), p.y()});
    const std::string line = edits_.add("IFCPOLYLINE((" + outline + "," + first + "))");
    edits_.replace(entity, "IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$," + line + ")");
  }

  /// Their placement is a corner [iso2018, IfcBlock]; for IFC++ it is the middle, and a pyramid is half as high.
  void take_cornered(const StepEntities::Entity& entity) {
    const StepValue values = entities_.attributes(entity);
    const StepValue place = entities_.attributes(values.at(0), "IFCAXIS2PLACEMENT3D");
    std::array<std::optional<Eigen::Vector3d>, 3> given;
    if (place.at(1).kind == Kind::reference) given[2] = direction_of(place.at(1));
    if (place.at(2).kind == Kind::reference) given[0] = direction_of(place.at(2));
    const std::optional<Eigen::Matrix3d> axes = base_axes(given, false);
    if (!axes) return;
    const bool block = entity.type == block_type;
    const Eigen::Vector3d size(values.at(1).as_number(), values.at(2).as_number(), values.at(3).as_number());
    const Eigen::Vector3d half(0.5 * size.x(), 0.5 * size.y(), block ? 0.5 * size.z() : 0.0);
    const Eigen::Vector3d middle = cartesian_point(entities_, place.at(0)) + *axes * half;
    const std::string point = edits_.add("IFCCARTESIANPOINT((" + StepEdits::real(middle.x()) + "," +
                                         StepEdits::real(middle.y()) + "," + StepEdits::real(middle.z()) + "))");
    const std::string z = direction(axes->col(2), false), x = direction(axes->col(0), false);
    std::vector<std::string> arguments = arguments_of(values);
    arguments[0] = edits_.add("IFCAXIS2PLACEMENT3D(" + point + "," + z + "," + x + ")");
    if (!block) arguments[3] = StepEdits::real(2.0 * size.z());
    edits_.replace(entity, joined(entity, arguments));
  }

  /// The profiles that a composite one consists of; false where they are too many.
  bool collect_parts(const StepValue& profile, std::vector<std::string>& parts, int depth = 0) {
    constexpr int most_deep = 16;
    const StepEntities::Entity& entity = entities_.entity(profile.as_reference());
    if (entity.type != composite_type) {
      parts.push_back(step_argument(profile));
      return parts.size() <= most_parts;
    }
    if (++composites_ > most_composites) return false;
    const StepValue values = entities_.attributes(entity);
    const std::vector<StepValue>& profiles = values.at(2).as_list();
    return depth < most_deep && std::all_of(profiles.begin(), profiles.end(), [&](const StepValue& part) {
             return collect_parts(part, parts, depth + 1);
           });
  }

  /// IFC++ takes the length of the direction into the depth, and parts of a composite profile for holes of its first.
  void take_swept(const StepEntities::Entity& entity) {
    const StepValue values = entities_.attributes(entity);
    std::vector<std::string> arguments = arguments_of(values), parts;
    bool changed = false;
    if (entity.type.starts_with(extrusion_type)) {
      const Eigen::Vector3d along = direction_of(values.at(2));
      constexpr double rounding = 1e-5;  // of exporters
      if (const double length = along.norm(); length > 0.0 && std::abs(length - 1.0) > rounding) {
        arguments[2] = direction(along / length, false);
        changed = true;
      }
    }
    const bool composite = entities_.entity(values.at(0).as_reference()).type == composite_type;
    const bool tapered = entity.type.ends_with("TAPERED");
    if (tapered && entity.type.starts_with(extrusion_type))
      if (const std::optional<TaperedBody> body = tapered_body(entities_, values))
        return edits_.replace(entity, facets({{body->start, body->end}}));
    if (composite && !tapered && collect_parts(values.at(0), parts) && !parts.empty()) {
      std::vector<std::string> solids;
      for (const std::string& part : parts) {
        arguments[0] = part;
        solids.push_back(joined(entity, arguments));
      }
      return edits_.replace(entity, united(std::move(solids)));
    }
    if (changed) edits_.replace(entity, joined(entity, arguments));
  }

  /// False where there is none, or the file has too many of them.
  bool take_ring_body(const StepEntities::Entity& entity, const std::optional<RingBody>& body) {
    constexpr std::size_t entities_per_corner = 7, most_in_all = 10 * RingBody::most_corners;
    if (!body) return false;
    const std::size_t corners = body->rings.size() * body->rings.front().size();
    if (ring_corners_ + corners > most_in_all || !edits_.has_room(entities_per_corner * corners + 2)) return false;
    ring_corners_ += corners;
    edits_.replace(entity, facets(*body));
    return true;
  }

  std::string face(const std::vector<std::string>& corners) {
    std::string list;
    for (const std::string& corner : corners) list += (list.empty() ? "" : ",") + corner;
    const std::string bound = edits_.add("IFCFACEOUTERBOUND(" + edits_.add("IFCPOLYLOOP((" + list + "))") + ",.T.)");
    return edits_.add("IFCFACE((" + bound + "))");
  }

  /// IFC++ takes tapered bodies for such that keep their profile, and turns profiles on a surface.
  std::string facets(const RingBody& body) {
    const auto points = [&](const std::vector<Eigen::Vector3d>& corners) {
      std::vector<std::string> written;
      for (const Eigen::Vector3d& p : corners)
        written.push_back(edits_.add("IFCCARTESIANPOINT((" + StepEdits::real(p.x()) + "," + StepEdits::real(p.y()) +
                                     "," + StepEdits::real(p.z()) + "))"));
      return written;
    };
    std::vector<std::vector<std::string>> rings;
    for (const std::vector<Eigen::Vector3d>& ring : body.rings) rings.push_back(points(ring));
    std::string faces;
    const auto add = [&](const std::vector<std::string>& corners) {
      faces += (faces.empty() ? "" : ",") + face(corners);
    };
    if (!body.closed) add(rings.back());
    for (std::size_t ring = 0; ring + (body.closed ? 0 : 1) < rings.size(); ++ring) {
      const std::vector<std::string>&start = rings[ring], &end = rings[(ring + 1) % rings.size()];
      for (std::size_t i = 0; i < start.size(); ++i) {
        const std::size_t k = (i + 1) % start.size();
        add({start[i], start[k], end[k]});
        add({start[i], end[k], end[i]});
      }
    }
    if (!body.closed) add({rings.front().rbegin(), rings.front().rend()});
    return "IFCFACETEDBREP(" + edits_.add("IFCCLOSEDSHELL((" + faces + "))") + ")";
  }

  /// All of them as one entity.
  std::string united(std::vector<std::string> solids) {
    while (solids.size() > 1) {
      std::vector<std::string> pairs;
      for (std::size_t i = 0; i + 1 < solids.size(); i += 2) {
        const std::string a = edits_.add(solids[i]), b = edits_.add(solids[i + 1]);
        pairs.push_back("IFCBOOLEANRESULT(.UNION.," + a + "," + b + ")");
      }
      if (solids.size() % 2 == 1) pairs.push_back(solids.back());
      solids = std::move(pairs);
    }
    return solids.front();
  }

  /// More, as of profiles that hold each other many times over, are left to the reader.
  static constexpr std::size_t most_parts = 1000, most_composites = 10'000;

  StepEntities entities_;
  StepEdits edits_;
  std::optional<double> radian_;  ///< of the file's unit of angle, once it is needed
  std::size_t ring_corners_ = 0;  ///< written so far
  std::size_t composites_ = 0;    ///< seen so far, as often as they are referred to
};

}  // namespace

std::string with_plain_shapes(const std::string& text, const std::string& file) {
  constexpr std::array<std::string_view, 9> types{
      operator_type, extrusion_type, composite_type,          mirrored_type,     girder_type,
      block_type,    pyramid_type,   tapered_revolution_type, surface_sweep_type};
  const bool any =
      std::any_of(types.begin(), types.end(), [&](std::string_view t) { return text.find(t) != std::string::npos; });
  return any ? PlainShapes(text, file).read() : text;
}

}  // namespace plumbline::bim
