// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_units.h"

#include <gtest/gtest.h>

#include "tests/bim/formats/ifc/step/step_body.h"

namespace plumbline::bim {
namespace {

/// Length of the unit of a file in a unit of that name, so many times an SI unit.
double unit_m(const std::string& name, const std::string& value, const std::string& prefix) {
  const Sketch sketch;
  std::string text = sketch.text();
  const std::string metre = "IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.)";
  text.replace(text.find(metre), metre.size(), "IFCCONVERSIONBASEDUNIT(#9003,.LENGTHUNIT.,'" + name + "',#9001)");
  text.insert(text.find("ENDSEC;\nEND-ISO"), "#9001=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(" + value + "),#9002);\n" +
                                                 "#9002=IFCSIUNIT(*,.LENGTHUNIT.," + prefix + ",.METRE.);\n" +
                                                 "#9003=IFCDIMENSIONALEXPONENTS(1,0,0,0,0,0,0);\n");
  return read_model(text).unit_m;
}

TEST(Units, OfConversionTakeThePrefixWithThem) {
  EXPECT_NEAR(unit_m("FOOT_US", "304.8006096012", ".MILLI."), 0.3048006096012, 1e-12);
  EXPECT_NEAR(unit_m("FOOT", "304.8", ".MILLI."), 0.3048, 1e-12);
  EXPECT_NEAR(unit_m("YARD", "91.44", ".CENTI."), 0.9144, 1e-12);
  EXPECT_NEAR(unit_m("INCH", "25.4", ".MILLI."), 0.0254, 1e-12);
  EXPECT_NEAR(unit_m("INCH", "0.0254", "$"), 0.0254, 1e-12);
  EXPECT_NEAR(unit_m("FURLONG", "201.168", "$"), 201.168, 1e-9);
}

TEST(Units, AreThoseOfTheProject) {
  Sketch sketch;
  sketch.add("IFCSIUNIT(*,.LENGTHUNIT.,.KILO.,.METRE.)");
  const std::string text = sketch.text();
  const StepEntities entities(text, "s.ifc");
  EXPECT_EQ(assigned_unit(entities, "LENGTHUNIT"), 1.0);
  EXPECT_FALSE(assigned_unit(entities, "PLANEANGLEUNIT").has_value());
}

}  // namespace
}  // namespace plumbline::bim
