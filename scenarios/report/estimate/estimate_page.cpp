// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/estimate_page.h"

#include <algorithm>

#include "scenarios/metrics/state_names.h"
#include "scenarios/report/belief.h"
#include "scenarios/report/error_plots.h"
#include "scenarios/report/estimate/scan_plot.h"
#include "scenarios/report/map_drawing.h"
#include "scenarios/report/page.h"
#include "scenarios/report/page_data.h"
#include "scenarios/report/palette.h"
#include "scenarios/report/results_tables.h"
#include "scenarios/report/svg.h"
#include "slam/io/recordings/tum.h"

namespace plumbline::scenarios {

namespace {

const ReportMethod& method_of(const EstimatePage& page) { return page.input.methods.front(); }

std::string page_title(const EstimatePage& page) {
  return method_of(page).name + (page.facts.recording.empty() ? "" : " on " + page.facts.recording);
}

/// The state at the end with the colour that plots give it. Green and red alone mean right and wrong, which is not
/// known.
std::string state_badge(const std::string& state) {
  if (state.empty()) return "";
  if (state == "crashed" || state == "no pose") return "<span class=\"badge bad\">" + state + "</span>";
  std::string ink = state == followed_state ? "converged" : state;
  std::transform(ink.begin(), ink.end(), ink.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return "<span class=\"badge\"><i class=\"swatch\" style=\"background:var(--" + ink + ")\"></i>" + svg::escape(state) +
         (state == followed_state ? " to the end</span>" : " at the end</span>");
}

std::string estimate_header(const EstimatePage& page) {
  std::string facts = page.scans_s.empty()       ? "no scan"
                      : page.scans_s.size() == 1 ? "1 scan"
                                                 : std::to_string(page.scans_s.size()) + " scans";
  if (page.scans_s.size() > 1) {
    const double length_s = page.scans_s.back();
    facts += " · " + svg::number(length_s, 1) + " s";
    if (length_s > 0.0)
      facts += " · " + svg::number(static_cast<double>(page.scans_s.size() - 1) / length_s, 1) + " scans a second";
  }
  return "<header><h1>" + svg::escape(page_title(page)) + "</h1>" + state_badge(page.state) + "<span class=\"facts\">" +
         facts + "</span></header><p class=\"answer\">" + svg::escape(page.answer) + "</p><p class=\"facts\">" +
         svg::escape(page.by_reference.empty() ? "By what the method says of itself; no reference has been given."
                                               : page.by_reference) +
         "</p>" + failed_gates(page.input);
}

std::string altered_item(const std::string& whose, const std::vector<std::string>& files) {
  std::string names;
  for (const std::string& name : files) names += (names.empty() ? "" : ", ") + name;
  return files.empty()
             ? ""
             : "<li>Files of " + whose + " were altered or added after it was written: " + svg::escape(names) + "</li>";
}

std::string list_warnings(const EstimatePage& page) {
  std::string items = altered_item("the recording", page.facts.unchecked) + altered_item("this estimate", page.altered);
  for (const std::string& said : page.facts.warnings) items += "<li>" + svg::escape(said) + "</li>";
  if (items.empty()) return "";
  return "<section class=\"card\"><h2>What to know of the recording</h2><ul class=\"warnings\">" + items +
         "</ul></section>";
}

/// What the script of the report steers by. byerror: whether paths can be drawn by their error.
std::string map_controls(bool byerror, bool shown) {
  return std::string("<div class=\"controls\"") + (shown ? "" : " style=\"display:none\"") +
         "><button id=\"play\" type=\"button\">Play</button>"
         "<input id=\"time\" type=\"range\" min=\"0\" max=\"1\" step=\"0.1\" aria-label=\"time\">"
         "<span class=\"clock\" id=\"clock\"></span>" +
         (byerror ? "<label><input type=\"checkbox\" id=\"byerror\"> error along the path</label>"
                  : "<input type=\"checkbox\" id=\"byerror\" aria-label=\"error along the path\" hidden>") +
         "</div>";
}

/// Why there is no plan where there should be one.
std::string no_plan_note(const EstimatePage& page) {
  if (!method_of(page).localization || page.input.has_plan) return "";
  return "<p class=\"facts\">The plan is not drawn: this estimate has no plan.json, which earlier versions did not "
         "write.</p>";
}

std::string map_card(const EstimatePage& page, const MapBox& box) {
  const ReportInput& input = page.input;
  const bool has_errors = !input.truth.empty();
  if (!input.has_plan && !page.has_map && method_of(page).samples.empty())
    return "<section class=\"card\"><p>There is no path and no map to draw.</p>" + no_plan_note(page) +
           map_controls(false, false) + "</section>";
  std::string more_key;
  const auto swatch_of = [](const std::string& ink, const std::string& label) {
    return "<span><i class=\"swatch\" style=\"background:" + ink + "\"></i>" + label + "</span>";
  };
  if (page.has_map && input.has_plan)
    more_key =
        swatch_of("color-mix(in srgb," + method_ink(0) + " 35%,transparent)", "upright surface in the method's map");
  if (page.has_map && !input.has_plan)
    more_key = swatch_of("var(--wall)", "upright surface in the method's map") +
               swatch_of("var(--thing)", "any other point of it, as of a floor");
  if (page.has_marks) more_key += "<span>arrow: hypothesis at the end, with its share</span>";
  if (page.thinned > 1) more_key += "<span>one pose in " + std::to_string(page.thinned) + " is drawn</span>";
  return "<section class=\"card\">" + draw_maps(input, box) + map_key(input) +
         (more_key.empty() ? "" : "<div class=\"key\">" + more_key + "</div>") + no_plan_note(page) +
         map_controls(has_errors, true) + "</section>";
}

std::string given_card(const EstimatePage& page) {
  const ReportMethod& method = method_of(page);
  std::string out = "<aside class=\"card\"><h2>" + svg::escape(method.name) +
                    "</h2><p class=\"now\" id=\"now\" data-method=\"" + svg::escape(method.name) +
                    "\"></p><h2>What it was made of</h2><dl class=\"given\">";
  for (const auto& [heading, value] : page.facts.given)
    out += "<dt>" + svg::escape(heading) + "</dt><dd>" + svg::escape(value) + "</dd>";
  if (!page.scans_s.empty())
    out += "<dt>first scan at</dt><dd>" + slam::format_stamp(page.first_scan) + " s; times here count from it</dd>";
  return out + "</dl></aside>";
}

/// Errors by the reference; those along the axes are of a frame that means nothing to a reader.
std::string reference_errors(const EstimatePage& page, double end_s) {
  if (page.input.truth.empty()) return "";
  std::string out = "<section class=\"card\"><h2>Error by the " + svg::escape(page.input.truth_name) +
                    (page.reference.in_plan_frame ? "" : ",") + " over time</h2>",
              small;
  for (const ErrorKind& kind : error_kinds()) {
    if (kind.id == "errors") out += draw_error(page.input, kind, end_s, false);
    const bool of_turns = kind.id == "errors-heading" || kind.id == "errors-relative";
    if (kind.id == "errors-z" || (of_turns && !page.reference.positions_alone))
      small += draw_error(page.input, kind, end_s, true);
  }
  return out +
         "<p class=\"facts\">Where the reference has no poses around a scan there is no error. Dotted: the method "
         "says that it is lost.</p><div class=\"pair\">" +
         small + "</div></section>";
}

std::string how_to_repeat(const EstimateFacts& facts) {
  std::string out;
  if (!facts.command.empty())
    out += "<section class=\"card\"><h2>To make it again</h2><p><code class=\"command\">" + svg::escape(facts.command) +
           "</code> <button type=\"button\" data-copy=\"" + svg::escape(facts.command) +
           "\">Copy</button></p><p class=\"facts\">Files are named without their folders. The same recording, plan and "
           "version of the program give the same bytes under the same names and with the same command; what it cost "
           "stands in timings.json.</p></section>";
  if (!facts.config.empty())
    out += "<details class=\"card\"><summary>All values of the method</summary><pre><code>" +
           svg::escape(facts.config) + "</code></pre></details>";
  return out;
}

}  // namespace

std::string render_estimate(const EstimatePage& page) {
  const ReportInput& input = page.input;
  const MapBox box = bounds(input);
  const double end_s = page.scans_s.empty() ? 0.0 : page.scans_s.back();
  std::string out =
      open_page(page_title(page)) + "<style>" + std::string(estimate_style()) + "</style>" + estimate_header(page);
  out += list_warnings(page) + "<div class=\"top\">" + map_card(page, box) + given_card(page) + "</div>\n";
  out += reference_errors(page, end_s) + draw_beliefs(input, box, end_s) + draw_scans(page) + "\n";
  out += gates_table(input) + (page.has_numbers ? numbers_table(input) : "") + how_to_repeat(page.facts) + "</main>\n";
  out += "<script type=\"application/json\" id=\"data\">" + script_data(input, end_s) + "</script>\n<script>";
  out += map_script();
  out += page_script();
  out += estimate_script();
  out += copy_script();
  return out + "</script></body></html>\n";
}

}  // namespace plumbline::scenarios
