// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/table_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scenarios/host/terminal.h"
#include "scenarios/report/page.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

constexpr std::size_t most_runs = 1000;  ///< listed one by one
constexpr std::size_t most_dots = 60;    ///< of a cell; with more runs a histogram stands in their place

/// Errors on a scale of decades, m.
constexpr double first_decade = -3.0, last_decade = 2.0;
constexpr double strip_width = 140.0, strip_margin = 5.0;

double strip_x(double error_m) {
  const double decade = std::clamp(std::log10(std::max(error_m, 1e-9)), first_decade, last_decade);
  return strip_margin + (strip_width - 2.0 * strip_margin) * (decade - first_decade) / (last_decade - first_decade);
}

std::string_view class_of(const SweepRow& row) {
  if (row.verdict == "success" || row.verdict == "honest_ambiguity") return "good";
  return row.verdict == "complete" ? "open" : "bad";
}

std::string_view ink_of(const SweepRow& row) {
  const std::string_view kind = class_of(row);
  return kind == "good" ? "var(--right)" : kind == "bad" ? "var(--wrong)" : "var(--soft)";
}

/// How bad a verdict is.
int rank_of(const SweepRow& row) {
  constexpr std::array<std::pair<std::string_view, int>, 10> ranks = {{{"failed", 6},
                                                                       {"crashed", 6},
                                                                       {"false_convergence", 5},
                                                                       {"overconfident", 4},
                                                                       {"lost", 3},
                                                                       {"late", 2},
                                                                       {"lucky", 2},
                                                                       {"complete", 1},
                                                                       {"success", 0},
                                                                       {"honest_ambiguity", 0}}};
  const auto at = std::find_if(ranks.begin(), ranks.end(), [&](const auto& rank) { return rank.first == row.verdict; });
  return at == ranks.end() ? 6 : at->second;
}

std::string length_text(double metres) {
  return metres < 1.0 ? svg::number(100.0 * metres, 1) + " cm" : svg::number(metres, 2) + " m";
}

std::string error_text(const SweepRow& row) {
  const std::optional<double> error = error_of(row);
  return error ? length_text(*error) : "no error";
}

bool is_in(const SweepRow& row, const SweepCell& cell) {
  return row.scenario == cell.scenario && row.variant == cell.variant && row.start == cell.start &&
         row.method == cell.method;
}

std::string dots(const std::vector<const SweepRow*>& rows) {
  std::string out;
  for (const SweepRow* row : rows)
    if (const auto error = error_of(*row))
      out += "<circle cx=\"" + svg::number(strip_x(*error), 1) + "\" cy=\"9\" r=\"3.2\" fill=\"" +
             std::string(ink_of(*row)) + "\" fill-opacity=\".75\"><title>seed " + svg::escape(row->seed) + ": " +
             svg::escape(row->verdict) + ", " + error_text(*row) + "</title></circle>";
  return out;
}

/// Bars of equal width in decades, the highest as high as the strip.
std::string histogram(const std::vector<const SweepRow*>& rows) {
  constexpr std::size_t bins = 26;
  constexpr double height = 16.0, width = (strip_width - 2.0 * strip_margin) / bins;
  std::array<int, bins> counts{};
  for (const SweepRow* row : rows)
    if (const auto error = error_of(*row)) {
      const double bin = (strip_x(*error) - strip_margin) / width;
      ++counts[std::min(bins - 1, static_cast<std::size_t>(std::max(bin, 0.0)))];
    }
  const int most = std::max(1, *std::max_element(counts.begin(), counts.end()));
  std::string out;
  for (std::size_t i = 0; i < bins; ++i) {
    const double high = height * counts[i] / most;
    if (counts[i] > 0)
      out += "<rect x=\"" + svg::number(strip_margin + width * static_cast<double>(i), 1) + "\" y=\"" +
             svg::number(17.0 - high, 1) + "\" width=\"" + svg::number(width - 0.5, 1) + "\" height=\"" +
             svg::number(high, 1) + "\" fill=\"var(--m0)\"><title>" + std::to_string(counts[i]) +
             " runs</title></rect>";
  }
  return out;
}

std::string strip(const std::vector<const SweepRow*>& rows) {
  std::string grid;
  for (const double metres : {0.01, 0.1, 1.0, 10.0})
    grid += "<line x1=\"" + svg::number(strip_x(metres), 1) + "\" y1=\"1\" x2=\"" + svg::number(strip_x(metres), 1) +
            "\" y2=\"17\" stroke=\"var(--line)\"/>";
  return "<svg class=\"spread\" viewBox=\"0 0 140 18\" role=\"img\" aria-label=\"errors of " +
         std::to_string(rows.size()) + " runs\">" + grid + (rows.size() > most_dots ? histogram(rows) : dots(rows)) +
         "</svg>";
}

std::string heads(const std::vector<std::string>& names) {
  std::string out = "<tr class=\"heads\">";
  for (const std::string& name : names) out += "<th>" + svg::escape(name) + "</th>";
  return out + "</tr>\n";
}

/// Columns that say something. Seconds stand in table.csv: metres are what a walk is compared by.
std::vector<std::size_t> shown_columns(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < lines.front().size(); ++i) {
    const bool empty = std::all_of(lines.begin() + 1, lines.end(), [&](const auto& line) { return line[i] == "-"; });
    if (!empty && lines.front()[i] != "identifiable at s") shown.push_back(i);
  }
  return shown;
}

std::string cells_table(const std::vector<SweepRow>& rows, const std::vector<SweepCell>& cells) {
  const std::vector<std::vector<std::string>> lines = table_lines(cells);
  const std::vector<std::size_t> columns = shown_columns(lines);
  const std::string spread = "error of each run";
  std::vector<std::string> names;
  for (const std::size_t i : columns) {
    names.push_back(lines.front()[i]);
    if (names.back() == "method") names.push_back(spread);  // where it is seen without scrolling
  }
  std::string out =
      "<div class=\"scroll\"><table class=\"sorted stacked dense\" aria-label=\"results\">" + heads(names);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    out += "<tr>";
    for (const std::size_t i : columns) {
      const std::string& name = lines.front()[i];
      const std::string& text = lines[c + 1][i];
      const bool wraps = name == "scenario" || name == "variant" || name == "start" || name == "verdicts";
      out += "<td" +
             std::string(text == "-" ? " class=\"none\""
                         : wraps     ? " class=\"wraps\""
                                     : "") +
             " data-head=\"" + svg::escape(name) + "\">" + svg::escape(text) + "</td>";
      if (name != "method") continue;
      std::vector<const SweepRow*> own;
      for (const SweepRow& row : rows)
        if (is_in(row, cells[c])) own.push_back(&row);
      const auto& median = cells[c].median_error_m;
      out += "<td data-head=\"" + spread + "\" data-sort=\"" + (median ? svg::number(*median, 6) : "") + "\">" +
             strip(own) + "</td>";
    }
    out += "</tr>\n";
  }
  return out +
         "</table></div><p class=\"facts\">Errors stand on a scale from 1 mm to 100 m; lines at 1 cm, 10 cm, 1 m "
         "and 10 m. Green: success or honest ambiguity, red: wrong, lost or late, grey: complete.</p>";
}

std::string command_for(const SweepPage& page, const SweepRow& row) {
  return "plumbline sweep " + shell_argument(page.file) +
         (page.seeds > 0 ? " --seeds " + std::to_string(page.seeds) : "") + " --page " + shell_argument(row.key);
}

std::string copy_button(const std::string& command) {
  return "<button type=\"button\" data-copy=\"" + svg::escape(command) + "\">Copy</button>";
}

/// A link to the run's page, or what makes it.
std::string page_of(const SweepPage& page, const SweepRow& row) {
  if (is_refused(row)) return "cannot be made";
  if (page.pages.count(row.key) > 0)
    return "<a href=\"pages/" + svg::escape(row.key) + "/report.html\">report</a> <a href=\"pages/" +
           svg::escape(row.key) + "/replay.html\">replay</a>";
  return "<code>--page " + svg::escape(row.key) + "</code> " + copy_button(command_for(page, row));
}

std::string worst_card(const SweepPage& page, const SweepRow& row) {
  const std::string command = command_for(page, row);
  return "<section class=\"card\"><h2>The worst run</h2><p>" + svg::escape(walks_title(row) + ", seed " + row.seed) +
         ": <b>" + svg::escape(row.method) + "</b> is <span class=\"verdict " + std::string(class_of(row)) + "\">" +
         svg::escape(row.verdict) + "</span>, " + error_text(row) +
         (row.failure.empty() ? "" : " (" + svg::escape(row.failure) + ")") + ".</p><p>" +
         (page.pages.count(row.key) > 0
              ? page_of(page, row)
              : "<code class=\"command\">" + svg::escape(command) + "</code> " + copy_button(command)) +
         "</p><p class=\"facts\">The command makes the run again, the same to the last bit, with its report and its "
         "replay page in pages/" +
         svg::escape(row.key) + ". Call it from the folder of the sweep's file.</p></section>";
}

std::string notes_card(const std::vector<std::string>& notes) {
  if (notes.empty()) return "";
  std::string out = "<section class=\"card\"><h2>Walks that failed or have warnings</h2><ul>";
  for (const std::string& note : notes) out += "<li>" + svg::escape(note) + "</li>\n";
  return out + "</ul></section>\n";
}

std::string runs_table(const SweepPage& page, const std::vector<const SweepRow*>& rows) {
  std::string out =
      "<section class=\"card\"><h2>Runs, the worst first</h2><div class=\"scroll\"><table class=\"sorted "
      "stacked\" aria-label=\"runs\">" +
      heads({"scenario", "seed", "method", "verdict", "error m", "page"});
  for (std::size_t i = 0; i < std::min(rows.size(), most_runs); ++i) {
    const SweepRow& row = *rows[i];
    const auto error = error_of(row);
    out += "<tr><td>" + svg::escape(walks_title(row)) + "</td><td data-head=\"seed\">" + svg::escape(row.seed) +
           "</td><td data-head=\"method\">" + svg::escape(row.method) +
           "</td><td data-head=\"verdict\"><span class=\"verdict " + std::string(class_of(row)) + "\">" +
           svg::escape(row.verdict) + "</span></td><td" + (error ? "" : " class=\"none\"") + " data-head=\"error m\">" +
           (error ? svg::number(*error, 3) : "-") + "</td><td data-head=\"page\">" + page_of(page, row) +
           "</td></tr>\n";
  }
  out += "</table></div>";
  if (rows.size() > most_runs)
    out += "<p class=\"facts\">The worst " + std::to_string(most_runs) + " of " + std::to_string(rows.size()) +
           "; runs.csv has all.</p>";
  return out + "</section>";
}

}  // namespace

std::vector<const SweepRow*> worst_first(const std::vector<SweepRow>& rows) {
  std::vector<const SweepRow*> order;
  for (const SweepRow& row : rows)
    if (row.method != "truth") order.push_back(&row);
  const auto badness = [](const SweepRow* row) { return std::pair(rank_of(*row), error_of(*row).value_or(0.0)); };
  std::stable_sort(order.begin(), order.end(),
                   [&](const SweepRow* a, const SweepRow* b) { return badness(a) > badness(b); });
  return order;
}

std::string table_html(const SweepPage& page, const std::vector<SweepRow>& rows, const std::vector<SweepCell>& cells) {
  const std::vector<const SweepRow*> order = worst_first(rows);
  std::string out = open_page(page.name) + "<header><h1>" + svg::escape(page.name) + "</h1><span class=\"facts\">" +
                    std::to_string(rows.size()) + (rows.size() == 1 ? " result" : " results") +
                    " (runs x methods)</span></header>\n";
  out += "<section class=\"card\">" + cells_table(rows, cells) +
         R"html(<p class="facts">Success of a plan localization is over the identifiable runs, of SLAM
the share of complete; in brackets the 95 % interval of Wilson. Honest: of the runs whose scans fit several poses to the end,
those that reported so. Marginal: right ones of the runs between, where the other poses are nearly ruled out, or were too
late to hold an answer for 5 s and 1 m. Wrong: single answers at a wrong pose, or where several fit. Identifiable at:
when the scans left one pose, median. Converged at: metres until the answer of a success, median over the identifiable
runs, the others counted as never. Error: of the position, rms, median over the runs that success counts over, one without an answer
counted as infinite. Click a heading to sort by it.</p></section>
)html";
  out += notes_card(walk_notes(rows));
  // A run that cannot be made has no page.
  const auto worst = std::find_if(order.begin(), order.end(), [](const SweepRow* row) { return !is_refused(*row); });
  if (worst != order.end()) out += worst_card(page, **worst);
  if (!order.empty()) out += runs_table(page, order);
  return out + "</main><script>" + std::string(sort_script()) + std::string(copy_script()) +
         "</script></body></html>\n";
}

}  // namespace plumbline::scenarios
