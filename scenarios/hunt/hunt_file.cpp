// SPDX-License-Identifier: Apache-2.0
#include "scenarios/hunt/hunt_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string_view>

#include "bim/generators/generators.h"
#include "scenarios/hunt/sampling.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

/// Entry i of a list of the file.
const Tree& hunt_entry(const Tree& tree, std::string_view key, std::size_t i) {
  const Tree* list = tree.find(key);
  return list != nullptr && list->is_list() && i < list->as_list().size() ? list->as_list()[i] : tree;
}

/// A range of whole numbers has one.
void check_whole(const HuntRange& range, const Mark& mark) {
  if (range.whole && std::ceil(*range.min) > std::floor(*range.max))
    throw InputError(mark, "no whole number lies between " + format_number(*range.min) + " and " +
                               format_number(*range.max) + "; give bounds with one between them");
}

void check_range(const HuntRange& range, const Mark& mark) {
  if (range.key.empty()) throw InputError(mark, "a key is needed, as lidar.rpm");
  const bool bounded = range.min.has_value() && range.max.has_value();
  if (range.values.empty() ? !bounded : range.min.has_value() || range.max.has_value())
    throw InputError(mark, "'" + range.key + "' needs either values, or min and max");
  if (!range.values.empty()) {
    if (range.log || range.whole) throw InputError(mark, "log and whole are of a range; values are taken as they are");
    return;
  }
  if (*range.min > *range.max) throw InputError(mark, "min must not be greater than max");
  if (range.log && !(*range.min > 0.0)) throw InputError(mark, "min must be more than 0 with log");
  check_whole(range, mark);
}

void check_ranges(const std::vector<HuntRange>& ranges, const Tree& tree, std::string_view key) {
  std::set<std::string> keys;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const Mark& mark = hunt_entry(tree, key, i).mark;
    check_range(ranges[i], mark);
    if (!keys.insert(ranges[i].key).second) throw InputError(mark, "'" + ranges[i].key + "' is in the list already");
  }
}

/// What a hunt itself gives every run is not drawn.
void check_drawn(const HuntFile& file, const Tree& tree) {
  for (std::size_t i = 0; i < file.vary.size(); ++i) {
    const std::string key = file.vary[i].key.substr(0, file.vary[i].key.find('.'));
    const Mark& mark = hunt_entry(tree, "vary", i).mark;
    if (key == "seed") throw InputError(mark, "a hunt gives every run its seed; leave it out");
    if (key == "building")
      throw InputError(mark, "a hunt's runs are in their scenario's building; name another scenario or a family");
    if ((key == "methods" && !file.methods.empty()) || (key == "gates" && !file.gates.empty()))
      throw InputError(mark, "the hunt sets '" + key + "' itself; set it in one place");
  }
}

/// One value of an option, whatever the others are.
void check_option(const std::string& family, const std::string& key, const std::string& value, const Mark& mark) {
  constexpr const char* no_option = "no option";
  Tree text(value);
  text.mark = mark;
  Tree options = Tree::map();
  options.mark = mark;
  options.set(key, std::move(text)).set(no_option, "");
  try {
    // Values are read first, unknown keys are refused next, and combinations would come last.
    (void)bim::generate(family, options);
  } catch (const InputError& error) {
    if (std::string_view(error.what()).find(no_option) == std::string_view::npos) throw;
  }
}

/// At both ends of a range, or each that is named.
void check_option_values(const HuntFamily& family, const HuntRange& range, const Mark& mark) {
  if (range.values.empty()) {
    constexpr double nearly_one = 1.0 - 1e-12;
    for (const double u : {0.0, nearly_one}) check_option(family.family, range.key, value_at(range, u), mark);
  }
  for (const std::string& value : range.values) check_option(family.family, range.key, value, mark);
}

/// Options that are whole numbers are drawn so.
void check_family(HuntFamily& family, const Tree& tree) {
  const Tree* name = tree.find("family");
  std::vector<std::string> names;
  for (const bim::GeneratorRow& row : bim::generators()) names.emplace_back(row.name);
  if (std::find(names.begin(), names.end(), family.family) == names.end()) {
    const std::string close = did_you_mean(family.family, names);
    throw InputError(name->mark,
                     "'" + family.family + "' is no family; " +
                         (close.empty() ? "plumbline generate --help lists them" : "did you mean '" + close + "'?"));
  }
  const std::vector<bim::OptionRow> rows = bim::generator_options(family.family);
  std::vector<std::string> known;
  for (const bim::OptionRow& row : rows) known.push_back(row.key);
  for (std::size_t i = 0; i < family.options.size(); ++i) {
    HuntRange& range = family.options[i];
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& one) { return one.key == range.key; });
    if (row == rows.end()) {
      const std::string close = did_you_mean(range.key, known);
      throw InputError(hunt_entry(tree, "options", i).mark,
                       "'" + range.key + "' is no option of '" + family.family + "'" +
                           (close.empty() ? "; plumbline generate " + family.family + " --help lists them"
                                          : "; did you mean '" + close + "'?"));
    }
    range.whole = range.whole || (row->type == "integer" && range.values.empty());
    const Mark& mark = hunt_entry(tree, "options", i).mark;
    check_whole(range, mark);
    check_option_values(family, range, mark);
  }
}

}  // namespace

Hunt read_hunt(const std::string& path) {
  const Tree tree = read_yaml(read_text_file(path), path);
  if (!tree.is_map() || tree.as_map().empty() || tree.as_map().front().first != "hunt")
    throw InputError({path, 1, 1}, "the first key of a hunt must be 'hunt: 1'");
  Hunt hunt{from_tree<HuntFile>(tree), {}, {}};
  HuntFile& file = hunt.file;
  check_name(file.name, tree.find("name") != nullptr ? tree.find("name")->mark : tree.mark);
  check_ranges(file.vary, tree, "vary");
  check_drawn(file, tree);
  for (std::size_t i = 0; i < file.gates.size(); ++i) {
    check_gate(file.gates[i], hunt_entry(tree, "gates", i));
    hunt.gate_marks.push_back(hunt_entry(tree, "gates", i).mark);
  }
  for (std::size_t i = 0; i < file.scenarios.size(); ++i)
    hunt.bases.push_back({fs::path(file.scenarios[i]).stem().string(),
                          (fs::path(path).parent_path() / file.scenarios[i]).string(), std::nullopt,
                          hunt_entry(tree, "scenarios", i).mark});
  for (std::size_t i = 0; i < file.generate.size(); ++i) {
    const Tree& entry = hunt_entry(tree, "generate", i);
    check_ranges(file.generate[i].options, entry, "options");
    check_family(file.generate[i], entry);
    hunt.bases.push_back({file.generate[i].family, "", file.generate[i], entry.mark});
  }
  if (hunt.bases.empty())
    throw InputError(tree.mark, "names nothing to hunt in; name scenarios, or families to generate");
  return hunt;
}

}  // namespace plumbline::scenarios
