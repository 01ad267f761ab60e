// SPDX-License-Identifier: Apache-2.0
#include "scenarios/hunt/sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>

namespace plumbline::scenarios {

namespace {

constexpr double below_one = 1.0 - 1e-12;

/// Each number of [0, count) once, in an order that is drawn.
std::vector<std::size_t> permutation(std::size_t count, const Stream& stream, std::uint32_t lane) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) {
    const double u = stream.uniform(i, lane, 0);
    std::swap(order[i - 1], order[static_cast<std::size_t>(u * static_cast<double>(i))]);
  }
  return order;
}

/// As a mirror at 0 and at 1 would.
double folded(double u) {
  const double turned = std::abs(std::remainder(u, 2.0));
  return std::min(turned, below_one);
}

/// In five digits, but a bound as it is where these pass it.
std::string rounded(double value, double least, double greatest) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.4e", value);
  return format_number(std::clamp(std::strtod(text.data(), nullptr), least, greatest));
}

}  // namespace

std::vector<Point> latin_hypercube(std::size_t count, std::size_t dimensions, const Stream& stream) {
  std::vector<Point> points(count, Point(dimensions));
  for (std::size_t k = 0; k < dimensions; ++k) {
    const auto lane = static_cast<std::uint32_t>(k);
    const std::vector<std::size_t> order = permutation(count, stream, lane);
    for (std::size_t i = 0; i < count; ++i)
      points[i][k] = std::min((static_cast<double>(order[i]) + stream.uniform(i, lane, 1)) / static_cast<double>(count),
                              below_one);
  }
  return points;
}

Point near_point(const Point& point, double sigma, const Stream& stream, std::uint64_t tick) {
  Point moved = point;
  for (std::size_t k = 0; k < moved.size(); ++k)
    moved[k] = folded(point[k] + sigma * stream.gauss(tick, static_cast<std::uint32_t>(k)));
  return moved;
}

std::string value_at(const HuntRange& range, double u) {
  if (!range.values.empty()) {
    const auto count = static_cast<double>(range.values.size());
    return range.values[std::min(static_cast<std::size_t>(u * count), range.values.size() - 1)];
  }
  const double least = *range.min, greatest = *range.max;
  if (range.whole) {
    const double first = std::ceil(least), last = std::floor(greatest);
    const double from = range.log ? std::log(first) : first, to = range.log ? std::log(last + 1.0) : last + 1.0;
    const double value = from + u * (to - from);
    // All digits: a scenario takes 1e+05 for no whole number.
    return std::to_string(std::llround(std::clamp(std::floor(range.log ? std::exp(value) : value), first, last)));
  }
  const double value = range.log ? least * std::pow(greatest / least, u) : least + u * (greatest - least);
  return rounded(value, least, greatest);
}

}  // namespace plumbline::scenarios
