// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/glossary.h"

#include <array>
#include <string_view>
#include <utility>

#include "scenarios/metrics/metrics.h"
#include "scenarios/metrics/result_words.h"
#include "scenarios/metrics/state_names.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

std::string glossary() {
  const auto row = [](std::string_view name, std::string_view unit, std::string_view doc) {
    return "<tr><td><code>" + svg::escape(name) + "</code></td><td data-head=\"unit\">" + svg::escape(unit) +
           "</td><td class=\"plain\">" + svg::escape(doc) + "</td></tr>";
  };
  std::string out =
      "<details class=\"card\"><summary>Glossary: verdicts, states, metrics</summary><div class=\"scroll\"><table "
      "class=\"stacked\">";
  std::string_view key;
  for (const score::ResultWord& word : score::result_words()) {
    if (std::exchange(key, word.key) != word.key)
      out += "<tr><th colspan=\"3\">" + svg::escape(word.key) + "</th></tr>";
    out += row(word.word, "", word.doc);
  }
  out += "<tr><th colspan=\"3\">state of a localization</th></tr>";
  constexpr std::array<std::string_view, 4> meanings = {"no pose stands out yet", "a few poses are left",
                                                        "one pose is left; this is its answer",
                                                        "the answer was withdrawn"};
  for (std::size_t i = 0; i < state_names.size(); ++i) out += row(state_names[i], "", meanings[i]);
  out += "<tr><th>metric</th><th>unit</th><th></th></tr>";
  for (const score::MetricRow& metric : score::metrics()) out += row(metric.name, metric.unit, metric.doc);
  return out + "</table></div></details>\n";
}

}  // namespace plumbline::scenarios
