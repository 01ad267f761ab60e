// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace plumbline::scenarios {

/// A file of this folder that stands in the page as it is, with the SHA-256 by which the page's policy admits it.
struct ReplayAsset {
  std::string_view text;
  std::string_view sha256_hex;
};

/// Embedded by CMake, see embed.cmake.
extern const ReplayAsset replay_style;    ///< replay.css
extern const ReplayAsset replay_library;  ///< three/three.bundle.js
extern const ReplayAsset replay_script;   ///< all other scripts, in the order that CMakeLists.txt names

}  // namespace plumbline::scenarios
