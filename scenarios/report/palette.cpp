// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/palette.h"

#include <algorithm>
#include <array>

namespace plumbline::scenarios {

namespace {

using enum InkUse;

constexpr std::array<Ink, 58> inks = {{
    {"paper", "#ffffff", "#1b2027", ground},
    {"ground", "#f3f5f8", "#14181e", ground},
    {"room", "#f8fafc", "#232a33", ground},
    {"ink", "#1c2430", "#e8edf3", text},
    {"soft", "#5d6b7c", "#a3b0bf", text},
    {"good", "#0a7d4f", "#3fd1a2", text},
    {"bad", "#c02f1d", "#ff9457", text},
    {"onbadge", "#ffffff", "#14181e", faint},
    {"goodfill", "#0a7d4f", "#3fd1a2", filled, "onbadge"},
    {"badfill", "#c02f1d", "#ff9457", filled, "onbadge"},
    {"softfill", "#5d6b7c", "#a3b0bf", filled, "onbadge"},
    {"line", "#d9dfe7", "#333c47", faint},
    {"thing", "#c3cbd6", "#4a5563", faint},
    {"wall", "#39424e", "#b9c4d0", graphic},
    {"truth", "#111111", "#ffffff", graphic},
    {"asbuilt", "#c76a00", "#f0a03c", graphic},
    {"planned", "#7a4a9e", "#c9a0ec", graphic},
    {"right", "#0a7d4f", "#3fd1a2", graphic},
    {"wrong", "#c02f1d", "#ff9457", graphic},
    {"focus", "#0072b2", "#56b4e9", graphic},
    // States of a localization, with black text upon them in both schemes (Okabe and Ito).
    {"onstate", "#111111", "#111111", faint},
    {"searching", "#e69f00", "#e69f00", filled, "onstate"},
    {"ambiguous", "#f0e442", "#f0e442", filled, "onstate"},
    {"converged", "#009e73", "#009e73", filled, "onstate"},
    {"lost", "#d55e00", "#e0752a", filled, "onstate"},
    // Methods in their order. Green and vermilion are left to right and wrong; the first seven stay apart for
    // colour-blind readers.
    {"m0", "#0072b2", "#4ba8e8", graphic},
    {"m1", "#bf7000", "#ffd75e", graphic},
    {"m2", "#0d1560", "#b07cff", graphic},
    {"m3", "#b8257f", "#e68600", graphic},
    {"m4", "#998763", "#a6f0ff", graphic},
    {"m5", "#4c2d00", "#f08cb4", graphic},
    {"m6", "#7b5cff", "#bf8256", graphic},
    {"m7", "#707880", "#f4f0c8", graphic},
    {"m8", "#8c6d31", "#93a3b3", graphic},
    {"m9", "#c0609a", "#cfae6a", graphic},
    {"m10", "#3a8fc0", "#e79ac4", graphic},
    {"m11", "#5b6770", "#9fd8ff", graphic},
    // Hypotheses that are not the true pose.
    {"o0", "#d55e00", "#ff8a3d", graphic},
    {"o1", "#0072b2", "#4ba8e8", graphic},
    {"o2", "#b0508e", "#e79ac4", graphic},
    {"o3", "#7a4a9e", "#c9a0ec", graphic},
    {"o4", "#3a8fc0", "#9fd8ff", graphic},
    // Errors along a path: the larger, the further from blue.
    {"e0", "#2c7fb8", "#6cb6ee", graphic},
    {"e1", "#7a6fb0", "#a99be6", graphic},
    {"e2", "#a5518f", "#d986c6", graphic},
    {"e3", "#c2452d", "#f0764a", graphic},
    {"e4", "#7d0f12", "#ff4d4d", graphic},
    // Places by the walk after which a pose is known there, and floor by whether it is reached.
    {"sure", "#3f9d6b", "#2f8f60", area},
    {"walk0", "#f6dd9a", "#6b5a24", area},
    {"walk1", "#f1c04f", "#94761e", area},
    {"walk2", "#e39a1e", "#c88a1c", area},
    {"walk3", "#b56d09", "#f3b755", area},
    {"never", "#c9402d", "#e0603f", area},
    {"reached", "#7cc4a0", "#2f6b4e", area},
    {"elsewhere", "#d8dde4", "#3c4652", area},
    {"shade", "#efc4be", "#63312a", area},
    {"deciding", "#b8257f", "#ff9ad5", graphic},
    {"walked", "#0b4f8a", "#6cb6ee", graphic},
}};

}  // namespace

std::span<const Ink> palette() { return inks; }

std::string palette_css() {
  std::string light = ":root{color-scheme:light dark", dark = "@media screen and (prefers-color-scheme:dark){:root{";
  for (const Ink& ink : inks) {
    light += ";--" + std::string(ink.name) + ":" + std::string(ink.light);
    dark += "--" + std::string(ink.name) + ":" + std::string(ink.dark) + ";";
  }
  return light + "}\n" + dark + "}}\n";
}

std::string method_ink(std::size_t method) { return "var(--m" + std::to_string(method % method_inks) + ")"; }

const Ink& method_colour(std::size_t method) {
  const std::string name = "m" + std::to_string(method % method_inks);
  return *std::find_if(inks.begin(), inks.end(), [&](const Ink& ink) { return ink.name == name; });
}

}  // namespace plumbline::scenarios
