// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_curves.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "bim/formats/ifc/step/step_conics.h"
#include "bim/formats/ifc/step/step_edits.h"
#include "bim/formats/ifc/step/step_entities.h"
#include "bim/formats/ifc/step/step_splines.h"
#include "bim/formats/ifc/step/step_units.h"

namespace plumbline::bim {
namespace {

using Kind = StepValue::Kind;
using Line = std::vector<Eigen::Vector3d>;

/// Curves of more points than this are left to the reader.
constexpr std::size_t most_points = 100'000;

/// Points behind a up to c on the circle through a, b and c; c alone where these lie on a line.
void add_arc(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, double depth, Line& line) {
  const Eigen::Vector3d u = b - a, v = c - a, n = u.cross(v);
  if (n.norm() <= 1e-9 * u.norm() * v.norm() || v.isZero(0.0)) {
    line.push_back(c);
    return;
  }
  const Eigen::Vector3d middle =
      a + (v.squaredNorm() * n.cross(u) + u.squaredNorm() * v.cross(n)) / (2.0 * n.squaredNorm());
  const Eigen::Vector3d from = a - middle, to = c - middle, axis = n.normalized();
  double angle = std::atan2(axis.dot(from.cross(to)), from.dot(to));
  if (angle <= 0.0) angle += 2.0 * std::numbers::pi;
  const int count = arc_pieces(angle, from.norm(), depth);
  for (int i = 1; i < count; ++i) line.emplace_back(middle + Eigen::AngleAxisd(angle * i / count, axis) * from);
  line.push_back(c);
}

/// Where a trimmed curve begins or ends: the point among the values, or what `at` makes of the parameter.
template <class At>
std::optional<Eigen::Vector3d> trimming_point(const StepEntities& entities, const StepValue& trims, At&& at) {
  for (const StepValue& trim : trims.as_list())
    if (trim.kind == Kind::reference) return cartesian_point(entities, trim);
  for (const StepValue& trim : trims.as_list())
    if (trim.kind == Kind::typed) return at(trim.as_typed().as_number());
  return std::nullopt;
}

/// A line between points, or parameters in lengths of its vector.
Line trimmed_line(const StepEntities& entities, const StepValue& values, const StepValue& line) {
  const Eigen::Vector3d origin = cartesian_point(entities, line.at(0));
  const StepValue vector = entities.attributes(line.at(1), "IFCVECTOR");
  const Eigen::Vector3d along = step_point(entities.attributes(vector.at(0), "IFCDIRECTION").at(0)).normalized();
  const auto at = [&](double u) {
    return std::optional<Eigen::Vector3d>(origin + u * vector.at(1).as_number() * along);
  };
  const auto first = trimming_point(entities, values.at(1), at), last = trimming_point(entities, values.at(2), at);
  return first && last ? Line{*first, *last} : Line{};
}

/// IfcTrimmedCurve over a line, an ellipse or a circle.
Line trimmed(const StepEntities& entities, const StepValue& values, std::optional<double> angle_rad, double depth,
             bool& flat) {
  const StepEntities::Entity& basis = entities.entity(values.at(0).as_reference());
  if (basis.type == "IFCLINE") {
    const StepValue line = entities.attributes(basis);
    flat = entities.attributes(line.at(0), "IFCCARTESIANPOINT").at(0).as_list().size() == 2;
    return trimmed_line(entities, values, line);
  }
  const std::optional<StepConic> conic = conic_of(entities, basis);
  if (!conic) return {};
  flat = conic->flat;
  const bool circle = basis.type == "IFCCIRCLE";
  // The reader guesses the unit of angle where the file gives none, and cuts small circles finely enough.
  const double whole = 2.0 * std::numbers::pi;
  const bool small = arc_pieces(whole, conic->rx, depth) == arc_pieces(whole, depth, depth);
  const auto at = [&](double u) {
    const bool left = circle && (small || (!angle_rad && std::abs(u) > whole));
    return left ? std::nullopt : std::optional(conic->at(u * angle_rad.value_or(1.0)));
  };
  const auto first = trimming_point(entities, values.at(1), at), last = trimming_point(entities, values.at(2), at);
  if (!first || !last) return {};
  return arc_between(*conic, *first, *last, values.at(3).kind != Kind::enumeration || values.at(3).as_flag(), depth);
}

/// IfcIndexedPolyCurve.
Line indexed(const StepEntities& entities, const StepValue& values, double depth, bool& flat) {
  const StepEntities::Entity& list = entities.entity(values.at(0).as_reference());
  flat = list.type == "IFCCARTESIANPOINTLIST2D";
  if (!flat && list.type != "IFCCARTESIANPOINTLIST3D") return {};
  Line points, line;
  for (const StepValue& p : entities.attributes(list).at(0).as_list()) points.push_back(step_point(p));
  if (values.at(1).kind != Kind::list) return points;
  const auto at = [&](const StepValue& index) -> const Eigen::Vector3d& {
    const int i = index.as_integer();
    if (i < 1 || static_cast<std::size_t>(i) > points.size())
      throw InputError(index.mark, "index " + std::to_string(i) + " is not one of the " +
                                       std::to_string(points.size()) + " points of the curve");
    return points[static_cast<std::size_t>(i - 1)];
  };
  for (const StepValue& segment : values.at(1).as_list()) {
    const std::vector<StepValue>& indices = segment.as_typed().as_list();
    if (indices.empty()) continue;
    if (line.empty()) line.push_back(at(indices[0]));
    if (segment.text == "IFCARCINDEX" && indices.size() == 3) {
      add_arc(at(indices[0]), at(indices[1]), at(indices[2]), depth, line);
    } else {
      for (std::size_t i = 1; i < indices.size(); ++i) line.push_back(at(indices[i]));
    }
    if (line.size() > most_points) return {};
  }
  return line;
}

class Plain {
 public:
  Plain(const std::string& text, const std::string& file)
      : entities_(text, file),
        edits_(text, entities_),
        angle_rad_(assigned_unit(entities_, "PLANEANGLEUNIT")),
        depth_(arc_depth_m / assigned_unit(entities_, "LENGTHUNIT").value_or(1.0)) {}

  std::string read() {
    take_each(entities_, [&](const StepEntities::Entity& entity) { take(entity); });
    return edits_.done();
  }

 private:
  void take(const StepEntities::Entity& entity) {
    Line line;
    bool flat = false;
    if (entity.type == "IFCINDEXEDPOLYCURVE") {
      line = indexed(entities_, entities_.attributes(entity), depth_, flat);
    } else if (entity.type == "IFCTRIMMEDCURVE") {
      line = trimmed(entities_, entities_.attributes(entity), angle_rad_, depth_, flat);
    } else if (entity.type.find("BSPLINECURVE") != std::string_view::npos || entity.type.ends_with("BEZIERCURVE")) {
      line = spline_points(entities_, entity, depth_);
      const StepValue first = entities_.attributes(entity).at(1).at(0);
      flat = entities_.attributes(first, "IFCCARTESIANPOINT").at(0).as_list().size() == 2;
    }
    if (line.size() < 2 || !edits_.has_room(line.size())) return;
    if (!std::all_of(line.begin(), line.end(), [](const Eigen::Vector3d& p) { return p.allFinite(); })) return;
    std::string polyline;
    for (const Eigen::Vector3d& p : line)
      polyline += (polyline.empty() ? "" : ",") +
                  edits_.add("IFCCARTESIANPOINT((" + StepEdits::real(p.x()) + "," + StepEdits::real(p.y()) +
                             (flat ? "" : "," + StepEdits::real(p.z())) + "))");
    edits_.replace(entity, "IFCPOLYLINE((" + polyline + "))");
  }

  StepEntities entities_;
  StepEdits edits_;
  std::optional<double> angle_rad_;
  double depth_;  ///< in the file's unit
};

}  // namespace

std::string with_plain_curves(const std::string& text, const std::string& file) {
  constexpr std::array<std::string_view, 4> types{"IFCINDEXEDPOLYCURVE", "IFCTRIMMEDCURVE", "BSPLINECURVE",
                                                  "BEZIERCURVE"};
  const bool any =
      std::any_of(types.begin(), types.end(), [&](std::string_view t) { return text.find(t) != std::string::npos; });
  return any ? Plain(text, file).read() : text;
}

}  // namespace plumbline::bim
