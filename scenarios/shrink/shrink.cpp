// SPDX-License-Identifier: Apache-2.0
#include "scenarios/shrink/shrink.h"

#include <algorithm>
#include <cmath>

#include "bim/errors.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/shrink/building_parts.h"
#include "scenarios/shrink/ingredients.h"
#include "scenarios/shrink/shrink_search.h"
#include "scenarios/spec/dotted_key.h"
#include "scenarios/spec/method_names.h"
#include "scenarios/spec/scenario.h"

namespace plumbline::scenarios {

namespace {

std::size_t length_at(const Tree& tree, const std::string& key) {
  const Tree* list = find_at(tree, key);
  return list != nullptr && list->is_list() ? list->as_list().size() : 0;
}

double number_at(const Tree& tree, const std::string& key, double otherwise) {
  const Tree* value = find_at(tree, key);
  return value != nullptr && value->is_scalar() && !value->is_null() ? value->as_double() : otherwise;
}

/// The scenario with the failing method alone, and of the gates the one that failed.
RunCase alone(RunCase run, const FailureSignature& failure) {
  Tree methods = Tree::list(), gates = Tree::list(), processes = Tree::list();
  methods.push(failure.method);
  const auto entries = [&](const char* key) {
    return length_at(run.scenario, key) > 0 ? run.scenario.find(key)->as_list() : Tree::List();
  };
  for (const Tree& gate : entries("gates")) {
    const auto bound = gate.find(failure.gate && failure.gate->op == "<=" ? "max" : "min");
    if (failure.gate && gate.find("method")->as_string() == failure.method && bound != nullptr &&
        gate.find("metric")->as_string() == failure.gate->metric && bound->as_double() == failure.gate->limit)
      gates.push(gate);
  }
  for (const Tree& process : entries("processes"))
    if (process.find("name")->as_string() == choice_of(failure.method).method) processes.push(process);
  run.scenario.set("methods", methods).set("gates", gates).set("processes", processes);
  return run;
}

/// The run fails again at all, the method alone if that will do.
void repeat(ShrinkSearch& search, const FailureSignature& failure, const ShrinkOptions& options) {
  std::vector<ShrinkCandidate> candidates;
  const RunCase whole = search.best();
  if (length_at(whole.scenario, "methods") > 1)
    candidates.push_back({"without the other methods", [&] { return alone(whole, failure); }});
  candidates.push_back({"nothing, to see it fail again", [&] { return whole; }});
  if (search.first_failing(candidates)) return;
  if (search.is_exhausted())
    throw InputError({options.named, 0, 0}, "'" + failure.method + "' alone does not fail the same way (" +
                                                search.steps().back().why + "), and no run is left to see whether " +
                                                "all methods together do; --max-runs 2 or more");
  throw InputError({options.named, 0, 0}, "does not fail the same way when it is run again (" +
                                              search.steps().back().why +
                                              "); another build of the program may have made it");
}

double duration_of(const ShrinkSearch& search) {
  return number_at(search.best().scenario, "duration_s", Scenario().duration_s);
}

bool cut_to(ShrinkSearch& search, double seconds) {
  return search
      .first_failing({{"cut to " + format_number(seconds) + " s",
                       [&] {
                         RunCase run = search.best();
                         run.scenario.set("duration_s", seconds);
                         return run;
                       }}})
      .has_value();
}

/// To where the walk ends, to shortly after the failure, and by halves: what is left has time to spare, so that other
/// cuts do not fail for want of it.
void cut_coarsely(ShrinkSearch& search, const FailureSignature& failure) {
  constexpr double spare_s = 10.0;
  const double end_s = std::ceil(number_at(search.results(), "duration_s", duration_of(search)));
  if (end_s < duration_of(search)) (void)cut_to(search, end_s);
  const double failed_s = number_at(search.results(), "methods." + failure.method + ".localization.failure_at_s", 0.0);
  const double first = std::ceil(failed_s) + spare_s;
  if (failed_s > 0.0 && first < duration_of(search)) (void)cut_to(search, first);
  while (duration_of(search) >= 2.0 * spare_s && cut_to(search, std::ceil(duration_of(search) / 2.0))) continue;
}

/// What a run does up to some time does not depend on when it is to end, so times are halved between one that is long
/// enough and one that is not.
void cut_finely(ShrinkSearch& search) {
  constexpr double finest_s = 1.0, finest_share = 0.05;
  double fails = duration_of(search), passes = 0.0;
  while (fails - passes > std::max(finest_s, finest_share * fails) && !search.is_exhausted()) {
    const double middle = std::floor((fails + passes) / 2.0);
    (middle >= 1.0 && cut_to(search, middle) ? fails : passes) = middle;
  }
}

std::vector<std::string> names_of_all(const std::vector<Ingredient>& ingredients) {
  std::vector<std::string> names;
  for (const Ingredient& ingredient : ingredients) names.push_back(ingredient.name);
  return names;
}

/// Of a building that is no plan its furniture goes as a whole.
std::vector<Ingredient> all_ingredients(const RunCase& run) {
  std::vector<Ingredient> all = ingredients_of(run.scenario);
  const Tree* furniture = run.scenario.find("furniture");
  if (!plan_tree(*run.bytes, run.building) && furniture != nullptr && furniture->as_bool())
    all.push_back({"furniture", "furniture", std::nullopt, Tree(false)});
  return all;
}

bool leave_out(ShrinkSearch& search, const std::vector<Ingredient>& ingredients) {
  return search.minimize_parts(names_of_all(ingredients), [&](const RunCase& best, const Kept& kept) {
    RunCase run = best;
    run.scenario = with_ingredients(best.scenario, ingredients, kept);
    return run;
  });
}

bool simplify(ShrinkSearch& search) {
  const bool coarse = leave_out(search, all_ingredients(search.best()));
  return leave_out(search, effects_of(search.best().scenario)) || coarse;
}

bool walk_once(ShrinkSearch& search, const std::string& key) {
  if (number_at(search.best().scenario, key, 1.0) <= 1.0) return false;
  return search
      .first_failing({{key + " 1",
                       [&] {
                         RunCase run = search.best();
                         set_at(run.scenario, key, Tree(1));
                         return run;
                       }}})
      .has_value();
}

bool shorten_route(ShrinkSearch& search) {
  bool any = walk_once(search, "route.loop");
  any = walk_once(search, "route.times") || any;
  const Tree* rooms = find_at(search.best().scenario, "route.rooms");
  if (rooms == nullptr || !rooms->is_list() || rooms->as_list().size() < 2) return any;
  const Tree::List list = rooms->as_list();
  std::vector<std::string> names;
  for (const Tree& room : list) names.push_back("a walk to " + room.as_string());
  const bool shorter = search.minimize_parts(names, [&](const RunCase& best, const Kept& kept) {
    Tree left = Tree::list();
    for (const std::size_t i : kept) left.push(list[i]);
    RunCase run = best;
    set_at(run.scenario, "route.rooms", left);
    return run;
  });
  return shorter || any;
}

bool take_building_apart(ShrinkSearch& search) {
  bool any = false;
  for (const std::string& kind : kinds_of_parts()) {
    if (search.is_exhausted()) break;
    const std::optional<Tree> plan = plan_tree(*search.best().bytes, search.best().building);
    if (!plan || parts_in(*plan, kind) == 0) continue;
    std::vector<std::string> names;
    for (const Tree& entry : plan->find(kind)->as_list()) {
      const Tree* id = entry.find("id");
      names.push_back(kind + " " +
                      (id != nullptr && !id->is_null() ? id->as_string() : std::to_string(names.size() + 1)));
    }
    const bool fewer = search.minimize_parts(names, [&](const RunCase& best, const Kept& kept) {
      RunCase run = best;
      run.bytes = std::make_shared<const std::string>(plan_text(with_parts(*plan, kind, kept)));
      return run;
    });
    any = fewer || any;
  }
  return any;
}

void make_smaller(ShrinkSearch& search, const FailureSignature& failure, const std::vector<std::string>& keep) {
  const auto may = [&](std::string_view stage) { return std::find(keep.begin(), keep.end(), stage) == keep.end(); };
  if (may("duration")) cut_coarsely(search, failure);
  for (bool any = true; any && !search.is_exhausted();) {
    any = may("ingredients") && simplify(search);
    any = (may("route") && shorten_route(search)) || any;
  }
  if (may("duration")) cut_finely(search);
  // Last, since it takes most runs, and of the shortest walk they are quickest.
  while (may("building") && !search.is_exhausted() && take_building_apart(search)) continue;
}

CaseSize size_of(const RunCase& run, const Tree& results) {
  CaseSize size;
  size.duration_s = number_at(results, "duration_s", 0.0);
  size.distance_m = number_at(results, "distance_m", 0.0);
  size.methods = static_cast<int>(length_at(run.scenario, "methods"));
  const Route route = read_scenario(write_yaml(run.scenario), "scenario.yaml").scenario.route;
  size.rooms = route.shuttle ? route.times : static_cast<int>(route.rooms.size()) * route.loop;
  if (const std::optional<Tree> plan = plan_tree(*run.bytes, run.building)) size.elements = parts_in(*plan);
  return size;
}

/// Which ingredients of the whole run the smallest one has. Of a preset that it has, its effects are named as well.
void name_ingredients(const RunCase& whole, const ShrinkSearch& search, Shrunk& shrunk) {
  const auto add = [&](const std::vector<Ingredient>& ingredients) {
    for (const Ingredient& ingredient : ingredients) {
      const bool left = is_left(ingredient, whole.scenario, shrunk.best.scenario);
      std::vector<std::string>& names = !left                               ? shrunk.not_needed
                                        : search.is_needed(ingredient.name) ? shrunk.needed
                                                                            : shrunk.not_tried;
      names.push_back(ingredient.name);
    }
  };
  add(all_ingredients(whole));
  std::vector<Ingredient> effects = effects_of(whole.scenario);
  std::erase_if(effects, [&](const Ingredient& effect) {
    const std::string preset = effect.key.substr(0, effect.key.find('.')) + ".preset";
    const Tree *was = find_at(whole.scenario, preset), *is = find_at(shrunk.best.scenario, preset);
    return was == nullptr || is == nullptr || was->as_string() != is->as_string();
  });
  add(effects);
}

}  // namespace

Shrunk shrink(const RunCase& whole, const Tree& results, const FailureSignature& failure,
              const ShrinkOptions& options) {
  ShrinkSearch search(whole, results, failure, options);
  Shrunk shrunk;
  try {
    repeat(search, failure, options);
    make_smaller(search, failure, options.keep);
    if (search.is_exhausted()) shrunk.end = ShrinkEnd::max_runs;
  } catch (const Interrupted& interrupted) {
    shrunk.end = ShrinkEnd::interrupted;
    shrunk.signal = interrupted.signal();
  }
  shrunk.failure = failure;
  shrunk.best = search.best();
  shrunk.before = size_of(whole, results);
  shrunk.after = size_of(search.best(), search.results());
  shrunk.steps = search.steps();
  shrunk.runs = search.runs();
  name_ingredients(whole, search, shrunk);
  return shrunk;
}

}  // namespace plumbline::scenarios
