// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_curves.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "bim/config/tree.h"
#include "bim/formats/ifc/step/step_entities.h"

namespace plumbline::bim {
namespace {

using Kind = StepValue::Kind;
using Line = std::vector<Eigen::Vector3d>;

constexpr double corner_rad = std::numbers::pi / 18.0;
/// Curves of more points than this are left to the reader.
constexpr std::size_t most_points = 100'000;

Eigen::Vector3d curve_point(const StepValue& list) {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  const std::vector<StepValue>& items = list.as_list();
  for (std::size_t i = 0; i < std::min<std::size_t>(items.size(), 3); ++i)
    p[static_cast<Eigen::Index>(i)] = items[i].as_number();
  return p;
}

int corners_of(double angle) { return std::max(2, static_cast<int>(std::ceil(std::abs(angle) / corner_rad - 1e-6))); }

/// Points behind a up to c on the circle through a, b and c; c alone where these lie on a line.
void add_arc(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c, Line& line) {
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
  const int count = corners_of(angle);
  for (int i = 1; i < count; ++i) line.emplace_back(middle + Eigen::AngleAxisd(angle * i / count, axis) * from);
  line.push_back(c);
}

/// Directions of an IfcAxis2Placement2D or 3D: x in the first column.
std::optional<Eigen::Affine3d> conic_frame(const StepEntities& entities, std::int64_t number) {
  const StepEntities::Entity& entity = entities.entity(number);
  const StepValue values = entities.attributes(entity);
  const auto direction = [&](const StepValue& value, const Eigen::Vector3d& standard) -> Eigen::Vector3d {
    if (value.kind != Kind::reference) return standard;
    return curve_point(entities.attributes(value, "IFCDIRECTION").at(0));
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
  X.translation() = curve_point(entities.attributes(values.at(0), "IFCCARTESIANPOINT").at(0));
  return X;
}

/// The point among the values that trim a curve.
std::optional<Eigen::Vector3d> trimming_point(const StepEntities& entities, const StepValue& trims) {
  for (const StepValue& trim : trims.as_list())
    if (trim.kind == Kind::reference) return curve_point(entities.attributes(trim, "IFCCARTESIANPOINT").at(0));
  return std::nullopt;
}

/// IfcTrimmedCurve over a circle or an ellipse, between two points.
Line trimmed(const StepEntities& entities, const StepValue& values) {
  const StepEntities::Entity& basis = entities.entity(values.at(0).as_reference());
  const bool circle = basis.type == "IFCCIRCLE";
  if (!circle && basis.type != "IFCELLIPSE") return {};
  const auto first = trimming_point(entities, values.at(1)), last = trimming_point(entities, values.at(2));
  const StepValue conic = entities.attributes(basis);
  const std::optional<Eigen::Affine3d> X = conic_frame(entities, conic.at(0).as_reference());
  if (!first || !last || !X) return {};
  const double rx = conic.at(1).as_number(), ry = circle ? rx : conic.at(2).as_number();
  if (!(rx > 0.0 && ry > 0.0)) return {};
  const auto angle_of = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d q = X->inverse() * p;
    return std::atan2(q.y() / ry, q.x() / rx);
  };
  const bool forward = values.at(3).kind != Kind::enumeration || values.at(3).as_flag();
  const double from = angle_of(*first);
  double turn = angle_of(*last) - from;
  constexpr double whole = 2.0 * std::numbers::pi;
  while (forward && turn <= 1e-9) turn += whole;
  while (!forward && turn >= -1e-9) turn -= whole;
  const int count = corners_of(turn);
  Line line = {*first};
  for (int i = 1; i < count; ++i) {
    const double angle = from + turn * i / count;
    line.emplace_back(*X * Eigen::Vector3d(rx * std::cos(angle), ry * std::sin(angle), 0.0));
  }
  line.push_back(*last);
  return line;
}

/// IfcIndexedPolyCurve.
Line indexed(const StepEntities& entities, const StepValue& values, bool& flat) {
  const StepEntities::Entity& list = entities.entity(values.at(0).as_reference());
  flat = list.type == "IFCCARTESIANPOINTLIST2D";
  if (!flat && list.type != "IFCCARTESIANPOINTLIST3D") return {};
  Line points, line;
  for (const StepValue& p : entities.attributes(list).at(0).as_list()) points.push_back(curve_point(p));
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
      add_arc(at(indices[0]), at(indices[1]), at(indices[2]), line);
    } else {
      for (std::size_t i = 1; i < indices.size(); ++i) line.push_back(at(indices[i]));
    }
    if (line.size() > most_points) return {};
  }
  return line;
}

class Plain {
 public:
  Plain(const std::string& text, const std::string& file) : text_(text), entities_(text, file) {
    if (!entities_.all().empty()) next_ = entities_.all().back().number + 1;
  }

  std::string read() {
    for (const StepEntities::Entity& entity : entities_.all()) {
      try {
        take(entity);
      } catch (const InputError&) {  // what makes no sense is left to the reader, which says so of the element
      }
    }
    if (replaced_.empty()) return text_;
    std::string result;
    std::size_t done = 0;
    for (const auto& [begin, edit] : replaced_) {
      result.append(text_, done, begin - done).append(edit.second);
      done = edit.first;
    }
    result.append(text_, done, std::string::npos);
    const std::size_t end = result.rfind("ENDSEC");
    return end == std::string::npos ? text_ : result.insert(end, points_);
  }

 private:
  void take(const StepEntities::Entity& entity) {
    Line line;
    bool flat = false;
    if (entity.type == "IFCINDEXEDPOLYCURVE") {
      line = indexed(entities_, entities_.attributes(entity), flat);
    } else if (entity.type == "IFCTRIMMEDCURVE") {
      const StepValue values = entities_.attributes(entity);
      line = trimmed(entities_, values);
      const StepValue conic = entities_.attributes(values.at(0).as_reference());
      flat = entities_.entity(conic.at(0).as_reference()).type == "IFCAXIS2PLACEMENT2D";
    }
    if (line.size() < 2 || next_ + static_cast<std::int64_t>(line.size()) > most_number) return;
    std::string polyline = "IFCPOLYLINE((";
    for (std::size_t i = 0; i < line.size(); ++i) {
      const Eigen::Vector3d& p = line[i];
      points_ += "#" + std::to_string(next_) + "=IFCCARTESIANPOINT((" + real(p.x()) + "," + real(p.y()) +
                 (flat ? "" : "," + real(p.z())) + "));\n";
      polyline += (i > 0 ? ",#" : "#") + std::to_string(next_++);
    }
    const auto begin = static_cast<std::size_t>(entity.type.data() - text_.data());
    const std::size_t end = text_.find(';', begin);
    const std::string_view old(text_.data() + begin, end - begin);
    polyline += "))" + std::string(static_cast<std::size_t>(std::count(old.begin(), old.end(), '\n')), '\n');
    replaced_[begin] = {end, std::move(polyline)};
  }

  static std::string real(double v) {
    std::string text = format_number(v);
    std::replace(text.begin(), text.end(), 'e', 'E');
    const std::size_t exponent = std::min(text.find('E'), text.size());
    if (text.find('.') == std::string::npos) text.insert(exponent, ".");
    return text;
  }

  static constexpr std::int64_t most_number = 2'000'000'000;  // IFC++ keeps them in 32 bits

  const std::string& text_;
  StepEntities entities_;
  std::int64_t next_ = 1;
  std::map<std::size_t, std::pair<std::size_t, std::string>> replaced_;  ///< end and new text by begin
  std::string points_;
};

}  // namespace

std::string with_plain_curves(const std::string& text, const std::string& file) {
  if (text.find("IFCINDEXEDPOLYCURVE") == std::string::npos && text.find("IFCTRIMMEDCURVE") == std::string::npos)
    return text;
  return Plain(text, file).read();
}

}  // namespace plumbline::bim
