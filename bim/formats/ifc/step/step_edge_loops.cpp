// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_edge_loops.h"

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "bim/formats/ifc/step/step_conics.h"
#include "bim/formats/ifc/step/step_edits.h"
#include "bim/formats/ifc/step/step_entities.h"
#include "bim/formats/ifc/step/step_units.h"

namespace plumbline::bim {
namespace {

using Kind = StepValue::Kind;
using Line = std::vector<Eigen::Vector3d>;

bool flag(const StepValue& value) { return value.kind != Kind::enumeration || value.as_flag(); }

class EdgeLoops {
 public:
  EdgeLoops(const std::string& text, const std::string& file)
      : entities_(text, file),
        edits_(text, entities_),
        depth_(arc_depth_m / assigned_unit(entities_, "LENGTHUNIT").value_or(1.0)) {}

  std::string read() {
    take_each(entities_, [&](const StepEntities::Entity& entity) {
      if (entity.type == "IFCEDGELOOP") take_loop(entity);
    });
    take_each(entities_, [&](const StepEntities::Entity& entity) {
      if (entity.type == "IFCADVANCEDFACE" || entity.type == "IFCFACESURFACE") take_face(entity);
    });
    if (!facets_.empty()) {
      take_each(entities_, [&](const StepEntities::Entity& entity) {
        if (entity.type == "IFCCLOSEDSHELL" || entity.type == "IFCOPENSHELL" || entity.type == "IFCCONNECTEDFACESET")
          take_shell(entity);
      });
    }
    return edits_.done();
  }

 private:
  [[nodiscard]] Eigen::Vector3d vertex(const StepValue& reference) const {
    return cartesian_point(entities_, entities_.attributes(reference, "IFCVERTEXPOINT").at(0));
  }

  /// From one end to the other along a curve, with it or against it; nullopt for curves of other kinds.
  [[nodiscard]] std::optional<Line> along(const StepEntities::Entity& curve, const Eigen::Vector3d& first,
                                          const Eigen::Vector3d& last, bool forward) const {
    if (curve.type == "IFCLINE") return Line{first, last};
    if (const std::optional<StepConic> conic = conic_of(entities_, curve))
      return arc_between(*conic, first, last, forward, depth_);
    const StepValue values = entities_.attributes(curve);
    if (curve.type == "IFCSURFACECURVE" || curve.type == "IFCSEAMCURVE" || curve.type == "IFCINTERSECTIONCURVE")
      return along(entities_.entity(values.at(0).as_reference()), first, last, forward);
    if (curve.type == "IFCTRIMMEDCURVE")
      return along(entities_.entity(values.at(0).as_reference()), first, last, forward == flag(values.at(3)));
    if (curve.type != "IFCPOLYLINE") return std::nullopt;
    Line line;
    for (const StepValue& point : values.at(0).as_list()) line.push_back(cartesian_point(entities_, point));
    if (line.size() < 2) return std::nullopt;
    if (!forward) std::reverse(line.begin(), line.end());
    line.front() = first;
    line.back() = last;
    return line;
  }

  /// Points of the edges of a loop, each from its beginning to its end; nullopt where one of them is of another kind.
  [[nodiscard]] std::optional<std::vector<Line>> edges_of(const StepEntities::Entity& loop) {
    std::vector<Line> edges;
    const StepValue values = entities_.attributes(loop);
    for (const StepValue& reference : values.at(0).as_list()) {
      const StepValue oriented = entities_.attributes(reference, "IFCORIENTEDEDGE");
      const StepEntities::Entity& entity = entities_.entity(oriented.at(2).as_reference());
      const StepValue edge = entities_.attributes(entity);
      const Eigen::Vector3d first = vertex(edge.at(0)), last = vertex(edge.at(1));
      std::optional<Line> line = Line{first, last};
      if (entity.type == "IFCEDGECURVE")
        line = along(entities_.entity(edge.at(2).as_reference()), first, last, flag(edge.at(3)));
      if (!line || (corners_ += line->size()) > most_corners) return std::nullopt;
      if (!flag(oriented.at(3))) std::reverse(line->begin(), line->end());
      edges.push_back(std::move(*line));
    }
    return edges;
  }

  std::string polygon(const Line& corners) {
    std::string points;
    for (const Eigen::Vector3d& p : corners)
      points += (points.empty() ? "" : ",") + edits_.add("IFCCARTESIANPOINT((" + StepEdits::real(p.x()) + "," +
                                                         StepEdits::real(p.y()) + "," + StepEdits::real(p.z()) + "))");
    return "IFCPOLYLOOP((" + points + "))";
  }

  void take_loop(const StepEntities::Entity& loop) {
    std::optional<std::vector<Line>> edges = edges_of(loop);
    if (!edges) return;
    Line corners;
    for (const Line& edge : *edges) corners.insert(corners.end(), edge.begin(), edge.end() - 1);
    if (corners.size() < 3 || !edits_.has_room(corners.size())) return;
    edits_.replace(loop, polygon(corners));
    edges_[loop.number] = std::move(*edges);
  }

  /// A face that is not plane, between two curves and two straight lines, as facets across.
  void take_face(const StepEntities::Entity& face) {
    const StepValue values = entities_.attributes(face);
    const std::vector<StepValue>& bounds = values.at(0).as_list();
    if (bounds.size() != 1 || entities_.entity(values.at(1).as_reference()).type == "IFCPLANE") return;
    const StepValue bound = entities_.attributes(bounds.front().as_reference());
    const auto found = edges_.find(bound.at(0).as_reference());
    if (found == edges_.end() || found->second.size() != 4) return;
    std::vector<Line> sides = found->second;
    if (sides[0].size() == 2) std::rotate(sides.begin(), sides.begin() + 1, sides.end());
    const std::size_t n = sides[0].size();
    if (n < 3 || sides[2].size() != n || sides[1].size() != 2 || sides[3].size() != 2 || !edits_.has_room(8 * n))
      return;
    std::string facets;
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const std::string loop =
          edits_.add(polygon({sides[0][i], sides[0][i + 1], sides[2][n - 2 - i], sides[2][n - 1 - i]}));
      const std::string edge = edits_.add("IFCFACEOUTERBOUND(" + loop + (flag(bound.at(1)) ? ",.T.)" : ",.F.)"));
      facets += (facets.empty() ? "" : ",") + edits_.add("IFCFACE((" + edge + "))");
    }
    facets_[face.number] = facets;
  }

  void take_shell(const StepEntities::Entity& shell) {
    const StepValue values = entities_.attributes(shell);
    std::string faces;
    bool changed = false;
    for (const StepValue& face : values.at(0).as_list()) {
      const auto found = facets_.find(face.as_reference());
      changed = changed || found != facets_.end();
      faces += (faces.empty() ? "" : ",") + (found == facets_.end() ? step_argument(face) : found->second);
    }
    if (changed) edits_.replace(shell, std::string(shell.type) + "((" + faces + "))");
  }

  /// More, as of edges that loops hold many times over, are left to the reader.
  static constexpr std::size_t most_corners = 5'000'000;

  StepEntities entities_;
  StepEdits edits_;
  double depth_;                                     ///< of pieces of arcs, in the file's unit
  std::map<std::int64_t, std::vector<Line>> edges_;  ///< of the loops taken, by their numbers
  std::map<std::int64_t, std::string> facets_;       ///< of the faces taken
  std::size_t corners_ = 0;
};

}  // namespace

std::string with_plain_loops(const std::string& text, const std::string& file) {
  return text.find("IFCEDGELOOP") == std::string::npos ? text : EdgeLoops(text, file).read();
}

}  // namespace plumbline::bim
