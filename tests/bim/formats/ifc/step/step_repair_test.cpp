// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_repair.h"

#include <gtest/gtest.h>

#include "tests/bim/formats/ifc/step/step_body.h"

namespace plumbline::bim {
namespace {

/// A tetrahedron of 1/6 m^3 as triangles, with what stands between the points and the indices.
StepBody tetrahedron(const std::string& schema, const std::string& tags, const std::string& between) {
  Sketch sketch;
  sketch.schema = schema;
  const std::string points =
      sketch.add("IFCCARTESIANPOINTLIST3D(((0.,0.,0.),(1.,0.,0.),(0.,1.,0.),(0.,0.,1.))" + tags + ")");
  return body_of(
      sketch, sketch.add("IFCTRIANGULATEDFACESET(" + points + "," + between + ",((1,3,2),(1,2,4),(2,3,4),(3,1,4)),$)"));
}

TEST(Tessellations, OfIfc4x3AreRead) {
  const std::string normals = "((0.,0.,1.),(1.,0.,0.),(0.,1.,0.),(0.,0.,1.))";
  for (const std::string& between : std::vector<std::string>{".T.,$", "$,$", ".T.," + normals, "$," + normals}) {
    for (const char* tags : {",$", ",('a','b','c','d')", ""}) {
      const StepBody body = tetrahedron("IFC4X3_ADD2", tags, between);
      EXPECT_TRUE(body.closed()) << between << tags;
      EXPECT_NEAR(body.volume_m3(), 1.0 / 6.0, 1e-9) << between << tags;
    }
  }
  EXPECT_NEAR(tetrahedron("IFC4X3", "", "$,.T.").volume_m3(), 1.0 / 6.0, 1e-9) << "in the order of IFC4";
  EXPECT_NEAR(tetrahedron("IFC4", "", "$,.T.").volume_m3(), 1.0 / 6.0, 1e-9);
}

TEST(Tessellations, CurvesThroughTaggedPointsAreRead) {
  Sketch sketch;
  sketch.schema = "IFC4X3_ADD2";
  const std::string points = sketch.add("IFCCARTESIANPOINTLIST2D(((0.,0.),(2.,0.),(2.,1.),(0.,1.),(0.,0.)),$)");
  const std::string curve = sketch.add("IFCINDEXEDPOLYCURVE(" + points + ",$,.F.)");
  const std::string profile = sketch.add("IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$," + curve + ")");
  EXPECT_NEAR(body_of(sketch, sketch.extruded(profile, 0, 3)).volume_m3(), 6.0, 1e-9);
}

}  // namespace
}  // namespace plumbline::bim
