// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/replay/replay_page.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenarios/host/interrupt.h"
#include "scenarios/metrics/result_words.h"
#include "scenarios/metrics/storey.h"
#include "scenarios/report/belief.h"
#include "scenarios/report/map_drawing.h"
#include "scenarios/report/method_cards.h"
#include "scenarios/report/palette.h"
#include "scenarios/report/replay/assets.h"
#include "scenarios/report/replay/deflate.h"
#include "scenarios/report/replay/map_packer.h"
#include "scenarios/report/replay/replay_scene.h"
#include "scenarios/report/replay/replay_tracks.h"
#include "scenarios/report/report_builder.h"
#include "scenarios/report/results.h"
#include "scenarios/report/svg.h"
#include "scenarios/score/moment.h"
#include "sim/world.h"

namespace plumbline::scenarios {

namespace {

constexpr std::size_t scans_a_chunk = 10;

std::string block(const std::string& id, std::string_view bytes) {
  check_interrupt();
  return "<script type=\"text/plain\" id=\"" + id + "\">" + base64(deflated(bytes)) + "</script>\n";
}

std::string tree_block(const std::string& id, const Tree& tree) { return block(id, write_json(tree, 0)); }

/// A hash as a content security policy wants it.
std::string policy_hash(std::string_view sha256_hex) {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  std::string bytes;
  for (std::size_t i = 0; i + 1 < sha256_hex.size(); i += 2)
    bytes += static_cast<char>(16 * digit(sha256_hex[i]) + digit(sha256_hex[i + 1]));
  return "'sha256-" + base64(bytes) + "'";
}

std::string policy() {
  return "default-src 'none'; script-src " + policy_hash(replay_library.sha256_hex) + " " +
         policy_hash(replay_script.sha256_hex) + "; style-src " + policy_hash(replay_style.sha256_hex) +
         "; img-src data: blob:; frame-src 'self' file:; base-uri 'none'; form-action 'none'";
}

Tree mark(double t_s, const std::string& label, const std::string& kind, const std::string& method = "") {
  return Tree::map().set("t", whole(t_s, 0.001)).set("label", label).set("kind", kind).set("m", method);
}

/// What a cause of failure says, as the documents have it.
std::string words_of(const std::string& failure) {
  const auto words = score::result_words();
  const auto found = std::find_if(words.begin(), words.end(), [&](const score::ResultWord& word) {
    return word.key == "localization.failure" && word.word == failure;
  });
  return found == words.end() ? failure : std::string(found->doc);
}

/// Where a localization first had one answer, first a wrong one, and lost it.
void add_method_marks(const ReportMethod& method, const Tree* results, double start_s, Tree& marks) {
  const Tree* where = results == nullptr ? nullptr : results->find("localization");
  if (const auto at = number_of(where, "converged_at_s"))
    marks.push(mark(start_s + *at, "converged", "converged", method.name));
  constexpr double apart_s = 5.0;  // of two marks of a kind: a method at the edge of being wrong would fill the line
  bool was_lost = false, was_wrong = false;
  double last_lost_s = -apart_s, last_wrong_s = -apart_s;
  for (const ReportSample& sample : method.samples) {
    if (sample.lost && !was_lost && sample.t_s - std::exchange(last_lost_s, sample.t_s) >= apart_s)
      marks.push(mark(sample.t_s, "lost", "lost", method.name));
    was_lost = sample.lost;
    const bool wrong = method.localization && !sample.lost && sample.error_m > score::LocalizationRules().position_m;
    if (wrong && !was_wrong && sample.t_s - std::exchange(last_wrong_s, sample.t_s) >= apart_s)
      marks.push(mark(sample.t_s, "wrong by more than 0.5 m", "wrong", method.name));
    was_wrong = wrong;
  }
  if (const auto at = number_of(where, "failure_at_s")) {
    const std::string failure = text_of(*where, "failure");
    const bool too_late = failure == "undecided" && number_of(where, "converged_at_s");
    marks.push(
        mark(*at, "failed: " + (too_late ? "answered too late to count" : words_of(failure)), "failure", method.name));
  }
}

/// Where SLAM, aligned over the whole run, is first far off; and since alignment spreads an error over the run, where
/// its own motion over the last metre walked was off most.
void add_slam_marks(const ReportMethod& method, Tree& marks) {
  const ReportSample *first = nullptr, *slip = nullptr;
  double most_m = 0.0;
  for (const ReportSample& sample : method.samples) {
    if (sample.lost) continue;
    if (first == nullptr && sample.error_m > score::TrajectoryRules().far_off_m) first = &sample;
    most_m = std::max(most_m, sample.error_m);
    if (sample.relative_m && (slip == nullptr || *sample.relative_m > *slip->relative_m)) slip = &sample;
  }
  if (first == nullptr) return;
  marks.push(mark(first->t_s,
                  "off by more than " + svg::number(score::TrajectoryRules().far_off_m, 1) + " m, by " +
                      svg::number(most_m, 2) + " m at most",
                  "far", method.name));
  if (slip != nullptr)
    marks.push(mark(slip->t_s, "the last metre is off by " + svg::number(*slip->relative_m, 2) + " m, its most", "slip",
                    method.name));
}

Tree marks_of(const FinishedRun& run, const score::RunScore& score, const ReportInput& input) {
  Tree marks = Tree::list();
  for (const PlotMark& common : common_marks(input)) marks.push(mark(common.t_s, common.label, "run"));
  for (const ReportMethod& method : input.methods)
    if (!is_truth(method)) add_method_marks(method, results_of(input, method.name), start_s(input), marks);
  for (const ReportMethod& method : input.methods)
    if (!is_truth(method) && !method.localization) add_slam_marks(method, marks);
  for (std::size_t i = 0; i < run.record.methods.size(); ++i) {
    const MethodRecord& method = run.record.methods[i];
    const double last_s = method.causal.empty() ? start_s(input) : slam::seconds(method.causal.back().stamp);
    if (method.crashed) marks.push(mark(last_s, "crashed: " + score.methods[i].error, "failure", method.name));
  }
  if (!run.record.failure.empty() && !input.truth.empty())
    marks.push(mark(input.truth.back().t_s, "the scenario failed: " + run.record.failure, "failure"));
  for (const score::GateResult& gate : score.gates)
    if (const auto at = gate.passed ? std::nullopt : score::telling_moment(run, score, gate))
      marks.push(mark(*at, "gate failed: " + gate.metric, "gate", gate.method));
  std::stable_sort(std::get<Tree::List>(marks.value).begin(), std::get<Tree::List>(marks.value).end(),
                   [](const Tree& a, const Tree& b) { return a.find("t")->as_int() < b.find("t")->as_int(); });
  return marks;
}

Tree methods_of(const FinishedRun& run, const ReportInput& input) {
  Tree list = Tree::list();
  for (std::size_t i = 0; i < input.methods.size(); ++i) {
    const ReportMethod& method = input.methods[i];
    if (is_truth(method)) continue;
    const Tree* results = results_of(input, method.name);
    list.push(Tree::map()
                  .set("name", method.name)
                  .set("colour", std::string(method_colour(method.ink).light))
                  .set("dark", std::string(method_colour(method.ink).dark))
                  .set("localizes", method.localization)
                  .set("crashed", run.record.methods[i].crashed)
                  .set("verdict", results == nullptr ? std::string() : text_of(*results, "verdict")));
  }
  return list;
}

Tree gate_list(const score::RunScore& score) {
  Tree list = Tree::list();
  for (const score::GateResult& gate : score.gates)
    list.push(Tree::map().set("text", score::describe(gate)).set("passed", gate.passed).set("link", gate.see));
  return list;
}

Tree unjudged_of(const ReportInput& input) {
  Tree list = Tree::list();
  for (const Unjudged& method : unjudged(input.results))
    list.push(Tree::map().set("m", method.method).set("text", method.text()));
  return list;
}

Tree numbers(const std::vector<double>& values, double unit) {
  Tree list = Tree::list();
  for (const double value : values) list.push(whole(value, unit));
  return list;
}

Tree pose(const Pose& X) {
  Tree list = Tree::list();
  for (int k = 0; k < 3; ++k) list.push(whole(X.t[k], 1e-5));
  for (int k = 0; k < 4; ++k) list.push(whole(X.q.coeffs()[k], 1e-7));
  return list;
}

Tree scans_of(const ScanPacker& packer, const std::vector<std::size_t>& kept) {
  const ScanGrid& grid = packer.grid();
  DeltaColumn stamps(0.001), azimuths(1e-5);
  for (const std::size_t i : kept) {
    stamps.add(slam::seconds(packer.scans()[i].stamp));
    azimuths.add(packer.scans()[i].azimuth0);
  }
  return Tree::map()
      .set("rings", grid.rings)
      .set("columns", grid.columns)
      .set("every", grid.every)
      .set("unit", whole(grid.unit_m, 0.001))
      .set("turn", whole(grid.turn_rad, 1e-9))
      .set("span", whole(grid.span_s, 1e-6))
      .set("column", whole(grid.column_s, 1e-9))
      .set("azimuth", numbers(grid.azimuth_rad, 1e-6))
      .set("cosine", numbers(grid.cosine, 1e-6))
      .set("sine", numbers(grid.sine, 1e-6))
      .set("height", numbers(grid.height_m, 1e-5))
      .set("mount", pose(sim::World::calibration().X_RL))
      .set("all", static_cast<std::int64_t>(packer.scans().size()))
      .set("chunk", static_cast<std::int64_t>(scans_a_chunk))
      .set("t", stamps.take())
      .set("a", azimuths.take());
}

std::string chunks_of(const ScanPacker& packer, const std::vector<std::size_t>& kept) {
  std::string out;
  for (std::size_t first = 0; first < kept.size(); first += scans_a_chunk) {
    std::string bytes;
    for (std::size_t i = first; i < std::min(kept.size(), first + scans_a_chunk); ++i) bytes += packer.ranges(kept[i]);
    out += block("scans" + std::to_string(first / scans_a_chunk), bytes);
  }
  return out;
}

Tree run_of(const FinishedRun& run, const score::RunScore& score, const ReportInput& input) {
  return Tree::map()
      .set("version", 1)
      .set("name", text_of(input.results, "scenario"))
      .set("seed", text_of(input.results, "seed"))
      .set("digest", text_of(input.results, "digest"))
      .set("end", whole(input.truth.empty() ? 0.0 : input.truth.back().t_s, 0.001))
      .set("base", whole(score::base_height_m(), 0.001))
      .set("wrong", whole(score::LocalizationRules().position_m, 0.001))
      .set("failure", run.record.failure)
      .set("methods", methods_of(run, input))
      .set("gates", gate_list(score))
      .set("unjudged", unjudged_of(input))
      .set("marks", marks_of(run, score, input));
}

/// The map clouds of methods, a block each, and where they stand.
struct DrawnMaps {
  Tree about = Tree::map();
  std::string blocks;
};

DrawnMaps maps_of(const FinishedRun& run, const score::RunScore& score, const Eigen::Vector3d& origin) {
  DrawnMaps maps;
  for (std::size_t i = 0; i < run.record.methods.size(); ++i) {
    const MethodRecord& method = run.record.methods[i];
    if (method.name == "truth" || method.estimate.map_F.empty()) continue;
    const PackedMap map = pack_map(method.estimate.map_F, map_pose(method, score.methods[i]), origin);
    const std::string id = "map" + std::to_string(i);
    maps.about.set(method.name, Tree::map().set("block", id).set("count", static_cast<std::int64_t>(map.count)));
    maps.blocks += block(id, map.bytes);
  }
  return maps;
}

std::vector<double> moments_of(const Tree& run) {
  std::vector<double> moments;
  for (const Tree& mark : run.find("marks")->as_list())
    moments.push_back(0.001 * static_cast<double>(mark.find("t")->as_int()));
  return moments;
}

std::string head(const std::string& title) {
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"" +
      policy() +
      "\">\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
      "<title>" +
      svg::escape(title) + " · replay</title>\n<style>";
  out += replay_style.text;
  return out +
         "</style></head>\n<body><noscript>This page needs its script. Where a viewer forbids scripts, download "
         "the file and open it in a browser.</noscript>\n<div id=\"app\"></div>\n";
}

}  // namespace

std::vector<std::size_t> kept_scans(const std::vector<PackedScan>& scans, const std::vector<double>& moments_s,
                                    std::size_t most_bytes) {
  constexpr double near_s = 2.0;
  const auto is_near = [&](const PackedScan& scan) {
    return std::any_of(moments_s.begin(), moments_s.end(),
                       [&](double t_s) { return std::abs(slam::seconds(scan.stamp) - t_s) <= near_s; });
  };
  std::vector<std::size_t> kept;
  for (std::size_t every = 1;; ++every) {
    // Beyond one scan a second nothing is spared for the moments either.
    const std::size_t every_near = every <= 10 ? 1 : every / 10 + 1;
    kept.clear();
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < scans.size(); ++i) {
      if (i % (is_near(scans[i]) ? every_near : every) != 0) continue;
      kept.push_back(i);
      bytes += scans[i].bytes.size();
    }
    if (bytes + bytes / 3 <= most_bytes || kept.size() <= 1) return kept;
  }
}

std::string render_replay(const FinishedRun& run, const score::RunScore& score, const ScanPacker& scans,
                          const std::map<std::string, Tree>& graphs, const ReplayOptions& options) {
  const ReportInput input = report_input(run, score);
  const Eigen::Vector3d origin = replay_origin(run);
  Tree drawn_graphs = Tree::map();
  for (std::size_t i = 0; i < run.record.methods.size(); ++i) {
    const MethodRecord& method = run.record.methods[i];
    const auto graph = graphs.find(method.name);
    if (graph != graphs.end())
      drawn_graphs.set(method.name, replay_graph(method, score.methods[i], graph->second, origin));
  }
  std::string page = head(text_of(input.results, "scenario"));
  const DrawnMaps maps = maps_of(run, score, origin);
  Tree about = run_of(run, score, input);
  about.set("maps", maps.about);
  page += maps.blocks + tree_block("run", about) + tree_block("scene", replay_scene(run, input, origin)) +
          block("mesh", replay_mesh(run, origin)) + tree_block("tracks", replay_tracks(run, score, origin)) +
          tree_block("beliefs", replay_beliefs(run, score, origin)) + tree_block("graphs", drawn_graphs);
  std::string scripts = "<script>";
  scripts += replay_library.text;
  scripts += "</script>\n<script>";
  scripts += replay_script.text;
  scripts += "</script></body></html>\n";
  const std::size_t taken = page.size() + scripts.size();
  const std::vector<std::size_t> kept =
      kept_scans(scans.scans(), moments_of(about), options.most_bytes > taken ? options.most_bytes - taken : 0);
  page += tree_block("scans", scans_of(scans, kept)) + chunks_of(scans, kept);
  return page + scripts;
}

}  // namespace plumbline::scenarios
