// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/inspect/inspect_symmetry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bim/config/printable.h"
#include "scenarios/app/inspect/fixed_point.h"

namespace plumbline::scenarios {
namespace {

using bim::Isometry2;
using bim::Similarity;
using bim::SimilarityGrade;

constexpr double degrees = 180.0 / std::numbers::pi;
/// Fitted places and angles carry rounding below this (0.1 micrometre, 1e-7 degrees).
constexpr double steps = 1e7;

double rounded(double v) { return std::round(v * steps) / steps; }

Tree point(const Eigen::Vector2d& p) { return Tree(Tree::List{Tree(rounded(p.x())), Tree(rounded(p.y()))}); }

std::string place(const Eigen::Vector2d& p) { return "(" + fixed_point(p.x(), 2) + ", " + fixed_point(p.y(), 2) + ")"; }

Tree isometry_json(const Isometry2& g) {
  Tree tree = Tree::map();
  tree.set("angle_deg", rounded(g.angle * degrees)).set("t", point(g.t));
  if (const auto centre = g.centre()) tree.set("about", point(*centre));
  if (g.mirrored) tree.set("mirrored", true);
  return tree;
}

void add_similarity(const Similarity& similarity, Tree& tree) {
  tree.set("grade", similarity.grade == SimilarityGrade::exact ? "exact" : "near");
  tree.set("iou", rounded(similarity.iou)).set("deviation_m", rounded(similarity.deviation_m));
  Tree deviations = Tree::list();
  for (const bim::Deviation& deviation : similarity.deviations) {
    Tree entry = Tree::map();
    entry.set("element", deviation.element).set("at", point(deviation.at)).set("size_m", rounded(deviation.size_m));
    deviations.push(std::move(entry));
  }
  tree.set("deviations", std::move(deviations));
}

const std::string& storey_id(const bim::Building& building, int storey) {
  return building.storeys[static_cast<std::size_t>(storey)].id;
}

Tree storeys_json(const bim::Building& building, const std::vector<bim::StoreySymmetry>& symmetries) {
  Tree list = Tree::list();
  for (const bim::StoreySymmetry& symmetry : symmetries) {
    Tree tree = Tree::map();
    tree.set("from", storey_id(building, symmetry.from)).set("to", storey_id(building, symmetry.to));
    tree.set("isometry", isometry_json(symmetry.isometry));
    add_similarity(symmetry.similarity, tree);
    list.push(std::move(tree));
  }
  return list;
}

Tree rooms_json(const bim::Building& building, const std::vector<bim::RoomClass>& classes) {
  Tree list = Tree::list();
  for (const bim::RoomClass& like : classes) {
    Tree rooms = Tree::list(), turns = Tree::list();
    for (const bim::SimilarRoom& room : like.rooms) {
      Tree tree = Tree::map();
      tree.set("room", building.rooms[static_cast<std::size_t>(room.room)].id);
      tree.set("isometry", isometry_json(room.isometry));
      add_similarity(room.similarity, tree);
      rooms.push(std::move(tree));
    }
    for (const Isometry2& turn : like.turns) turns.push(isometry_json(turn));
    Tree entry = Tree::map();
    list.push(std::move(entry.set("rooms", std::move(rooms)).set("turns", std::move(turns))));
  }
  return list;
}

std::string name_of(const bim::Storey& storey) { return printable(storey.name.empty() ? storey.id : storey.name); }
std::string name_of(const bim::Room& room) { return printable(room.name.empty() ? room.id : room.name); }

std::string motion(const Isometry2& g) {
  if (const auto centre = g.centre())
    return "turn by " + fixed_point(g.angle * degrees, 2) + " deg about " + place(*centre);
  const bool shifted = g.t.norm() >= 0.005;
  if (g.mirrored) return "mirror image at " + fixed_point(0.5 * g.angle * degrees, 2) + " deg";
  return shifted ? "shift by " + place(g.t) : "the same place";
}

std::string similarity_text(const Similarity& similarity) {
  std::string text = similarity.grade == SimilarityGrade::exact ? "exact" : "near";
  text += ", IoU " + fixed_point(similarity.iou, 3);
  if (similarity.deviations.empty()) return text;
  const bim::Deviation& first = similarity.deviations.front();
  text += ", off by " + fixed_point(first.size_m, 3) + " m in " + printable(first.element) + " at " + place(first.at);
  const std::size_t others = similarity.deviations.size() - 1;
  return others == 0 ? text : text + " and in " + std::to_string(others) + " more";
}

constexpr std::size_t most_listed = 6;  ///< lines in a row that are read; assumed
constexpr std::size_t few = 3;          ///< of a longer list that forms no group

std::string others_text(std::size_t count, const std::string& what) {
  return std::to_string(count) + " more " + what + " (--json lists them)";
}

std::string fold_step(const std::vector<Isometry2>& turns) {
  return fixed_point(360.0 / static_cast<double>(turns.size() + 1), 2);
}

/// The centre of a group of turns that is complete but for the identity; absent where they are none.
std::optional<Eigen::Vector2d> fold_centre(const std::vector<Isometry2>& turns) {
  constexpr double same_m = 0.05, same_rad = 0.02;  // fits to rounded coordinates differ; assumed
  const double step = 2.0 * std::numbers::pi / static_cast<double>(turns.size() + 1);
  std::vector<int> multiples;
  std::optional<Eigen::Vector2d> first;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Isometry2& turn : turns) {
    const auto centre = turn.mirrored ? std::nullopt : turn.centre();
    if (!centre || (first && (*centre - *first).norm() > same_m)) return std::nullopt;
    if (!first) first = centre;
    const double times = (turn.angle < 0.0 ? turn.angle + 2.0 * std::numbers::pi : turn.angle) / step;
    if (std::abs(times - std::round(times)) * step > same_rad) return std::nullopt;
    multiples.push_back(static_cast<int>(std::lround(times)));
    sum += *centre;
  }
  std::sort(multiples.begin(), multiples.end());
  for (std::size_t i = 0; i < multiples.size(); ++i)
    if (multiples[i] != static_cast<int>(i) + 1) return std::nullopt;
  if (turns.empty()) return std::nullopt;
  return Eigen::Vector2d(sum / static_cast<double>(turns.size()));
}

std::string rooms_text(const bim::Building& building, const bim::RoomClass& like) {
  std::string text;
  for (const bim::SimilarRoom& room : like.rooms) {
    text += (text.empty() ? "" : ", ") + name_of(building.rooms[static_cast<std::size_t>(room.room)]);
    if (room.similarity.grade == SimilarityGrade::near)
      text += " (off by " + fixed_point(room.similarity.deviation_m, 3) + " m in " +
              printable(room.similarity.deviations.front().element) + ")";
  }
  if (like.turns.empty()) return text;
  if (like.turns.size() > most_listed && fold_centre(like.turns))
    return text + "; each " + std::to_string(like.turns.size() + 1) + "-fold, turned by multiples of " +
           fold_step(like.turns) + " deg";
  const std::size_t listed = like.turns.size() > most_listed ? few : like.turns.size();
  for (std::size_t i = 0; i < listed; ++i)
    text += "; each also turned by " + fixed_point(like.turns[i].angle * degrees, 0) + " deg";
  return listed == like.turns.size() ? text : text + "; and " + others_text(like.turns.size() - listed, "turns");
}

/// One line for each motion; of more than most_listed one for the group they form, or the first few and how many more.
template <typename Symmetry>
std::string motions_text(const std::string& what, const std::vector<Symmetry>& symmetries) {
  std::string text;
  std::vector<Isometry2> motions;
  for (const Symmetry& symmetry : symmetries) motions.push_back(symmetry.isometry);
  const bool many = symmetries.size() > most_listed;
  if (const auto about = many ? fold_centre(motions) : std::nullopt) {
    const auto worse = [](const Symmetry& a, const Symmetry& b) {
      return a.similarity.deviation_m < b.similarity.deviation_m;
    };
    const Symmetry& worst = *std::max_element(symmetries.begin(), symmetries.end(), worse);
    return "  " + what + ": " + std::to_string(motions.size() + 1) + "-fold about " + place(*about) +
           ", turns by multiples of " + fold_step(motions) + " deg, the least alike " +
           similarity_text(worst.similarity) + "\n";
  }
  const std::size_t listed = many ? few : symmetries.size();
  for (std::size_t i = 0; i < listed; ++i)
    text += "  " + what + ": " + motion(motions[i]) + ", " + similarity_text(symmetries[i].similarity) + "\n";
  if (many)
    text += "  " + what + ": " +
            others_text(symmetries.size() - listed, motions.front().mirrored ? "mirror images" : "motions") + "\n";
  return text;
}

/// The part of a list between the same two storeys, in their order.
std::vector<std::vector<bim::StoreySymmetry>> by_storeys(const std::vector<bim::StoreySymmetry>& symmetries) {
  std::vector<std::vector<bim::StoreySymmetry>> parts;
  for (const bim::StoreySymmetry& symmetry : symmetries) {
    if (parts.empty() || parts.back().front().from != symmetry.from || parts.back().front().to != symmetry.to)
      parts.emplace_back();
    parts.back().push_back(symmetry);
  }
  return parts;
}

}  // namespace

Tree symmetry_json(const bim::Building& building, const bim::SymmetryReport& report) {
  Tree whole = Tree::list();
  for (const bim::BuildingSymmetry& symmetry : report.building) {
    Tree tree = Tree::map();
    tree.set("isometry", isometry_json(symmetry.isometry));
    add_similarity(symmetry.similarity, tree);
    whole.push(std::move(tree));
  }
  Tree tree = Tree::map();
  tree.set("building", std::move(whole)).set("storeys", storeys_json(building, report.storeys));
  tree.set("copies", storeys_json(building, report.copies));
  tree.set("reflections", storeys_json(building, report.reflections));
  if (!report.left_out.empty()) {
    Tree left_out = Tree::list();
    for (const std::string& id : report.left_out) left_out.push(id);
    tree.set("left_out", std::move(left_out));
  }
  return tree.set("rooms", rooms_json(building, report.rooms));
}

std::string symmetry_text(const bim::Building& building, const bim::SymmetryReport& report) {
  const auto storey = [&](int i) { return name_of(building.storeys[static_cast<std::size_t>(i)]); };
  std::string text;
  text += motions_text("whole building", report.building);
  for (const auto& part : by_storeys(report.storeys)) text += motions_text(storey(part.front().from), part);
  for (const auto& part : by_storeys(report.copies))
    text += motions_text(storey(part.front().to) + " like " + storey(part.front().from), part);
  for (const bim::RoomClass& like : report.rooms)
    text += std::string(like.rooms.back().similarity.grade == SimilarityGrade::exact ? "  rooms alike: "
                                                                                     : "  rooms nearly alike: ") +
            rooms_text(building, like) + "\n";
  for (const auto& part : by_storeys(report.reflections))
    text += motions_text("no confusion for a robot: " + storey(part.front().from), part);
  std::string unknown;
  for (const std::string& id : report.left_out)
    unknown += "  not compared: " + printable(id) +
               ", one body around most of its storey; walls that are bodies of their own are\n";
  if (text.empty() && unknown.empty())
    text = "  none: no rotation or translation maps the building, a storey or a room onto another\n";
  return "symmetry\n" + text + unknown;
}

}  // namespace plumbline::scenarios
