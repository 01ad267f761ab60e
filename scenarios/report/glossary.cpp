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

namespace {

/// Words of pages that are neither verdicts nor metrics, and keys of results.json that no gate can ask for.
constexpr std::array<std::pair<std::string_view, std::string_view>, 7> terms = {
    {{"t = 3.4 s",
      "time on the run's clock, as in all time lines, marks, sentences and the terminal's `found s`; the first scan is "
      "at "
      "about 0.1 s. `localization.converged_at_s` and `localization.identifiable_at_s` count from that scan"},
     {"consistent poses", "poses at which the plan explains all scans so far, the true one among them"},
     {"marginally identifiable",
      "the scans favour the true pose over every other, but not enough to exclude all of them; this is the evidence "
      "`weak`"},
     {"far off",
      "SLAM whose `ate_aligned_rmse_m` is above 0.5 m, half of a door of 1 m: such a pose may lie behind a wall. Where "
      "no gate is on one of its `ate_*` metrics the header names it, and the exit code stays as it is"},
     {"the last metre is off",
      "SLAM is aligned over the whole run, which spreads an error over all of it; the error of the motion over the "
      "last "
      "metre walked says when it slipped"},
     {"localization.state", "state at the end of the run"},
     {"localization.with_furniture.*",
      "`identifiable`, `evidence` and the rest as above, with the furniture as planned in the plan"}}};

}  // namespace

std::string glossary() {
  const auto row = [](std::string_view name, std::string_view unit, std::string_view doc) {
    return "<tr><td><code>" + svg::breakable(name) + "</code></td><td data-head=\"unit\">" + svg::escape(unit) +
           "</td><td class=\"plain\">" + svg::marked_up(doc) + "</td></tr>";
  };
  std::string out =
      "<details class=\"card\"><summary>Glossary: verdicts, states, metrics</summary><div class=\"scroll\"><table "
      "class=\"stacked\" aria-label=\"glossary\">";
  std::string_view key;
  for (const score::ResultWord& word : score::result_words()) {
    if (std::exchange(key, word.key) != word.key)
      out += "<tr><th colspan=\"3\">" + svg::escape(word.key) + "</th></tr>";
    out += row(word.word, "", word.doc);
  }
  out += "<tr><th colspan=\"3\">state of a localization</th></tr>";
  for (std::size_t i = 0; i < state_names.size(); ++i) out += row(state_names[i], "", state_meanings[i]);
  out += "<tr><th colspan=\"3\">other words</th></tr>";
  for (const auto& [name, doc] : terms) out += row(name, "", doc);
  out += "<tr><th>metric</th><th>unit</th><th></th></tr>";
  for (const score::MetricRow& metric : score::metrics()) out += row(metric.name, metric.unit, metric.doc);
  return out +
         "</table></div><p class=\"facts\">[hoover1996]: A. Hoover et al., An Experimental Comparison of Range Image "
         "Segmentation Algorithms, IEEE Transactions on Pattern Analysis and Machine Intelligence 18(7), 1996, "
         "673–689.</p></details>\n";
}

}  // namespace plumbline::scenarios
