// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_facets.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/bim/formats/ifc/step/step_body.h"

namespace plumbline::bim {
namespace {

/// A slab of 6 x 2 x 1 m with shafts of 1 m^2 through it, as a polygonal face set; `permuted` by way of an index list.
std::string slab_with_shafts(Sketch& sketch, const std::vector<Eigen::Vector2d>& shafts, bool permuted) {
  std::vector<Polygon2> outlines = {{{0, 0}, {6, 0}, {6, 2}, {0, 2}}};
  for (const Eigen::Vector2d& at : shafts)
    outlines.push_back({at, at + Eigen::Vector2d(1, 0), at + Eigen::Vector2d(1, 1), at + Eigen::Vector2d(0, 1)});
  std::string points, order;
  const std::size_t count = 8 * outlines.size();
  for (const Polygon2& outline : outlines)
    for (const double z : {0.0, 1.0})
      for (const Eigen::Vector2d& p : outline)
        points += (points.empty() ? "((" : ",(") + Sketch::n(p.x()) + "," + Sketch::n(p.y()) + "," + Sketch::n(z) + ")";
  for (std::size_t i = 0; i < count; ++i) order += (i > 0 ? "," : "(") + std::to_string(count - i);
  const auto at = [&](std::size_t i) { return std::to_string(permuted ? count - i : i + 1); };
  const auto loop = [&](std::size_t first, bool turned) {
    std::string indices;
    for (std::size_t k = 0; k < 4; ++k) indices += (k > 0 ? "," : "(") + at(first + (turned ? 3 - k : k));
    return indices + ")";
  };
  std::string holes_below, holes_above, faces;
  const auto face = [&](const std::string& text) { faces += (faces.empty() ? "(" : ",") + sketch.add(text); };
  for (std::size_t o = 0; o < outlines.size(); ++o) {
    const std::size_t first = 8 * o;
    if (o > 0) holes_below += (o > 1 ? "," : "(") + loop(first, false);
    if (o > 0) holes_above += (o > 1 ? "," : "(") + loop(first + 4, true);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t a = first + k, b = first + (k + 1) % 4;
      const auto& [p, q] = o == 0 ? std::pair(a, b) : std::pair(b, a);
      face("IFCINDEXEDPOLYGONALFACE((" + at(p) + "," + at(q) + "," + at(q + 4) + "," + at(p + 4) + "))");
    }
  }
  face("IFCINDEXEDPOLYGONALFACEWITHVOIDS(" + loop(0, true) + "," + holes_below + "))");
  face("IFCINDEXEDPOLYGONALFACEWITHVOIDS(" + loop(4, false) + "," + holes_above + "))");
  const std::string list = sketch.add("IFCCARTESIANPOINTLIST3D(" + points + "))");
  return sketch.add("IFCPOLYGONALFACESET(" + list + ",.T.," + faces + ")," + (permuted ? order + ")" : "$") + ")");
}

TEST(Facets, WithSeveralHolesKeepThem) {
  const std::vector<std::vector<Eigen::Vector2d>> all = {{{1, 0.5}},
                                                         {{1, 0.5}, {4, 0.5}},
                                                         {{4, 0.5}, {1, 0.5}},
                                                         {{2.5, 0.5}, {0.5, 0.5}, {4.5, 0.5}},
                                                         {{0.5, 0.5}, {1.75, 0.5}, {3, 0.5}, {4.5, 0.5}}};
  for (const auto& shafts : all) {
    for (const bool permuted : {false, true}) {
      Sketch sketch;
      const StepBody body = body_of(sketch, slab_with_shafts(sketch, shafts, permuted));
      EXPECT_TRUE(body.closed()) << shafts.size();
      EXPECT_NEAR(body.volume_m3(), 12.0 - static_cast<double>(shafts.size()), 1e-6) << shafts.size();
      EXPECT_TRUE(body.problems.empty());
    }
  }
}

}  // namespace
}  // namespace plumbline::bim
