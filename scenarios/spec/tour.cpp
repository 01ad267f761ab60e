// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/tour.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace plumbline::scenarios {

namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

using Links = std::vector<std::vector<std::pair<std::size_t, double>>>;  ///< neighbour and length, by place

/// Lengths of the ways from one place to all.
std::vector<double> lengths_from(std::size_t from, const Links& links) {
  using Entry = std::pair<double, std::size_t>;
  std::vector<double> length(links.size(), unknown);
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  length[from] = 0.0;
  open.emplace(0.0, from);
  while (!open.empty()) {
    const auto [here, place] = open.top();
    open.pop();
    if (here > length[place]) continue;
    for (const auto& [next, step] : links[place]) {
      if (here + step >= length[next]) continue;
      length[next] = here + step;
      open.emplace(length[next], next);
    }
  }
  return length;
}

/// A round that grows by one place at a time.
class Round {
 public:
  explicit Round(const Links& links) : links_(links) { choose(0, 0); }

  /// Of those left the one furthest from all chosen; none when none is left.
  [[nodiscard]] std::size_t furthest(const std::vector<char>& left) const {
    std::size_t best = left.size();
    for (std::size_t i = 0; i < left.size(); ++i)
      if (left[i] != 0 && nearest_[i] < unknown && (best == left.size() || nearest_[i] > nearest_[best])) best = i;
    return best;
  }

  /// Takes a place in where the round grows least, unless it becomes too long.
  void add(std::size_t place, double longest_m) {
    std::size_t best = 0;
    double least = unknown;
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const std::vector<double>&a = lengths_[i], &b = lengths_[(i + 1) % order_.size()];
      const double more = a[place] + b[place] - a[order_[(i + 1) % order_.size()]];
      if (more >= least) continue;
      least = more;
      best = i;
    }
    if (length_m_ + least > longest_m) return;
    length_m_ += least;
    choose(place, best + 1);
  }

  [[nodiscard]] std::vector<std::size_t> order() const { return {order_.begin() + 1, order_.end()}; }

 private:
  void choose(std::size_t place, std::size_t at) {
    std::vector<double> lengths = lengths_from(place, links_);
    nearest_.resize(links_.size(), unknown);
    for (std::size_t i = 0; i < links_.size(); ++i) nearest_[i] = std::min(nearest_[i], lengths[i]);
    order_.insert(order_.begin() + static_cast<std::ptrdiff_t>(at), place);
    lengths_.insert(lengths_.begin() + static_cast<std::ptrdiff_t>(at), std::move(lengths));
  }

  const Links& links_;
  std::vector<std::size_t> order_;
  std::vector<std::vector<double>> lengths_;  ///< from each place of the round to all
  std::vector<double> nearest_;               ///< from any place of the round, by place
  double length_m_ = 0.0;
};

}  // namespace

std::vector<std::size_t> tour(std::size_t places, const std::vector<sim::NeighbourWay>& ways, double longest_m) {
  if (places == 0) return {};
  Links links(places);
  for (const sim::NeighbourWay& way : ways) {
    links[way.a].emplace_back(way.b, way.length_m);
    links[way.b].emplace_back(way.a, way.length_m);
  }
  Round round(links);
  std::vector<char> left(places, 1);
  left[0] = 0;
  for (std::size_t next = round.furthest(left); next < places; next = round.furthest(left)) {
    round.add(next, longest_m);
    left[next] = 0;
  }
  return round.order();
}

}  // namespace plumbline::scenarios
