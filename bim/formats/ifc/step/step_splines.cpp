// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_splines.h"

#include <algorithm>

#include "bim/formats/ifc/step/step_conics.h"

namespace plumbline::bim {
namespace {

constexpr std::size_t pieces_per_span = 9, most_pieces_per_span = 144, most_degree = 20, most_control_points = 10'000;

struct Spline {
  std::size_t degree = 0;
  std::vector<Eigen::Vector4d> control;  ///< with their weights, multiplied by these
  std::vector<double> knots;             ///< each as often as it counts

  [[nodiscard]] bool sound() const {
    return degree >= 1 && degree <= most_degree && control.size() > degree && control.size() <= most_control_points &&
           knots.size() == control.size() + degree + 1 && std::is_sorted(knots.begin(), knots.end()) &&
           std::all_of(control.begin(), control.end(), [](const Eigen::Vector4d& p) { return p.w() > 0.0; });
  }

  /// De Boor's algorithm at u, between the knots `span` and the next.
  [[nodiscard]] Eigen::Vector3d at(double u, std::size_t span) const {
    std::vector<Eigen::Vector4d> d(control.begin() + static_cast<std::ptrdiff_t>(span - degree),
                                   control.begin() + static_cast<std::ptrdiff_t>(span + 1));
    for (std::size_t r = 1; r <= degree; ++r) {
      for (std::size_t j = degree; j >= r; --j) {
        const double low = knots[j + span - degree], high = knots[j + 1 + span - r];
        const double share = high > low ? (u - low) / (high - low) : 0.0;
        d[j] = (1.0 - share) * d[j - 1] + share * d[j];
      }
    }
    return d[degree].hnormalized();
  }

  /// How many between two knots cut no deeper than `depth`, by the middle of each; within bounds.
  [[nodiscard]] std::size_t pieces(double low, double high, std::size_t span, double depth) const {
    if (degree == 1) return 1;
    for (std::size_t count = pieces_per_span; count < most_pieces_per_span; count *= 2) {
      const double step = (high - low) / static_cast<double>(count);
      double deepest = 0.0;
      for (std::size_t i = 0; i < count; ++i) {
        const double u = low + step * static_cast<double>(i);
        deepest = std::max(deepest, (at(u + 0.5 * step, span) - 0.5 * (at(u, span) + at(u + step, span))).norm());
      }
      if (deepest <= depth) return count;
    }
    return most_pieces_per_span;
  }
};

/// Knots of Bezier pieces one after the other, as IFC2X3 has them.
std::vector<double> bezier_knots(std::size_t degree, std::size_t control) {
  if (degree == 0 || control <= degree || (control - 1) % degree != 0) return {};
  const std::size_t pieces = (control - 1) / degree;
  std::vector<double> knots(1, 0.0);
  for (std::size_t i = 0; i <= pieces; ++i) knots.insert(knots.end(), degree, static_cast<double>(i));
  knots.push_back(static_cast<double>(pieces));
  return knots;
}

std::vector<double> knots_of(const StepValue& multiplicities, const StepValue& values) {
  const std::vector<StepValue>&counts = multiplicities.as_list(), &knots = values.as_list();
  std::vector<double> result;
  if (counts.size() != knots.size()) return {};
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const int count = counts[i].as_integer();
    if (count < 0 || static_cast<std::size_t>(count) > most_degree + 1) return {};
    result.insert(result.end(), static_cast<std::size_t>(count), knots[i].as_number());
  }
  return result;
}

}  // namespace

std::vector<Eigen::Vector3d> spline_points(const StepEntities& entities, const StepEntities::Entity& entity,
                                           double depth) {
  const bool bezier = entity.type.ends_with("BEZIERCURVE"), rational = entity.type.starts_with("IFCRATIONAL");
  if (!bezier && !entity.type.ends_with("BSPLINECURVEWITHKNOTS")) return {};
  const StepValue values = entities.attributes(entity);
  Spline spline;
  spline.degree = static_cast<std::size_t>(std::max(values.at(0).as_integer(), 0));
  constexpr std::size_t first_behind_knots = 8, first_behind_curve = 5;
  const std::vector<StepValue>& points = values.at(1).as_list();
  const StepValue weights = rational ? values.at(bezier ? first_behind_curve : first_behind_knots) : StepValue{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double weight = rational ? weights.at(i).as_number() : 1.0;
    spline.control.push_back(weight * cartesian_point(entities, points[i]).homogeneous());
  }
  spline.knots = bezier ? bezier_knots(spline.degree, points.size()) : knots_of(values.at(5), values.at(6));
  if (!spline.sound()) return {};
  std::vector<Eigen::Vector3d> line;
  for (std::size_t span = spline.degree; span < spline.control.size(); ++span) {
    const double low = spline.knots[span], high = spline.knots[span + 1];
    if (!(high > low)) continue;
    if (line.empty()) line.push_back(spline.at(low, span));
    const std::size_t pieces = spline.pieces(low, high, span, depth);
    for (std::size_t i = 1; i <= pieces; ++i)
      line.push_back(spline.at(low + (high - low) * static_cast<double>(i) / static_cast<double>(pieces), span));
  }
  return line;
}

}  // namespace plumbline::bim
