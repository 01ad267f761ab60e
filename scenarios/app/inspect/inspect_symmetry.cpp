// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/inspect/inspect_symmetry.h"

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

std::string rooms_text(const bim::Building& building, const bim::RoomClass& like) {
  std::string text;
  for (const bim::SimilarRoom& room : like.rooms) {
    text += (text.empty() ? "" : ", ") + name_of(building.rooms[static_cast<std::size_t>(room.room)]);
    if (room.similarity.grade == SimilarityGrade::near)
      text += " (off by " + fixed_point(room.similarity.deviation_m, 3) + " m in " +
              printable(room.similarity.deviations.front().element) + ")";
  }
  for (const Isometry2& turn : like.turns)
    text += "; each also turned by " + fixed_point(turn.angle * degrees, 0) + " deg";
  return text;
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
  return tree.set("rooms", rooms_json(building, report.rooms));
}

std::string symmetry_text(const bim::Building& building, const bim::SymmetryReport& report) {
  const auto storey = [&](int i) { return name_of(building.storeys[static_cast<std::size_t>(i)]); };
  std::string text;
  for (const bim::BuildingSymmetry& symmetry : report.building)
    text += "  whole building: " + motion(symmetry.isometry) + ", " + similarity_text(symmetry.similarity) + "\n";
  for (const bim::StoreySymmetry& symmetry : report.storeys)
    text += "  " + storey(symmetry.from) + ": " + motion(symmetry.isometry) + ", " +
            similarity_text(symmetry.similarity) + "\n";
  for (const bim::StoreySymmetry& symmetry : report.copies)
    text += "  " + storey(symmetry.to) + " like " + storey(symmetry.from) + ": " + motion(symmetry.isometry) + ", " +
            similarity_text(symmetry.similarity) + "\n";
  for (const bim::RoomClass& like : report.rooms)
    text += std::string(like.rooms.back().similarity.grade == SimilarityGrade::exact ? "  rooms alike: "
                                                                                     : "  rooms nearly alike: ") +
            rooms_text(building, like) + "\n";
  for (const bim::StoreySymmetry& symmetry : report.reflections)
    text += "  no confusion for a robot: " + storey(symmetry.from) + ", " + motion(symmetry.isometry) + ", " +
            similarity_text(symmetry.similarity) + "\n";
  return "symmetry\n" +
         (text.empty() ? "  none: no turn or shift maps the building, a storey or a room onto another\n" : text);
}

}  // namespace plumbline::scenarios
