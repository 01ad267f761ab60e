// SPDX-License-Identifier: Apache-2.0
// Contrast by WCAG 2.2 (relative luminance of sRGB), and what is left of the methods' colours to a colour-blind reader,
// by the matrices of Machado, Oliveira and Fernandes (2009) for full deficiency.
#include "scenarios/report/palette.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>

#include "scenarios/report/page.h"

namespace plumbline::scenarios {
namespace {

Eigen::Vector3d linear(std::string_view colour) {
  Eigen::Vector3d rgb;
  for (int i = 0; i < 3; ++i) {
    const double c = std::stoi(std::string(colour.substr(static_cast<std::size_t>(1 + 2 * i), 2)), nullptr, 16) / 255.0;
    rgb[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  return rgb;
}

double contrast(std::string_view a, std::string_view b) {
  const Eigen::Vector3d weights(0.2126, 0.7152, 0.0722);
  const double x = weights.dot(linear(a)), y = weights.dot(linear(b));
  return (std::max(x, y) + 0.05) / (std::min(x, y) + 0.05);
}

const Ink& ink(std::string_view name) {
  const auto all = palette();
  return *std::find_if(all.begin(), all.end(), [&](const Ink& one) { return one.name == name; });
}

TEST(Palette, KnowsContrast) {
  EXPECT_NEAR(contrast("#ffffff", "#000000"), 21.0, 1e-9);
  EXPECT_NEAR(contrast("#767676", "#ffffff"), 4.54, 0.005);  // the lightest grey of the standard's examples
}

TEST(Palette, IsLegibleInBothSchemes) {
  for (const Ink& one : palette()) {
    const auto at_least = [&](double least, std::string_view below) {
      EXPECT_GE(contrast(one.light, ink(below).light), least) << one.name << " on " << below << ", light";
      EXPECT_GE(contrast(one.dark, ink(below).dark), least) << one.name << " on " << below << ", dark";
    };
    if (one.use == InkUse::text)
      for (const char* below : {"paper", "ground", "room"}) at_least(4.5, below);
    if (one.use == InkUse::graphic)
      for (const char* below : {"paper", "room"}) at_least(3.0, below);
    if (one.use == InkUse::filled) at_least(4.5, one.on);
  }
}

/// CIE L*a*b* (D65) of linear sRGB.
Eigen::Vector3d lab(const Eigen::Vector3d& rgb) {
  Eigen::Matrix3d to_xyz;
  to_xyz << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  const Eigen::Vector3d xyz = (to_xyz * rgb).cwiseQuotient(Eigen::Vector3d(0.9505, 1.0, 1.089));
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; };
  return {116.0 * f(xyz.y()) - 16.0, 500.0 * (f(xyz.x()) - f(xyz.y())), 200.0 * (f(xyz.y()) - f(xyz.z()))};
}

TEST(Palette, KeepsTheFirstSevenMethodsApartForColourBlindReaders) {
  Eigen::Matrix3d protan, deutan;
  protan << 0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116, 1.051998;
  deutan << 0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940, 0.968881;
  constexpr double apart = 12.0;  // of L*a*b*; 2.3 is just noticeable on large areas side by side
  for (const auto scheme : {&Ink::light, &Ink::dark})
    for (const Eigen::Matrix3d& seen : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), protan, deutan})
      for (std::size_t i = 0; i < 7; ++i)
        for (std::size_t j = 0; j < i; ++j) {
          const auto of = [&](std::size_t k) {
            return lab((seen * linear(method_colour(k).*scheme)).cwiseMax(0.0).cwiseMin(1.0));
          };
          EXPECT_GT((of(i) - of(j)).norm(), apart) << i << " and " << j;
        }
}

TEST(Palette, NoMethodIsGreen) {
  for (std::size_t i = 0; i < method_inks; ++i)
    for (const auto scheme : {&Ink::light, &Ink::dark}) {
      const Eigen::Vector3d rgb = linear(method_colour(i).*scheme);
      EXPECT_FALSE(rgb.y() > 1.3 * rgb.x() && rgb.y() > 1.3 * rgb.z()) << i;
    }
}

TEST(Palette, EveryColourOfTheStyleSheetIsInIt) {
  const std::string_view text = page_style();
  const auto all = palette();
  for (std::size_t at = 0; (at = text.find("var(--", at)) != std::string::npos; ++at) {
    const std::string_view name = text.substr(at + 6, text.find(')', at) - at - 6);
    EXPECT_TRUE(name == "px" || std::any_of(all.begin(), all.end(), [&](const Ink& one) { return one.name == name; }))
        << name;
  }
  const std::string css = palette_css();
  EXPECT_NE(css.find(";--ink:#1c2430;"), std::string::npos);
  EXPECT_NE(css.find("@media screen and (prefers-color-scheme:dark){:root{--paper:#1b2027;"), std::string::npos);
}

}  // namespace
}  // namespace plumbline::scenarios
