// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "bim/config/tree.h"

namespace plumbline {

/// A tree that is built from the events of a parser. Keys are compared with those of their own map alone, in a time
/// that grows with them, and none is lost silently.
class NestedTree {
 public:
  /// Of lists and maps that are open.
  [[nodiscard]] std::size_t depth() const { return stack_.size(); }
  /// Whether a map is open that has no key for its next value.
  [[nodiscard]] bool wants_key() const {
    return !stack_.empty() && stack_.back().tree.is_map() && !stack_.back().has_key;
  }

  /// Of the next value of a map that is open. Throws InputError where it has the key.
  void set_key(const Mark& mark, std::string key) {
    Level& level = stack_.back();
    if (!level.keys.insert(key).second) throw InputError(mark, "duplicate key '" + key + "'; each key may stand once");
    level.key = std::move(key);
    level.has_key = true;
  }
  /// A list or a map, until close().
  void open(Tree tree) { stack_.push_back({std::move(tree), {}, {}, false}); }
  void close() {
    Tree done = std::move(stack_.back().tree);
    stack_.pop_back();
    add(std::move(done));
  }
  /// Throws InputError in a map that wants a key.
  void add(Tree tree) {
    if (stack_.empty()) {
      root_ = std::move(tree);
      return;
    }
    if (wants_key()) throw InputError(tree.mark, "a key is missing");
    Level& level = stack_.back();
    if (level.tree.is_list())
      level.tree.push(std::move(tree));
    else
      std::get<Tree::Map>(level.tree.value).emplace_back(std::move(level.key), std::move(tree));
    level.has_key = false;
  }
  [[nodiscard]] Tree take() { return std::move(root_); }

 private:
  struct Level {
    Tree tree;
    std::set<std::string> keys;  ///< so far, of a map
    std::string key;
    bool has_key = false;
  };

  Tree root_;
  std::vector<Level> stack_;
};

}  // namespace plumbline
