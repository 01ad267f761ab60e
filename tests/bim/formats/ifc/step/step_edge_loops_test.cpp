// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_edge_loops.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <numbers>

#include "tests/bim/formats/ifc/step/step_body.h"

namespace plumbline::bim {
namespace {

/// Topology: vertices, edges and faces with edge loops.
class Brep {
 public:
  explicit Brep(Sketch& sketch) : sketch_(sketch) {}

  std::string vertex(const Eigen::Vector3d& p) {
    return sketch_.add("IFCVERTEXPOINT(" + sketch_.point(p.x(), p.y(), p.z()) + ")");
  }
  std::string line(const std::string& from, const std::string& to) {
    const std::string along =
        sketch_.add("IFCVECTOR(" + sketch_.add("IFCDIRECTION((1.,0.,0.))") + ",1.)");  // the vertices bound it
    return edge(from, to, sketch_.add("IFCLINE(" + sketch_.point(0, 0, 0) + "," + along + ")"));
  }
  std::string edge(const std::string& from, const std::string& to, const std::string& curve, bool same = true) {
    return sketch_.add("IFCEDGECURVE(" + from + "," + to + "," + curve + (same ? ",.T.)" : ",.F.)"));
  }
  std::string loop(const std::vector<std::pair<std::string, bool>>& edges) {
    std::string list;
    for (const auto& [name, forward] : edges)
      list += (list.empty() ? "" : ",") + sketch_.add("IFCORIENTEDEDGE(*,*," + name + (forward ? ",.T.)" : ",.F.)"));
    return sketch_.add("IFCEDGELOOP((" + list + "))");
  }
  void face(const std::string& surface, const std::vector<std::string>& loops) {
    std::string bounds;
    for (const std::string& one : loops)
      bounds += (bounds.empty() ? "" : ",") +
                sketch_.add(std::string(bounds.empty() ? "IFCFACEOUTERBOUND(" : "IFCFACEBOUND(") + one + ",.T.)");
    faces_ += (faces_.empty() ? "" : ",") + sketch_.add("IFCADVANCEDFACE((" + bounds + ")," + surface + ",.T.)");
  }
  std::string plane() { return sketch_.add("IFCPLANE(" + sketch_.frame(0, 0, 0) + ")"); }
  std::string done() { return sketch_.add("IFCADVANCEDBREP(" + sketch_.add("IFCCLOSEDSHELL((" + faces_ + "))") + ")"); }

 private:
  Sketch& sketch_;
  std::string faces_;
};

/// A box of 6 m^3 whose last face lies on a surface of its own, with its first edge along a curve of another.
StepBody box_with(const std::function<std::string(Sketch&)>& last_surface,
                  const std::function<std::string(Sketch&)>& first_curve = {}) {
  Sketch sketch;
  Brep brep(sketch);
  std::vector<std::string> corners;
  for (int i = 0; i < 8; ++i) corners.push_back(brep.vertex({(i & 1) * 2.0, ((i >> 1) & 1) * 3.0, (i >> 2) * 1.0}));
  std::map<std::pair<int, int>, std::string> edges;
  if (first_curve) edges[{0, 2}] = brep.edge(corners[0], corners[2], first_curve(sketch));
  const std::vector<std::vector<int>> faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                               {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const std::vector<int>& face : faces) {
    std::vector<std::pair<std::string, bool>> loop;
    for (std::size_t k = 0; k < 4; ++k) {
      const int a = face[k], b = face[(k + 1) % 4];
      std::string& edge = edges[std::minmax(a, b)];
      const auto at = [&](int i) { return corners[static_cast<std::size_t>(i)]; };
      if (edge.empty()) edge = brep.line(at(std::min(a, b)), at(std::max(a, b)));
      loop.emplace_back(edge, a < b);
    }
    brep.face(face == faces.back() ? last_surface(sketch) : brep.plane(), {brep.loop(loop)});
  }
  return body_of(sketch, brep.done());
}

std::string plane(Sketch& sketch) { return sketch.add("IFCPLANE(" + sketch.frame(0, 0, 0) + ")"); }

TEST(EdgeLoops, OfStraightEdgesAreFaces) {
  const StepBody body = box_with(plane);
  EXPECT_TRUE(body.closed());
  EXPECT_NEAR(body.volume_m3(), 6.0, 1e-6);
  EXPECT_TRUE(body.problems.empty());
}

TEST(EdgeLoops, WhatIsNotReadOfThemIsSaid) {
  const StepBody curved =
      box_with([](Sketch& sketch) { return sketch.add("IFCCYLINDRICALSURFACE(" + sketch.frame(0, 0, 0) + ",2.)"); });
  EXPECT_TRUE(curved.closed());
  EXPECT_TRUE(says(curved, "1 curved faces are read as flat between their edges"));
  const StepBody odd = box_with(plane, [](Sketch& sketch) {
    return sketch.add("IFCOFFSETCURVE2D(" + sketch.polyline({{0, 0}, {1, 0}}) + ",1.,.F.)");
  });
  EXPECT_FALSE(odd.closed());
  EXPECT_TRUE(says(odd, "2 faces have edges along curves that are not read, and are left out"));
}

/// A round column of radius 0.5 and 3 m height from one seam, or of two halves; with a bore of radius 0.2 or without.
TEST(EdgeLoops, OfCylindersAreFacesToo) {
  for (const bool halves : {false, true}) {
    Sketch sketch;
    Brep brep(sketch);
    const double r = 0.5;
    std::vector<std::string> circles;
    for (const double z : {0.0, 3.0})
      circles.push_back(sketch.add("IFCCIRCLE(" + sketch.frame(0, 0, z) + "," + Sketch::n(r) + ")"));
    const std::string side = sketch.add("IFCCYLINDRICALSURFACE(" + sketch.frame(0, 0, 0) + "," + Sketch::n(r) + ")");
    const std::string a = brep.vertex({r, 0, 0}), b = brep.vertex({r, 0, 3});
    const std::string seam = brep.line(a, b);
    if (halves) {
      const std::string c = brep.vertex({-r, 0, 0}), d = brep.vertex({-r, 0, 3});
      const std::string other = brep.line(c, d);
      const std::string low1 = brep.edge(a, c, circles[0]), low2 = brep.edge(a, c, circles[0], false);
      const std::string high1 = brep.edge(b, d, circles[1]), high2 = brep.edge(b, d, circles[1], false);
      brep.face(brep.plane(), {brep.loop({{low2, true}, {low1, false}})});
      brep.face(brep.plane(), {brep.loop({{high1, true}, {high2, false}})});
      brep.face(side, {brep.loop({{low1, true}, {other, true}, {high1, false}, {seam, false}})});
      brep.face(side, {brep.loop({{low2, false}, {seam, true}, {high2, true}, {other, false}})});
    } else {
      const std::string low = brep.edge(a, a, circles[0]), high = brep.edge(b, b, circles[1]);
      brep.face(brep.plane(), {brep.loop({{low, false}})});
      brep.face(brep.plane(), {brep.loop({{high, true}})});
      brep.face(side, {brep.loop({{low, true}, {seam, true}, {high, false}, {seam, false}})});
    }
    const StepBody body = body_of(sketch, brep.done());
    EXPECT_TRUE(body.closed()) << halves;
    EXPECT_NEAR(body.volume_m3() / (std::numbers::pi * r * r * 3.0), 1.0, 0.01) << halves;
    EXPECT_TRUE(body.problems.empty()) << halves;
  }
}

TEST(Items, WithoutAnySurfaceAreNamed) {
  Sketch sketch;
  const std::string profile =
      sketch.add("IFCARBITRARYOPENPROFILEDEF(.CURVE.,$," + sketch.polyline({{0, 0}, {1, 0}}) + ")");
  const std::string surface =
      sketch.add("IFCSURFACEOFLINEAREXTRUSION(" + profile + ",$," + sketch.add("IFCDIRECTION((0.,0.,1.))") + ",3.)");
  const StepBody body = body_of(sketch, sketch.box(0, 0, 0, 1, 1, 1) + "," + surface);
  EXPECT_NEAR(body.volume_m3(), 1.0, 1e-6);
  EXPECT_TRUE(says(body, "an item of the class IfcSurfaceOfLinearExtrusion gives no surface"));
}

}  // namespace
}  // namespace plumbline::bim
