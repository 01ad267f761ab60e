// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/methods_page.h"

#include <algorithm>
#include <optional>

#include "bim/config/markdown.h"
#include "scenarios/spec/method_names.h"
#include "slam/methods.h"

namespace plumbline::docs {

namespace {

bool is_same(const SchemaField& a, const SchemaField& b) {
  return a.key == b.key && a.type == b.type && a.unit == b.unit && a.range == b.range && a.standard == b.standard &&
         a.meaning == b.meaning && a.required == b.required;
}

KeysShown compared(const MethodKeys& method, const MethodKeys& base) {
  KeysShown shown;
  shown.like = base.name;
  for (const SchemaField& field : method.fields)
    if (std::none_of(base.fields.begin(), base.fields.end(), [&](const SchemaField& f) { return is_same(f, field); }))
      shown.fields.push_back(field);
  for (const SchemaField& field : base.fields)
    if (std::none_of(method.fields.begin(), method.fields.end(),
                     [&](const SchemaField& f) { return f.key == field.key; }))
      shown.without.push_back(field.key);
  return shown;
}

std::string link_to(const std::string& method) { return "[`" + method + "`](#" + method + ")"; }

std::string overview_of_methods() {
  MarkdownTable table({"method", "what it is", "plan", "odometry", "default"});
  for (const slam::MethodRow& row : slam::methods())
    table.add({row.config_schema ? link_to(std::string(row.name)) : markdown_code(row.name), std::string(row.summary),
               row.needs_plan ? "needed" : "",
               row.needs_odometry  ? "needed"
               : row.uses_odometry ? "optional"
                                   : "not used",
               row.standard ? "yes" : ""});
  table.add({markdown_code(scenarios::truth_method), "the true poses; its errors are 0, which checks the scores", "",
             "", ""});
  return table.text();
}

std::string list_of(const std::vector<std::string>& keys) {
  std::string text;
  for (const std::string& key : keys) text += (text.empty() ? "" : ", ") + markdown_code(key);
  return text;
}

std::string keys_of(const MethodKeys& method, const KeysShown& shown) {
  if (shown.like.empty()) {
    const std::vector<SchemaField> basic = basic_fields(method.fields);
    const std::string text = basic.size() < method.fields.size() ? schema_table(basic) + "\n" : "";
    return text + "<details><summary>All " + std::to_string(method.fields.size()) + " keys</summary>\n\n" +
           schema_table(method.fields) + "\n</details>\n";
  }
  std::string text = "Its keys are those of " + link_to(shown.like);
  text += shown.fields.empty() ? ".\n" : ", but for these:\n\n" + schema_table(shown.fields);
  if (!shown.without.empty()) text += "\nIt does not have " + list_of(shown.without) + ".\n";
  return text;
}

}  // namespace

std::vector<KeysShown> keys_shown(const std::vector<MethodKeys>& methods) {
  std::vector<std::size_t> order(methods.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_partition(order.begin(), order.end(), [&](std::size_t i) { return methods[i].standard; });
  std::vector<KeysShown> shown(methods.size());
  std::vector<std::size_t> full;
  for (const std::size_t i : order) {
    std::optional<KeysShown> best;
    const auto size = [](const KeysShown& keys) { return keys.fields.size() + keys.without.size(); };
    for (const std::size_t f : full) {
      KeysShown keys = compared(methods[i], methods[f]);
      if (4 * size(keys) <= methods[i].fields.size() && (!best || size(keys) < size(*best))) best = std::move(keys);
    }
    if (!best) full.push_back(i);
    shown[i] = best ? std::move(*best) : KeysShown{"", methods[i].fields, {}};
  }
  return shown;
}

std::string methods_page() {
  std::string page = R"md(# Methods

A scenario, `run --method` and `estimate --method` name methods. Those marked as default run where none is named.
Localization needs the plan of the building. Where odometry is optional and absent, the motion prior is
constant velocity. `not used`: the method reads LiDAR alone.

)md";
  page += overview_of_methods() + R"md(
`plumbline methods --config METHOD` prints the basic keys of a method at their defaults, and `--all` every key. Saved as
a file and changed, `--config FILE` of `estimate` takes it. A section below lists the basic keys first, or names the method that has
the same keys, and those that differ.
)md";
  std::vector<MethodKeys> methods;
  std::vector<std::string> summaries;
  for (const slam::MethodRow& row : slam::methods()) {
    if (!row.config_schema) continue;
    methods.push_back({std::string(row.name), row.standard, row.config_schema().front().fields});
    summaries.emplace_back(row.summary);
  }
  const std::vector<KeysShown> shown = keys_shown(methods);
  for (std::size_t i = 0; i < methods.size(); ++i)
    page += "\n## " + methods[i].name + "\n\n" + summaries[i] + ".\n\n" + keys_of(methods[i], shown[i]);
  return page;
}

}  // namespace plumbline::docs
