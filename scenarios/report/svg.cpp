// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/svg.h"

#include <array>
#include <charconv>
#include <cmath>

#include "bim/errors.h"

namespace plumbline::scenarios::svg {

std::string number(double value, int decimals) {
  if (!std::isfinite(value)) throw InternalError("report: a coordinate is not finite");
  std::array<char, 64> buffer{};
  const auto [end, error] =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, decimals);
  if (error != std::errc()) throw InternalError("report: a number does not fit its text");
  std::string text(buffer.data(), end);
  if (text.find('.') != std::string::npos) {
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

std::string escape(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string breakable(std::string_view name) {
  std::string out;
  for (const char c : escape(name)) {
    out += c;
    if (c == '.' || c == '_') out += "<wbr>";
  }
  return out;
}

std::string marked_up(std::string_view sentence) {
  std::string out;
  bool code = false;
  while (!sentence.empty()) {
    const std::size_t end = sentence.find('`');
    const std::string_view part = sentence.substr(0, end);
    out += code ? "<code>" + breakable(part) + "</code>" : escape(part);
    sentence.remove_prefix(end == std::string_view::npos ? sentence.size() : end + 1);
    code = !code;
  }
  return out;
}

std::string points(const std::vector<Eigen::Vector2d>& p, int decimals) {
  std::string out;
  for (const auto& v : p) {
    if (!out.empty()) out += ' ';
    out += number(v.x(), decimals) + "," + number(-v.y(), decimals);
  }
  return out;
}

std::string polyline(const std::vector<Eigen::Vector2d>& p, const std::string& attributes) {
  return "<polyline points=\"" + points(p) + "\" " + attributes + "/>";
}

std::string polygon(const Polygon2& p, const std::string& attributes, const std::string& title) {
  const std::string open = "<polygon points=\"" + points(p) + "\" " + attributes;
  return title.empty() ? open + "/>" : open + "><title>" + escape(title) + "</title></polygon>";
}

std::string line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const std::string& attributes) {
  return "<line x1=\"" + number(a.x()) + "\" y1=\"" + number(-a.y()) + "\" x2=\"" + number(b.x()) + "\" y2=\"" +
         number(-b.y()) + "\" " + attributes + "/>";
}

std::string circle(const Eigen::Vector2d& center, double radius, const std::string& attributes) {
  return "<circle cx=\"" + number(center.x()) + "\" cy=\"" + number(-center.y()) + "\" r=\"" + number(radius) + "\" " +
         attributes + "/>";
}

std::string text(const Eigen::Vector2d& at, std::string_view content, const std::string& attributes) {
  return "<text x=\"" + number(at.x()) + "\" y=\"" + number(-at.y()) + "\" " + attributes + ">" + escape(content) +
         "</text>";
}

}  // namespace plumbline::scenarios::svg
