// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/building_parts.h"

#include <algorithm>
#include <set>

#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "scenarios/spec/dotted_key.h"

namespace plumbline::scenarios {

namespace {

using Ids = std::set<std::string>;

std::string text_at(const Tree& entry, const std::string& key) {
  const Tree* value = entry.is_map() ? entry.find(key) : nullptr;
  return value != nullptr && value->is_scalar() && !value->is_null() ? value->as_string() : std::string();
}

Tree::List list_at(const Tree& plan, const std::string& key) {
  const Tree* list = plan.find(key);
  return list != nullptr && list->is_list() ? list->as_list() : Tree::List();
}

/// Takes the entries out of which one of these keys names one of `gone`; returns their ids.
Ids drop_where(Tree& plan, const std::string& kind, const std::vector<std::string>& keys, const Ids& gone) {
  Tree::List list = list_at(plan, kind);
  Ids dropped;
  const auto goes = [&](const Tree& entry) {
    return std::any_of(keys.begin(), keys.end(), [&](const auto& key) { return gone.contains(text_at(entry, key)); });
  };
  for (const Tree& entry : list)
    if (goes(entry)) dropped.insert(text_at(entry, "id"));
  if (dropped.empty()) return dropped;
  std::erase_if(list, goes);
  plan.set(kind, Tree(std::move(list)));
  return dropped;
}

/// Rooms do not name walls that are not there.
void forget_walls(Tree& plan, const Ids& walls) {
  Tree::List rooms = list_at(plan, "rooms");
  for (Tree& room : rooms) {
    const Tree* named = room.find("walls");
    if (named == nullptr || !named->is_list()) continue;
    Tree::List left = named->as_list();
    std::erase_if(left, [&](const Tree& wall) { return walls.contains(wall.as_string()); });
    if (left.empty())
      erase_at(room, "walls");
    else
      room.set("walls", Tree(std::move(left)));
  }
  if (!rooms.empty()) plan.set("rooms", Tree(std::move(rooms)));
}

/// Whether a material's name stands anywhere else in the plan.
bool is_used(const Tree& tree, const std::string& id) {
  if (tree.is_list())
    return std::any_of(tree.as_list().begin(), tree.as_list().end(), [&](const Tree& t) { return is_used(t, id); });
  if (!tree.is_map()) return false;
  return std::any_of(tree.as_map().begin(), tree.as_map().end(), [&](const auto& entry) {
    const bool names = entry.first.ends_with("material") && entry.second.is_scalar() && entry.second.as_string() == id;
    return names || is_used(entry.second, id);
  });
}

void drop_unused_materials(Tree& plan) {
  Tree::List materials = list_at(plan, "materials");
  if (materials.empty()) return;
  std::erase_if(materials, [&](const Tree& material) { return !is_used(plan, text_at(material, "id")); });
  plan.set("materials", Tree(std::move(materials)));
}

/// What cannot be without the storeys, walls or openings that go. Ids tell elements of one kind apart, not those of
/// two.
void drop_dependents(Tree& plan, const std::string& kind, const Ids& gone) {
  const auto of_kind = [&](const char* which) { return kind == which ? gone : Ids(); };
  const Ids storeys = of_kind("storeys");
  Ids walls = of_kind("walls"), openings = of_kind("openings");
  walls.merge(drop_where(plan, "walls", {"storey"}, storeys));
  for (const char* stands : {"rooms", "columns", "clutter"}) (void)drop_where(plan, stands, {"storey"}, storeys);
  (void)drop_where(plan, "stairs", {"from", "to"}, storeys);
  openings.merge(drop_where(plan, "openings", {"wall"}, walls));
  forget_walls(plan, walls);
  (void)drop_where(plan, "deviations", {"storey"}, storeys);
  (void)drop_where(plan, "deviations", {"wall"}, walls);
  (void)drop_where(plan, "deviations", {"opening"}, openings);
}

}  // namespace

std::optional<Tree> plan_tree(const std::string& bytes, const std::string& name) {
  if (!name.ends_with(".yaml") && !name.ends_with(".yml")) return std::nullopt;
  Tree plan = read_yaml(bytes, name);
  return plan.is_map() && plan.find("plan") != nullptr ? std::optional(std::move(plan)) : std::nullopt;
}

const std::vector<std::string>& kinds_of_parts() {
  static const std::vector<std::string> kinds = {"storeys", "deviations", "clutter", "columns",
                                                 "stairs",  "walls",      "rooms",   "openings"};
  return kinds;
}

std::size_t parts_in(const Tree& plan, const std::string& kind) { return list_at(plan, kind).size(); }

std::size_t parts_in(const Tree& plan) {
  std::size_t count = 0;
  for (const std::string& kind : kinds_of_parts()) count += parts_in(plan, kind);
  return count;
}

Tree with_parts(const Tree& plan, const std::string& kind, const Kept& kept) {
  const Tree::List all = list_at(plan, kind);
  Tree::List left;
  Ids gone;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::binary_search(kept.begin(), kept.end(), i))
      left.push_back(all[i]);
    else if (const std::string id = text_at(all[i], "id"); !id.empty())
      gone.insert(id);
  }
  Tree fewer = plan;
  fewer.set(kind, Tree(std::move(left)));
  drop_dependents(fewer, kind, gone);
  erase_at(fewer, "symmetry");
  drop_unused_materials(fewer);
  return fewer;
}

std::string plan_text(const Tree& plan) {
  std::string text = bim::write_plan(bim::plan_entries(plan));
  (void)bim::read_plan_with_deviations(text, "building.plan.yaml");
  return text;
}

}  // namespace plumbline::scenarios
