// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/belief.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "scenarios/report/results.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

struct StateLook {
  std::string_view name, colour, meaning;
};
/// By slam::State.
constexpr std::array<StateLook, 4> looks = {{{"SEARCHING", "#8492a6", "not sure of any place yet"},
                                             {"AMBIGUOUS", "#b58900", "a few places are left"},
                                             {"CONVERGED", "#0a7d4f", "it gives one answer"},
                                             {"LOST", "#c02f1d", "it took its answer back"}}};

constexpr std::string_view right_colour = "#0a7d4f", wrong_colour = "#d4452f";
// Of places that are not the true one, apart from the colours of states and of right and wrong.
constexpr std::array<std::string_view, 5> other_colours = {"#d55e00", "#0072b2", "#cc79a7", "#7a4a9e", "#56b4e9"};

std::vector<PlotBand> state_bands(const std::vector<ReportState>& states, double end_s) {
  std::vector<PlotBand> bands;
  for (const ReportState& state : states) {
    const StateLook& look = looks[static_cast<std::size_t>(state.state)];
    if (!bands.empty() && bands.back().label == look.name) continue;
    if (!bands.empty()) bands.back().to_s = state.t_s;
    bands.push_back({state.t_s, end_s, std::string(look.name), std::string(look.colour)});
  }
  return bands;
}

std::string swatch(std::string_view colour, const std::string& label) {
  return "<span><i class=\"swatch\" style=\"background:" + std::string(colour) + "\"></i>" + label + "</span>";
}

std::string state_key() {
  std::string out = "<div class=\"key\">";
  for (const StateLook& look : looks)
    out += swatch(look.colour, std::string(look.name) + ": " + std::string(look.meaning));
  return out + "</div>";
}

std::vector<PlotCurve> curves_of(const ReportMethod& method) {
  constexpr std::size_t longest = 12;  // of a room's name beside the plot
  std::vector<PlotCurve> curves;
  std::size_t others = 0;
  for (const ReportTrack& track : method.tracks) {
    PlotCurve curve;
    curve.layer = method.name;
    curve.name = track.is_true ? "true place" : "other";
    curve.colour = track.is_true ? right_colour : other_colours[others++ % other_colours.size()];
    if (!track.is_true && !track.room.empty() && track.room.size() <= longest) curve.name += ": " + track.room;
    const double apart = static_cast<double>(curves.size());  // % each, or equal shares would hide each other
    for (const Eigen::Vector2d& p : track.points)
      curve.points.emplace_back(p.x(), std::max(0.0, 100.0 * p.y() - apart));
    curves.push_back(std::move(curve));
  }
  return curves;
}

std::string chart(const ReportInput& input, const ReportMethod& method, double end_s) {
  if (method.tracks.empty() && method.states.empty()) return "";
  PlotExtras extras;
  extras.marks = common_marks(input);
  extras.bands = state_bands(method.states, end_s);
  extras.max = 104.0;  // %, so that a curve along 100 stays whole
  const Tree* results = results_of(input, method.name);
  if (const auto at = number_of(results == nullptr ? nullptr : results->find("localization"), "converged_at_s"))
    extras.marks.push_back({*at, "settled on one place"});
  std::stable_sort(extras.marks.begin(), extras.marks.end(),
                   [](const PlotMark& a, const PlotMark& b) { return a.t_s < b.t_s; });
  const std::string name = svg::escape(method.name);
  return "<section class=\"card\"><h2>What " + name + " believed, over time: share of each place, %</h2>" +
         draw_plot("belief-" + name, curves_of(method), end_s, extras) + state_key() +
         "<p class=\"facts\">Each line is one place in the building, carried along as the robot walks. Green is where "
         "it "
         "truly was, others bear the name of the room they came up in. A place's share is its part of the evidence, "
         "100 % being certain; places below 2 % are left out, and equal lines drawn 1 % apart. "
         "The bar says what the method itself claims.</p></section>";
}

std::string draw_place(const ReportPlace& place) {
  std::string out;
  for (const ReportMatch& match : place.walls) {
    const std::string stroke = "stroke=\"" + std::string(match.right ? right_colour : wrong_colour) + "\"";
    for (const ReportWall& face : match.faces) out += svg::line(face.p0, face.p1, "class=\"plannedwall\" " + stroke);
    out += svg::line(match.patch.p0, match.patch.p1, "class=\"seenwall\" " + stroke);
  }
  const double deg = place.yaw * 180.0 / std::numbers::pi;
  return out + "<path class=\"heldplace\" d=\"M.5 0L-.3 -.28L-.16 0L-.3 .28Z\" transform=\"translate(" +
         svg::number(place.at.x()) + " " + svg::number(-place.at.y()) + ") rotate(" + svg::number(-deg, 1) +
         ")\"><title>share " + svg::number(100.0 * place.mass, 0) + " %</title></path>";
}

std::string ring(const Eigen::Vector2d& at) {
  return svg::circle(at, 0.6, "fill=\"none\" stroke=\"#111\" stroke-width=\".08\"");
}

std::string counted(std::size_t n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

/// "at the end, 30 s: place 2 of 3, 33 %: 4 of 7 walls right"
std::string caption(const ReportWalls& walls, std::size_t index) {
  const ReportPlace& place = walls.places[index];
  const auto right =
      std::count_if(place.walls.begin(), place.walls.end(), [](const ReportMatch& match) { return match.right; });
  std::string text = walls.label + ", " + svg::number(walls.t_s, 1) + " s: ";
  if (walls.places.size() > 1)
    text += "place " + std::to_string(index + 1) + " of " + std::to_string(walls.places.size()) + ", " +
            svg::number(100.0 * place.mass, 0) + " %: ";
  return text + std::to_string(right) + " of " + counted(place.walls.size(), "wall") + " right";
}

std::string recognised(const ReportInput& input, const ReportMethod& method, const MapBox& box) {
  constexpr std::size_t most = 3;  // places at one time, a map each
  if (method.recognised.empty()) return "";
  std::string out =
      "<section class=\"card\"><h2>Walls that " + svg::escape(method.name) + " recognised</h2><div class=\"beliefs\">";
  for (const ReportWalls& walls : method.recognised)
    for (std::size_t i = 0; i < std::min(most, walls.places.size()); ++i)
      out += "<div><p>" + svg::escape(caption(walls, i)) + "</p>" + open_map(box, "walls recognised " + walls.label) +
             draw_plan(input, walls.storey) + draw_place(walls.places[i]) + ring(walls.truth) + "</svg></div>";
  return out + "</div><div class=\"key\">" +
         swatch(right_colour, "a wall it saw (dark) and the wall of the plan it took it for (light), rightly") +
         swatch(wrong_colour, "wrongly: what it saw was another wall, or none") +
         "<span>arrow: where it thought to be, ring: where it truly was</span></div></section>";
}

std::string particles(const ReportInput& input, std::size_t index, const MapBox& box) {
  const ReportMethod& method = input.methods[index];
  if (method.beliefs.empty()) return "";
  std::string out = "<section class=\"card\"><h2>Where " + svg::escape(method.name) +
                    " thought the robot could be</h2><div class=\"beliefs\">";
  for (const auto& belief : method.beliefs) {
    out += "<div><p>" + svg::escape(belief.label) + ", " + svg::number(belief.t_s, 1) + " s</p>" +
           open_map(box, "particles at " + belief.label) + draw_plan(input, belief.storey);
    for (const auto& particle : belief.particles)
      out += svg::circle({particle.x, particle.y}, 0.09, "fill=\"" + colour(index) + "\" fill-opacity=\".55\"");
    out += ring(belief.truth) + "</svg></div>";
  }
  return out +
         "</div><p class=\"facts\">Each dot is a place still thought possible; the ring is where the robot truly "
         "was.</p></section>";
}

/// First time from which on every other place left is nearly out, where that is so at the end.
std::optional<double> nearly_told(const ReportInput& input) {
  const Tree* known = input.results.find("identifiability");
  const Tree* places = known == nullptr ? nullptr : known->find("places");
  std::optional<double> since;
  if (places == nullptr) return since;
  for (const Tree& left : places->as_list()) {
    const bool weak = number_of(&left, "twins") == number_of(&left, "weak");
    if (!weak) since.reset();
    if (weak && !since) since = number_of(&left, "t_s");
  }
  return since;
}

}  // namespace

std::vector<PlotMark> common_marks(const ReportInput& input) {
  std::vector<PlotMark> marks;
  const auto tellable = number_of(input.results.find("identifiability"), "at_s");
  const auto nearly = nearly_told(input);
  // From the first look on is no event.
  if (tellable && *tellable > 0.0)
    marks.push_back({*tellable, "from here on what was seen fits one place only"});
  else if (!tellable && nearly && *nearly > 0.0)
    marks.push_back({*nearly, "from here on what was seen nearly rules the other places out"});
  if (input.kidnap) {
    marks.push_back({input.kidnap->lifted_s, "carried off"});
    marks.push_back({input.kidnap->set_down_s, "set down elsewhere"});
  }
  std::stable_sort(marks.begin(), marks.end(), [](const PlotMark& a, const PlotMark& b) { return a.t_s < b.t_s; });
  return marks;
}

std::string draw_beliefs(const ReportInput& input, const MapBox& box, double end_s) {
  std::string out;
  for (std::size_t i = 0; i < input.methods.size(); ++i) {
    const ReportMethod& method = input.methods[i];
    if (is_truth(method)) continue;
    out += chart(input, method, end_s) + recognised(input, method, box) + particles(input, i, box);
  }
  return out;
}

}  // namespace plumbline::scenarios
