// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "bim/geometry/pose.h"
#include "bim/symmetry/symmetry_scene.h"

namespace plumbline::bim {

namespace {

/// Surfaces that run the same way, by their area.
struct Heading {
  double angle = 0.0;
  double area = 0.0;
  double longest_m = 0.0;
};

/// How far the directions of two like surfaces of this length may differ, rad: their ends match within match_m.
double slack_of(double length_m, const SymmetryConfig& config) {
  return std::clamp(config.match_m / length_m, config.direction, config.direction_max);
}

double heading_of(const SurfaceRect& rect, bool mirrored) {
  const Eigen::Vector2d e = rect.direction();
  // A mirror image swaps p and q, which turns the direction round once more.
  return mirrored ? std::atan2(e.y(), -e.x()) : std::atan2(e.y(), e.x());
}

std::vector<Heading> headings_of(const SymmetryScene& scene, bool mirrored, const SymmetryConfig& config) {
  std::vector<Heading> all;
  for (const SurfaceRect& rect : scene.surfaces().rects())
    all.push_back({heading_of(rect, mirrored), rect.area(), rect.length()});
  std::stable_sort(all.begin(), all.end(), [](const Heading& a, const Heading& b) { return a.angle < b.angle; });
  std::vector<Heading> joined;
  for (const Heading& heading : all) {
    if (joined.empty() || heading.angle - joined.back().angle > config.direction) {
      joined.push_back(heading);
      continue;
    }
    Heading& last = joined.back();
    last.area += heading.area;
    last.longest_m = std::max(last.longest_m, heading.longest_m);
    last.angle += (heading.angle - last.angle) * heading.area / last.area;
  }
  if (joined.size() < 2) return joined;
  // The list is a circle: what ends at pi goes on at -pi.
  const double gap = joined.front().angle + 2.0 * std::numbers::pi - joined.back().angle;
  if (gap <= config.direction) {
    Heading& first = joined.front();
    const Heading& last = joined.back();
    first.area += last.area;
    first.longest_m = std::max(first.longest_m, last.longest_m);
    first.angle = wrap_angle(first.angle - gap * last.area / first.area);
    joined.pop_back();
    std::stable_sort(joined.begin(), joined.end(),
                     [](const Heading& a, const Heading& b) { return a.angle < b.angle; });
  }
  return joined;
}

/// Area of the headings within `slack` of an angle.
double area_near(const std::vector<Heading>& headings, double angle, double slack) {
  double area = 0.0;
  for (const double way_round : {-2.0, 0.0, 2.0}) {
    const double sought = angle + way_round * std::numbers::pi;
    auto found = std::lower_bound(headings.begin(), headings.end(), sought - slack,
                                  [](const Heading& h, double value) { return h.angle < value; });
    for (; found != headings.end() && found->angle <= sought + slack; ++found) area += found->area;
  }
  return area;
}

/// Area of the headings that a turn puts onto headings of the other list.
double common_area(const std::vector<Heading>& from, const std::vector<Heading>& to, double turn,
                   const SymmetryConfig& config) {
  double sum = 0.0;
  for (const Heading& heading : from)
    sum += std::min(heading.area, area_near(to, wrap_angle(heading.angle + turn), slack_of(heading.longest_m, config)));
  return sum;
}

/// Turns that put the most frequent heading onto one like it and most others too.
std::vector<double> turns_between(const SymmetryScene& from, const SymmetryScene& to, bool mirrored,
                                  const SymmetryConfig& config) {
  const std::vector<Heading> a = headings_of(from, mirrored, config), b = headings_of(to, false, config);
  std::vector<double> turns;
  if (a.empty()) return turns;
  double total = 0.0;
  for (const Heading& heading : a) total += heading.area;
  const auto by_area = [](const Heading& h, const Heading& k) { return h.area < k.area; };
  const Heading& main = *std::max_element(a.begin(), a.end(), by_area);  // of equal ones the lowest angle
  const double slack = slack_of(main.longest_m, config);
  // Rounded coordinates turn opposite walls into two headings, each off by the slack, or leave them one.
  const double around_main = area_near(a, main.angle, slack);
  for (const Heading& heading : b) {
    const double turn = wrap_angle(heading.angle - main.angle);
    if (heading.area < config.direction_share * main.area &&
        area_near(b, heading.angle, 2.0 * slack) < config.direction_share * around_main)
      continue;
    if (common_area(a, b, turn, config) >= config.direction_share * total) turns.push_back(turn);
  }
  std::sort(turns.begin(), turns.end());
  return turns;
}

/// Where the image of a surface would have to move to lie on a like one.
struct Vote {
  Eigen::Vector2d image, target;
  double weight = 0.0;
  [[nodiscard]] Eigen::Vector2d shift() const { return target - image; }
};

std::vector<Vote> votes_for(const SymmetryScene& from, const SymmetryScene& to, const Isometry2& g,
                            const SymmetryConfig& config) {
  std::vector<Vote> votes;
  std::vector<int> near;
  for (const SurfaceRect& rect : from.surfaces().rects()) {
    const SurfaceRect image = moved(g, rect);
    const Eigen::Vector2d middle = 0.5 * (image.p + image.q);
    to.surfaces().near(
        {Eigen::Vector2d(middle.array() - config.shift_max_m), Eigen::Vector2d(middle.array() + config.shift_max_m)},
        near);
    for (const int i : near) {
      const SurfaceRect& other = to.surfaces().rects()[static_cast<std::size_t>(i)];
      const Eigen::Vector2d target = 0.5 * (other.p + other.q);
      const bool like = (target - middle).lpNorm<Eigen::Infinity>() <= config.shift_max_m &&
                        (other.direction() - image.direction()).norm() <= slack_of(image.length(), config) &&
                        std::abs(other.length() - image.length()) <= config.match_m &&
                        std::abs(other.z0 - image.z0) <= config.match_m &&
                        std::abs(other.z1 - image.z1) <= config.match_m;
      if (!like) continue;
      votes.push_back({image.p, other.p, 0.5 * image.area()});
      votes.push_back({image.q, other.q, 0.5 * image.area()});
    }
  }
  return votes;
}

/// The shift that most votes ask for, to a bin; of equal ones the shortest, then the first by x and y.
std::optional<Eigen::Vector2d> most_wanted(const std::vector<Vote>& votes, double bin_m) {
  std::map<std::pair<int, int>, double> bins;
  for (const Vote& vote : votes) {
    const Eigen::Vector2i bin = (vote.shift() / bin_m).array().round().cast<int>();
    bins[{bin.x(), bin.y()}] += vote.weight;
  }
  std::optional<Eigen::Vector2d> best;
  double most = 0.0;
  for (const auto& [bin, weight] : bins) {
    double sum = 0.0;
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy) {
        const auto found = bins.find({bin.first + dx, bin.second + dy});
        if (found != bins.end()) sum += found->second;
      }
    const Eigen::Vector2d shift = bin_m * Eigen::Vector2d(bin.first, bin.second);
    if (!best || sum > most || (sum == most && shift.norm() < best->norm())) {
      best = shift;
      most = sum;
    }
  }
  return best;
}

/// Rigid motion that brings the images of these votes onto their targets, weighted least squares, after g.
Isometry2 fitted(const std::vector<Vote>& votes, const Isometry2& g) {
  Eigen::Vector2d image = Eigen::Vector2d::Zero(), target = Eigen::Vector2d::Zero();
  double weight = 0.0;
  for (const Vote& vote : votes) {
    image += vote.weight * vote.image;
    target += vote.weight * vote.target;
    weight += vote.weight;
  }
  image /= weight;
  target /= weight;
  double sine = 0.0, cosine = 0.0;
  for (const Vote& vote : votes) {
    const Eigen::Vector2d a = vote.image - image, b = vote.target - target;
    cosine += vote.weight * a.dot(b);
    sine += vote.weight * (a.x() * b.y() - a.y() * b.x());
  }
  return Isometry2::taking(std::atan2(sine, cosine), false, image, target) * g;
}

/// Settles the shift of g by narrowing the votes it agrees with.
std::optional<Isometry2> settled(const SymmetryScene& from, const SymmetryScene& to, Isometry2 g,
                                 const SymmetryConfig& config) {
  constexpr double bin_m = 0.05;
  std::vector<Vote> votes = votes_for(from, to, g, config);
  std::optional<Eigen::Vector2d> shift = most_wanted(votes, bin_m);
  if (!shift) return std::nullopt;
  Eigen::Vector2d wanted = *shift;
  for (const double window_m : {0.1, 0.02, 0.005, 0.002}) {
    std::vector<Vote> agreeing;
    for (const Vote& vote : votes)
      if ((vote.shift() - wanted).norm() <= window_m) agreeing.push_back(vote);
    if (agreeing.empty()) break;
    const Isometry2 better = fitted(agreeing, g);
    for (Vote& vote : votes) vote.image = better * (g.inverse() * vote.image);
    g = better;
    wanted.setZero();
  }
  return g;
}

}  // namespace

std::vector<Isometry2> candidates(const SymmetryScene& from, const SymmetryScene& to, bool mirrored,
                                  const SymmetryConfig& config) {
  constexpr double same = 1e-6;  // m and rad, rounding of a fit
  std::vector<Isometry2> result;
  for (const double turn : turns_between(from, to, mirrored, config)) {
    const Isometry2 about = Isometry2::taking(turn, mirrored, from.centroid(), to.centroid());
    const auto g = settled(from, to, about, config);
    if (!g) continue;
    const bool known = std::any_of(result.begin(), result.end(), [&](const Isometry2& other) {
      return std::abs(wrap_angle(other.angle - g->angle)) < same &&
             (other * from.centroid() - *g * from.centroid()).norm() < same;
    });
    if (!known) result.push_back(*g);
  }
  return result;
}

}  // namespace plumbline::bim
