// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/map_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scenarios/report/palette.h"
#include "scenarios/report/plot.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

namespace {

/// Errors up to these, m, have a colour each along a path; what is beyond has the last one.
constexpr std::array<double, 4> error_up_to_m = {0.02, 0.05, 0.10, 0.50};

/// Wall segments of a face without its openings, as strokes.
std::string face_strokes(const bim::PlanFace& face, double floor_z) {
  constexpr double walked_under_m = 1.8;
  const bool high = face.z0 > floor_z + walked_under_m;
  const double length = (face.p1 - face.p0).norm();
  if (length <= 0.0) return "";
  const Eigen::Vector2d e = (face.p1 - face.p0) / length;
  std::vector<std::pair<double, double>> gaps;
  for (const auto& hole : face.holes)
    if (hole.z0 < face.z0 + 0.3) gaps.emplace_back(hole.s0, hole.s1);
  std::sort(gaps.begin(), gaps.end());
  std::string out;
  double s = 0.0;
  const auto stroke = [&](double s0, double s1) {
    if (s1 > s0) out += svg::line(face.p0 + s0 * e, face.p0 + s1 * e, high ? "class=\"wall high\"" : "class=\"wall\"");
  };
  for (const auto& [s0, s1] : gaps) {
    stroke(s, s0);
    s = std::max(s, s1);
  }
  stroke(s, length);
  return out;
}

/// Its risers and an arrow that goes up.
std::string draw_flight(const ReportFlight& flight) {
  std::string out;
  for (const auto& [a, b] : flight.risers_W) out += svg::line(a, b, "class=\"riser\"");
  if (flight.risers_W.size() < 2) return out;
  const auto middle = [](const auto& riser) -> Eigen::Vector2d { return 0.5 * (riser.first + riser.second); };
  const Eigen::Vector2d foot = middle(flight.risers_W.front()), head = middle(flight.risers_W.back());
  constexpr double arrow_m = 0.2;
  const Eigen::Vector2d back = arrow_m * (foot - head).normalized(), aside(-back.y(), back.x());
  return out + svg::polyline({foot, head}, "class=\"riser\" fill=\"none\"") +
         svg::polyline({head + back + 0.5 * aside, head, head + back - 0.5 * aside}, "class=\"riser\" fill=\"none\"");
}

bool is_shown(const ReportInput& input, int storey) {
  return std::any_of(input.storeys.begin(), input.storeys.end(),
                     [&](const ReportStorey& shown) { return shown.index == storey; });
}

bool is_jump(const ReportSample& from, const ReportSample& to, const PathBreaks& breaks) {
  return to.t_s - from.t_s > breaks.gap_s || std::hypot(to.x - from.x, to.y - from.y) > breaks.jump_m;
}

/// A line for each stretch of the path on the storey, broken where it jumps: of what is an answer, or of what was given
/// while lost.
std::string draw_path(const std::vector<ReportSample>& samples, int storey, const std::string& attributes,
                      const PathBreaks& breaks = {}, bool lost = false) {
  std::string out;
  std::vector<Eigen::Vector2d> stretch;
  const auto draw = [&] {
    if (!stretch.empty()) out += svg::polyline(stretch, attributes);
    stretch.clear();
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool shown = samples[i].storey == storey && samples[i].lost == lost;
    const bool jumps = i > 0 && is_jump(samples[i - 1], samples[i], breaks);
    if (lost && shown && !jumps && stretch.empty() && i > 0)
      stretch.emplace_back(samples[i - 1].x, samples[i - 1].y);  // the two kinds meet
    if (!shown || jumps) draw();
    if (shown) stretch.emplace_back(samples[i].x, samples[i].y);
  }
  draw();
  return out;
}

std::size_t error_band(double error_m) {
  const auto at = std::lower_bound(error_up_to_m.begin(), error_up_to_m.end(), error_m);
  return static_cast<std::size_t>(at - error_up_to_m.begin());
}

/// The same path in stretches by the size of its error; the page shows one of the two.
std::string draw_path_by_error(const std::vector<ReportSample>& samples, int storey, const PathBreaks& breaks) {
  std::string out;
  std::vector<Eigen::Vector2d> stretch;
  std::size_t band = 0;
  const auto draw = [&] {
    const std::string ink = "var(--e" + std::to_string(band) + ")";
    if (stretch.size() > 1) out += svg::polyline(stretch, "class=\"errorpath\" stroke=\"" + ink + "\"");
    stretch.clear();
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool shown = samples[i].storey == storey && !samples[i].lost && samples[i].judged;
    if (!shown || (i > 0 && is_jump(samples[i - 1], samples[i], breaks))) draw();
    if (!shown) continue;
    const Eigen::Vector2d at(samples[i].x, samples[i].y);
    const std::size_t now = error_band(samples[i].error_m);
    if (!stretch.empty() && now != band) {
      stretch.push_back(at);  // stretches meet
      draw();
    }
    band = now;
    stretch.push_back(at);
  }
  draw();
  return out;
}

std::string error_key() {
  std::string out = "<div class=\"key byerrorkey\">";
  for (std::size_t i = 0; i <= error_up_to_m.size(); ++i) {
    const bool last = i == error_up_to_m.size();
    out += "<span><i class=\"swatch\" style=\"background:var(--e" + std::to_string(i) + ")\"></i>" +
           (last ? "further off" : "up to " + svg::number(100.0 * error_up_to_m[i], 0) + " cm off") + "</span>";
  }
  return out + "</div>";
}

/// Where the robot was lifted and set down.
std::string draw_kidnap(const ReportInput& input, int storey) {
  if (!input.kidnap) return "";
  std::string out;
  const std::array<std::pair<double, const char*>, 2> events = {
      {{input.kidnap->lifted_s, "kidnapped"}, {input.kidnap->set_down_s, "set down"}}};
  for (const auto& [t_s, text] : events) {
    const auto at = std::find_if(input.truth.begin(), input.truth.end(),
                                 [t = t_s](const ReportSample& sample) { return sample.t_s >= t; });
    if (at == input.truth.end() || at->storey != storey) continue;
    out += svg::circle({at->x, at->y}, 0.16, "fill=\"var(--room)\" stroke=\"var(--truth)\" stroke-width=\".07\"") +
           svg::text({at->x + 0.28, at->y + 0.1}, text, "class=\"event\"");
  }
  return out;
}

/// An arrow ahead; on maps of more than a building larger than the robot.
std::string arrow_of(double scale) {
  if (scale == 1.0) return "M.36 0L-.22 -.2L-.12 0L-.22 .2Z";
  const auto at = [&](double x, double y) { return svg::number(scale * x) + " " + svg::number(scale * y); };
  return "M" + at(0.36, 0.0) + "L" + at(-0.22, -0.2) + "L" + at(-0.12, 0.0) + "L" + at(-0.22, 0.2) + "Z";
}

std::string robot_mark(const std::string& name, int storey, const std::string& fill, double scale) {
  return "<path class=\"robot\" data-robot=\"" + svg::escape(name) + "\" data-storey=\"" + std::to_string(storey) +
         "\" d=\"" + arrow_of(scale) + "\" fill=\"" + fill + "\" stroke=\"var(--room)\" stroke-width=\".04\"/>";
}

/// Rooms of the method are right or wrong only where rooms of the building are known.
std::string draw_structure(const ReportMethod& method, int storey, bool rooms_known, const std::string& c) {
  std::string out;
  for (const auto& room : method.rooms)
    if (room.storey == storey)
      out += svg::polygon(room.polygon_W, room.matched || !rooms_known
                                              ? "class=\"foundroom\" fill=\"" + c + "\" stroke=\"" + c + "\""
                                              : std::string("class=\"foundroom invented\""));
  for (const auto& wall : method.walls)
    if (wall.storey == storey) out += svg::line(wall.p0, wall.p1, "class=\"found\" stroke=\"" + c + "\"");
  return out;
}

std::string draw_method(const ReportMethod& method, int storey, bool rooms_known, double mark_scale) {
  const std::string c = method_ink(method.ink);
  std::string out = "<g class=\"layer-" + svg::escape(method.name) + "\">";
  // What a localization finds are the plan's own walls and rooms, which are drawn already.
  if (!method.localization) out += draw_structure(method, storey, rooms_known, c);
  out += draw_path(method.corrected, storey, "class=\"path corrected\" stroke=\"" + c + "\"", method.corrected_breaks);
  out += draw_path(method.samples, storey, "class=\"path\" stroke=\"" + c + "\"", method.breaks);
  if (method.lost_drawn)
    out += draw_path(method.samples, storey, "class=\"path lost\" stroke=\"" + c + "\"", method.breaks, true);
  out += draw_path_by_error(method.samples, storey, method.breaks);
  return out + robot_mark(method.name, storey, c, mark_scale) + "</g>";
}

std::string draw_map(const ReportInput& input, const ReportStorey& storey, const MapBox& box) {
  const bool several = input.storeys.size() > 1;
  std::string out = several ? "<p class=\"storey\">" + svg::escape(storey.name) + "</p>" : "";
  out +=
      open_map(box, (input.has_plan ? "floor plan" : "map") + (several ? " of " + storey.name : std::string()) +
                        (input.truth.empty() ? " with the estimated path" : " with the true and the estimated paths")) +
      draw_plan(input, storey.index) + storey.below_paths + draw_deviations(storey.deviations);
  const bool rooms_known = std::any_of(input.plan.rooms.begin(), input.plan.rooms.end(),
                                       [&](const bim::PlanRoom& room) { return room.storey == storey.index; });
  for (const ReportMethod& method : input.methods)
    if (!is_truth(method)) out += draw_method(method, storey.index, rooms_known, input.mark_scale);
  out += draw_path(input.truth, storey.index, "class=\"truth\"", input.truth_breaks) + room_names(input, storey.index) +
         draw_kidnap(input, storey.index) +
         (input.truth.empty() ? "" : robot_mark("truth", storey.index, "var(--truth)", input.mark_scale)) +
         draw_scale(box);
  return out + "</svg>";
}

/// From where to where on x.
struct Span {
  double from = 0.0, to = 0.0;
  [[nodiscard]] double length() const { return to - from; }
};

/// What a level line has of a polygon, from left to right.
std::vector<Span> spans_at(const Polygon2& polygon, double y) {
  std::vector<double> crossings;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if ((a.y() > y) != (b.y() > y)) crossings.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
  }
  std::sort(crossings.begin(), crossings.end());
  std::vector<Span> spans;
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) spans.push_back({crossings[i], crossings[i + 1]});
  return spans;
}

/// The widest place for a line of text over y.
Span widest_row(const Polygon2& polygon, double y) {
  constexpr double height_m = 0.4;
  Span widest;
  for (const Span& low : spans_at(polygon, y))
    for (const Span& high : spans_at(polygon, y + height_m))
      if (const Span both{std::max(low.from, high.from), std::min(low.to, high.to)}; both.length() > widest.length())
        widest = both;
  return widest;
}

/// Whether a path is drawn where its method was lost.
bool draws_lost(const ReportMethod& method) {
  return method.lost_drawn && std::any_of(method.samples.begin(), method.samples.end(),
                                          [](const ReportSample& sample) { return sample.lost; });
}

/// What methods found, where no plan says how far the map goes.
void add_estimates(const ReportInput& input, MapBox& box) {
  for (const ReportMethod& method : input.methods) {
    for (const ReportSample& sample : method.samples) box.add({sample.x, sample.y});
    for (const ReportWall& wall : method.walls) {
      box.add(wall.p0);
      box.add(wall.p1);
    }
  }
}

}  // namespace

RoomNamePlace room_name_place(const Polygon2& polygon) {
  constexpr double below_m = 0.45, step_m = 0.25, wide_enough = 0.8, margin_m = 0.2;
  constexpr int most_rows = 200;
  double low = 1e9, high = -1e9;
  for (const Eigen::Vector2d& p : polygon) {
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  const double step = std::max(step_m, (high - low) / most_rows);
  std::vector<std::pair<double, Span>> rows;
  double widest = 0.0;
  for (double y = high - below_m; y > low || rows.empty(); y -= step) {
    rows.emplace_back(y, widest_row(polygon, y));
    widest = std::max(widest, rows.back().second.length());
  }
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.second.length() >= wide_enough * widest; });
  return {{row->second.from + margin_m, row->first}, row->second.length() - 1.5 * margin_m};
}

std::string room_names(const ReportInput& input, int storey) {
  std::string out;
  for (const auto& room : input.plan.rooms) {
    if (room.storey != storey || room.polygon.empty()) continue;
    // The script leaves out what does not fit into its room, or lies over another name.
    const RoomNamePlace place = room_name_place(room.polygon);
    out += svg::text(place.from, room.name, "class=\"name\" data-room=\"" + svg::number(place.width_m) + "\"");
  }
  return out;
}

/// A length to measure by, in the margin below the plan.
std::string draw_scale(const MapBox& box) {
  constexpr std::array<int, 7> lengths_m = {1, 2, 5, 10, 20, 50, 100};
  int length_m = lengths_m.front();
  for (const int m : lengths_m)
    if (m <= 0.25 * (box.max.x() - box.min.x())) length_m = m;
  const Eigen::Vector2d a = box.min + Eigen::Vector2d(0.5, 0.2), b = a + Eigen::Vector2d(length_m, 0.0);
  return svg::line(a, b, "class=\"scale\"") +
         svg::text(b + Eigen::Vector2d(0.15, -0.1), std::to_string(length_m) + " m", "");
}

bool is_truth(const ReportMethod& method) { return method.name == "truth"; }

MapBox bounds(const ReportInput& input) {
  MapBox box;
  for (const auto& face : input.plan.faces) {
    if (!is_shown(input, face.storey)) continue;
    box.add(face.p0);
    box.add(face.p1);
  }
  for (const bim::PlanRoom& room : input.plan.rooms)  // a file may have rooms and no walls
    if (is_shown(input, room.storey))
      for (const auto& p : room.polygon) box.add(p);
  for (const ReportObstacle& obstacle : input.obstacles)  // of a mesh there are no faces
    if (input.plan.faces.empty() && is_shown(input, obstacle.storey))
      for (const auto& p : obstacle.outline_W) box.add(p);
  for (const auto& sample : input.truth) box.add({sample.x, sample.y});
  if (!input.has_plan) add_estimates(input, box);
  for (const Eigen::Vector2d& p : input.extent) box.add(p);
  if (box.max.x() < box.min.x()) box.add(Eigen::Vector2d::Zero());
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(0.5);
  return {box.min - margin, box.max + margin};
}

std::string open_map(const MapBox& box, const std::string& label) {
  const Eigen::Vector2d size = box.max - box.min;
  return "<svg class=\"map\" role=\"img\" aria-label=\"" + svg::escape(label) + "\" viewBox=\"" +
         svg::number(box.min.x()) + " " + svg::number(-box.max.y()) + " " + svg::number(size.x()) + " " +
         svg::number(size.y()) + "\">";
}

std::string draw_plan(const ReportInput& input, int storey) {
  const double floor_z = input.plan.storeys.at(static_cast<std::size_t>(storey)).elevation_m;
  std::string out;
  for (const auto& room : input.plan.rooms)
    if (room.storey == storey) out += svg::polygon(room.polygon, "class=\"room\"");
  for (const ReportFlight& flight : input.flights)
    if (flight.from == storey || flight.to == storey) out += draw_flight(flight);
  for (const auto& face : input.plan.faces)
    if (face.storey == storey) out += face_strokes(face, floor_z);
  for (const ReportObstacle& obstacle : input.obstacles)
    if (obstacle.storey == storey)
      out +=
          svg::polygon(obstacle.outline_W, obstacle.filled ? "class=\"thing\"" : "class=\"thing hull\"", obstacle.id);
  return out;
}

std::string draw_maps(const ReportInput& input, const MapBox& box) {
  std::string maps, switches;
  for (const ReportStorey& storey : input.storeys) {
    const std::string index = std::to_string(storey.index);
    maps += "<div class=\"floor\" data-floor=\"" + index + "\">" + draw_map(input, storey, box) + "</div>";
    switches += "<button type=\"button\" data-switch=\"" + index + "\">" + svg::escape(storey.name) + "</button>";
  }
  if (input.storeys.size() < 2) return "<div class=\"maps\">" + maps + "</div>";
  // Without a script all storeys stand below each other.
  return "<div class=\"switch\" role=\"group\" aria-label=\"storey\">" + switches +
         "<label><input type=\"checkbox\" id=\"follow\" checked> follow the robot</label></div><div class=\"maps\">" +
         maps + "</div>";
}

std::string map_key(const ReportInput& input) {
  const auto item = [](const std::string& stroke, const std::string& label) {
    return "<span><svg viewBox=\"0 0 34 10\"><line x1=\"1\" y1=\"5\" x2=\"33\" y2=\"5\" " + stroke + "/></svg>" +
           label + "</span>";
  };
  const auto area = [](const std::string& attributes, const std::string& label) {
    return "<span><svg viewBox=\"0 0 34 10\"><rect " + attributes +
           " x=\"9\" y=\"1\" width=\"16\" height=\"8\"/></svg>" + label + "</span>";
  };
  std::string found;
  bool invented = false;
  for (const ReportMethod& method : input.methods) {
    if (is_truth(method) || method.localization) continue;
    const std::string ink = method_ink(method.ink), name = svg::escape(method.name);
    if (!method.walls.empty())
      found += item("stroke=\"" + ink + "\" stroke-width=\"4\" stroke-opacity=\".8\"", "wall that " + name + " found");
    if (!method.rooms.empty())
      found += area("fill=\"" + ink + "\" fill-opacity=\".2\" stroke=\"" + ink + "\"", "room that " + name + " found");
    for (const ReportRoom& room : method.rooms) invented = invented || !room.matched;
  }
  if (invented && !input.plan.rooms.empty())
    found +=
        area("fill=\"var(--wrong)\" fill-opacity=\".18\" stroke=\"var(--wrong)\"", "room found where there is none");
  const bool deviates = std::any_of(input.storeys.begin(), input.storeys.end(),
                                    [](const ReportStorey& storey) { return !storey.deviations.empty(); });
  if (deviates)
    found +=
        area("fill=\"var(--asbuilt)\" fill-opacity=\".55\" stroke=\"var(--asbuilt)\"", "built otherwise than planned") +
        area("fill=\"none\" stroke=\"var(--planned)\" stroke-dasharray=\"3 2\"", "planned and not built");
  if (!input.flights.empty())
    found += item("stroke=\"var(--wall)\" stroke-width=\"20\" stroke-dasharray=\"1 4\"", "stairs (arrow: up)");
  std::string key = "<div class=\"key\">";
  if (input.has_plan)
    key += item("stroke=\"var(--wall)\" stroke-width=\"3\"", "wall of the building (faint: overhead)") +
           area("class=\"thing\"", "columns, furniture and other obstacles (dashed: with gaps)");
  if (!input.truth.empty())
    key += item("stroke=\"var(--truth)\" stroke-width=\"2\" stroke-dasharray=\"5 4\"", svg::escape(input.truth_name));
  key += item("stroke=\"var(--m0)\" stroke-width=\"2\"", "estimate (in the colour of its method)") + found;
  if (std::any_of(input.methods.begin(), input.methods.end(), draws_lost))
    key += item("stroke=\"var(--m0)\" stroke-width=\"2\" stroke-dasharray=\"1 4\"", "while it reports LOST");
  if (std::any_of(input.methods.begin(), input.methods.end(), [](const auto& m) { return !m.corrected.empty(); }))
    key += item("stroke=\"var(--m0)\" stroke-width=\"5\" stroke-opacity=\".3\"", "path after the last optimisation");
  key += "</div>";
  return input.truth.empty() ? key : key + error_key();
}

}  // namespace plumbline::scenarios
