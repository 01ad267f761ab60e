// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/dotted_key.h"

#include <utility>

namespace plumbline::scenarios {

const Tree* find_at(const Tree& tree, const std::string& key) {
  const std::size_t dot = key.find('.');
  const Tree* child = tree.is_map() ? tree.find(key.substr(0, dot)) : nullptr;
  return child == nullptr || dot == std::string::npos ? child : find_at(*child, key.substr(dot + 1));
}

void set_at(Tree& tree, const std::string& key, const Tree& value) {
  const std::size_t dot = key.find('.');
  const std::string first = key.substr(0, dot);
  if (dot == std::string::npos) {
    tree.set(first, value);
    return;
  }
  const Tree* old = tree.find(first);
  Tree child = old != nullptr && old->is_map() ? *old : Tree::map();
  set_at(child, key.substr(dot + 1), value);
  tree.set(first, std::move(child));
}

void erase_at(Tree& tree, const std::string& key) {
  if (!tree.is_map()) return;
  const std::size_t dot = key.find('.');
  const std::string first = key.substr(0, dot);
  auto& map = std::get<Tree::Map>(tree.value);
  if (dot == std::string::npos) {
    std::erase_if(map, [&](const auto& entry) { return entry.first == first; });
    return;
  }
  for (auto& [name, child] : map)
    if (name == first) erase_at(child, key.substr(dot + 1));
}

}  // namespace plumbline::scenarios
