// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/read/double_elements.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bim/mesh/solid.h"

namespace plumbline::bim {
namespace {

constexpr double same_m = 1e-3;

struct Body {
  std::vector<Eigen::Vector3d> corners;  ///< in W, sorted
  double volume_m3 = 0.0;
};

Body body_of(const StepProduct& product) {
  Body body;
  for (const Shape& shape : product.body) {
    std::vector<std::string> problems;  // the reader names them when it takes the body
    Solid solid = solid_of(shape, problems);
    if (solid.triangles.empty()) continue;
    solid = placed(product.X_WP, std::move(solid));
    body.volume_m3 += std::abs(volume(solid));
    body.corners.insert(body.corners.end(), solid.vertices.begin(), solid.vertices.end());
  }
  std::sort(body.corners.begin(), body.corners.end(), [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
  });
  return body;
}

/// Whether every corner of one body lies at a corner of the other.
bool lies_in(const Body& one, const Body& other) {
  return std::all_of(one.corners.begin(), one.corners.end(), [&](const Eigen::Vector3d& p) {
    auto at = std::lower_bound(other.corners.begin(), other.corners.end(), p.x() - same_m,
                               [](const Eigen::Vector3d& q, double x) { return q.x() < x; });
    for (; at != other.corners.end() && at->x() <= p.x() + same_m; ++at)
      if ((*at - p).norm() <= same_m) return true;
    return false;
  });
}

bool same(const Body& a, const Body& b) {
  constexpr double least_share = 0.99;  // of bodies with the same corners only
  return !a.corners.empty() && !b.corners.empty() &&
         std::min(a.volume_m3, b.volume_m3) >= least_share * std::max(a.volume_m3, b.volume_m3) && lies_in(a, b) &&
         lies_in(b, a);
}

/// Of what the bodies are before anything is cut off, which tells most apart at once.
Eigen::AlignedBox3d box_of(const StepProduct& product) {
  Eigen::AlignedBox3d box;
  for (const Shape& shape : product.body)
    for (const Eigen::Vector3d& p : shape.base.points) box.extend(Eigen::Vector3d(product.X_WP * p));
  return box;
}

bool is_filling(const StepProduct& product) {
  return product.kind == StepClass::door || product.kind == StepClass::window;
}

/// Elements come before what cuts them, and that before what fills it.
int rank(const StepProduct& product) { return is_filling(product) ? 2 : product.kind == StepClass::opening ? 1 : 0; }

class Doubles {
 public:
  explicit Doubles(StepModel& model) : model_(model) {}

  void leave_out() {
    for (int now = 0; now < 3; ++now)
      for (std::size_t i = 0; i < model_.products.size(); ++i)
        if (rank(model_.products[i]) == now) take(i);
    for (StepProduct& product : model_.products) {
      redirect(product.host);
      redirect(product.whole);
    }
    std::erase_if(model_.products, [&](const StepProduct& product) { return first_.contains(product.step_id); });
  }

 private:
  bool redirect(std::int64_t& step_id) const {
    const auto found = first_.find(step_id);
    if (found == first_.end()) return false;
    step_id = found->second;
    return true;
  }

  void take(std::size_t index) {
    StepProduct& product = model_.products[index];
    // Two spaces in one place may differ by the thickness of the walls; they are told apart as rooms.
    if (product.kind == StepClass::storey || product.kind == StepClass::space || product.kind == StepClass::hidden)
      return;
    const bool of_double = redirect(product.host);
    redirect(product.whole);
    if (is_filling(product) && !product.has_body) {
      const auto [fills, fresh] = fillings_.try_emplace({product.type, product.host}, index);
      if (!fresh && of_double) drop(product, model_.products[fills->second]);
      return;
    }
    const Eigen::AlignedBox3d box = box_of(product);
    if (box.isEmpty()) return;
    const double x = box.min().x();
    for (auto at = by_x_.lower_bound(x - same_m); at != by_x_.end() && at->first <= x + same_m; ++at) {
      StepProduct& other = model_.products[at->second.index];
      const bool alike = product.type == other.type && product.whole == other.whole &&
                         (product.host == other.host || product.host == 0 || other.host == 0);
      const Eigen::AlignedBox3d& its = at->second.box;
      if (!alike || std::max((box.min() - its.min()).norm(), (box.max() - its.max()).norm()) > 2.0 * same_m) continue;
      if (!same(body_of(product), body_of(other))) continue;
      if (other.host == 0) other.host = product.host;
      return drop(product, other);
    }
    by_x_.emplace(x, Boxed{box, index});
  }

  void drop(const StepProduct& product, const StepProduct& first) {
    first_.emplace(product.step_id, first.step_id);
    model_.skipped.push_back({product.id, "drawn_twice",
                              product.type + " #" + std::to_string(product.step_id) + ": has the body of " +
                                  first.type + " #" + std::to_string(first.step_id) + " (" + first.id +
                                  "), and is left out"});
  }

  struct Boxed {
    Eigen::AlignedBox3d box;
    std::size_t index = 0;
  };

  StepModel& model_;
  std::map<std::int64_t, std::int64_t> first_;  ///< that is kept, by STEP number of one that is left out
  std::multimap<double, Boxed> by_x_;           ///< what is kept, by where it begins
  std::map<std::pair<std::string, std::int64_t>, std::size_t> fillings_;  ///< without bodies, by class and opening
};

}  // namespace

void leave_out_doubles(StepModel& model) { Doubles(model).leave_out(); }

}  // namespace plumbline::bim
