// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "bim/config/schema.h"

namespace plumbline::docs {

/// A method and its keys.
struct MethodKeys {
  std::string name;
  bool standard = false;  ///< runs where no method is named
  std::vector<SchemaField> fields;
};

/// Where the keys of a method stand on the page.
struct KeysShown {
  std::string like;                  ///< the method that has the other keys; empty where all are shown
  std::vector<SchemaField> fields;   ///< what is shown
  std::vector<std::string> without;  ///< keys of `like` that the method does not have
};

/// For each method: all keys, or those that differ from a method shown in full, where that is at most a quarter of
/// them. Methods that run by default are shown in full first.
[[nodiscard]] std::vector<KeysShown> keys_shown(const std::vector<MethodKeys>& methods);

/// docs/reference/methods.md
[[nodiscard]] std::string methods_page();

}  // namespace plumbline::docs
