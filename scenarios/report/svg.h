// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "bim/geometry/polygon.h"

namespace plumbline::scenarios::svg {

/// Fixed decimals without trailing zeros, so that pages stay small and byte-stable.
[[nodiscard]] std::string number(double value, int decimals = 3);
/// Text safe inside HTML and attributes.
[[nodiscard]] std::string escape(std::string_view text);
/// A name of code, escaped, that a browser may break after its dots and underscores.
[[nodiscard]] std::string breakable(std::string_view name);
/// A sentence, escaped: what stands in backticks as code.
[[nodiscard]] std::string marked_up(std::string_view sentence);
/// "x,y x,y ..." with y pointing up on the page.
[[nodiscard]] std::string points(const std::vector<Eigen::Vector2d>& p, int decimals = 3);
[[nodiscard]] std::string polyline(const std::vector<Eigen::Vector2d>& p, const std::string& attributes);
[[nodiscard]] std::string polygon(const Polygon2& p, const std::string& attributes, const std::string& title = "");
[[nodiscard]] std::string line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const std::string& attributes);
[[nodiscard]] std::string circle(const Eigen::Vector2d& center, double radius, const std::string& attributes);
[[nodiscard]] std::string text(const Eigen::Vector2d& at, std::string_view content, const std::string& attributes);

}  // namespace plumbline::scenarios::svg
