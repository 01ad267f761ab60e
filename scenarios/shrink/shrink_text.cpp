// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/shrink_text.h"

#include <array>
#include <cstdio>
#include <vector>

namespace plumbline::scenarios {

namespace {

Tree size_tree(const CaseSize& size) {
  Tree tree = Tree::map();
  tree.set("duration_s", size.duration_s).set("distance_m", size.distance_m).set("methods", size.methods);
  tree.set("rooms", size.rooms);
  if (size.elements) tree.set("elements", static_cast<std::int64_t>(*size.elements));
  return tree;
}

Tree list_tree(const std::vector<std::string>& names) {
  Tree list = Tree::list();
  for (const std::string& name : names) list.push(name);
  return list;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "nothing" : text;
}

std::string line(const char* what, double before, double after, int digits, const char* unit) {
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), "%-10s %8.*f -> %.*f%s\n", what, digits, before, digits, after, unit);
  return text.data();
}

}  // namespace

Tree to_results(const Shrunk& shrunk) {
  Tree tree = Tree::map();
  tree.set("plumbline", PLUMBLINE_VERSION).set("failure", to_results(shrunk.failure));
  tree.set("end", EnumNames<ShrinkEnd>::names[static_cast<std::size_t>(shrunk.end)]).set("runs", shrunk.runs);
  tree.set("before", size_tree(shrunk.before)).set("after", size_tree(shrunk.after));
  tree.set("needs", list_tree(shrunk.needed)).set("does_not_need", list_tree(shrunk.not_needed));
  tree.set("not_tried", list_tree(shrunk.not_tried));
  Tree steps = Tree::list();
  for (const ShrinkStep& step : shrunk.steps) {
    Tree entry = Tree::map();
    entry.set("tried", step.what).set("kept", step.kept);
    if (!step.why.empty()) entry.set("why", step.why);
    steps.push(std::move(entry));
  }
  return tree.set("steps", std::move(steps));
}

std::string shrink_text(const Shrunk& shrunk) {
  const CaseSize &before = shrunk.before, &after = shrunk.after;
  std::string text = "fails: " + describe(shrunk.failure) + "\n";
  text += line("duration", before.duration_s, after.duration_s, 1, " s");
  text += line("distance", before.distance_m, after.distance_m, 1, " m");
  text += line("methods", before.methods, after.methods, 0, "");
  text += line("rooms", before.rooms, after.rooms, 0, " of the route");
  if (before.elements && after.elements)
    text +=
        line("building", static_cast<double>(*before.elements), static_cast<double>(*after.elements), 0, " elements");
  else
    text += "building   as it was: only a plan (plan: 1) can be taken apart\n";
  text += "needs: " + joined(shrunk.needed) + "\ndoes not need: " + joined(shrunk.not_needed) + "\n";
  if (!shrunk.not_tried.empty()) text += "not tried alone: " + joined(shrunk.not_tried) + "\n";
  text += std::to_string(shrunk.runs) + " runs";
  if (shrunk.end == ShrinkEnd::max_runs) return text + "; more may go with more of them: --max-runs\n";
  if (shrunk.end == ShrinkEnd::interrupted) return text + "; interrupted, more may go\n";
  return text + "; of what is left nothing can go alone\n";
}

}  // namespace plumbline::scenarios
