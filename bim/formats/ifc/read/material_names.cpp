// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/read/material_names.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace plumbline::bim {
namespace {

constexpr std::array<std::string_view, 7> glass_words{"glas", "glazing", "verre", "vidrio", "vetro", "vidro", "glaz"};
constexpr std::array<std::string_view, 8> other_words{"wool",  "wolle", "fib",     "faser",
                                                      "block", "foam",  "frosted", "frame"};

/// Clear glass at 905 nm, near square incidence: 8 % mirrored at its two faces, dust scatters a little, the rest is
/// absorbed.
constexpr double glass_reflectivity = 0.001, glass_transmission = 0.85, glass_specular = 0.08;

}  // namespace

bool says_glass(std::string_view name) {
  std::string lower;
  for (const char c : name) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto has = [&](std::string_view word) { return lower.find(word) != std::string::npos; };
  return std::any_of(glass_words.begin(), glass_words.end(), has) &&
         std::none_of(other_words.begin(), other_words.end(), has);
}

Material material_named(const std::string& name) {
  Material material;
  material.id = name;
  if (!says_glass(name)) return material;
  material.reflectivity = glass_reflectivity;
  material.transmission = glass_transmission;
  material.specular = glass_specular;
  return material;
}

}  // namespace plumbline::bim
