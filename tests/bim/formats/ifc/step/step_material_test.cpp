// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_material.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/bim/formats/ifc/step/step_body.h"

namespace plumbline::bim {
namespace {

/// What `definition` writes and returns, associated with a plate, or with the type of it.
std::string material_read(const std::function<std::string(Sketch&)>& definition, bool by_type = false,
                          bool of_its_own = false) {
  Sketch sketch;
  const std::string plate = sketch.element("IFCPLATE", sketch.shape(sketch.box(0, 0, 0, 2, 0.02, 2)), "$,$");
  const std::string defined = definition(sketch);
  std::string bearer = plate;
  if (by_type) {
    bearer = sketch.rooted("IFCPLATETYPE", "'t',$,$,$,$,$,$,.CURTAIN_PANEL.");
    sketch.rooted("IFCRELDEFINESBYTYPE", "$,$,(" + plate + ")," + bearer);
  }
  sketch.rooted("IFCRELASSOCIATESMATERIAL", "$,$,(" + bearer + ")," + defined);
  if (of_its_own)
    sketch.rooted("IFCRELASSOCIATESMATERIAL", "$,$,(" + plate + ")," + sketch.add("IFCMATERIAL('own',$,$)"));
  const StepModel model = read_model(sketch.text());
  EXPECT_EQ(model.products.size(), 1u);
  return model.products.front().material;
}

std::string named(Sketch& sketch, const std::string& name) { return sketch.add("IFCMATERIAL('" + name + "',$,$)"); }

TEST(Materials, OfConstituentsAreThatOfTheLargestShare) {
  const auto set = [](Sketch& sketch, const std::string& frame, const std::string& pane) {
    const std::string a =
        sketch.add("IFCMATERIALCONSTITUENT('Framing',$," + named(sketch, "Alu") + "," + frame + ",$)");
    const std::string b = sketch.add("IFCMATERIALCONSTITUENT('Pane',$," + named(sketch, "Clear") + "," + pane + ",$)");
    return sketch.add("IFCMATERIALCONSTITUENTSET('s',$,(" + a + "," + b + "))");
  };
  EXPECT_EQ(material_read([&](Sketch& sketch) { return set(sketch, "0.1", "0.9"); }), "Clear");
  EXPECT_EQ(material_read([&](Sketch& sketch) { return set(sketch, "0.9", "0.1"); }), "Alu");
  EXPECT_EQ(material_read([&](Sketch& sketch) { return set(sketch, "$", "$"); }), "Alu") << "the first";
}

TEST(Materials, OfProfilesAndListsAreTheOneThatTheyName) {
  const auto list = [](const std::string& second) {
    return material_read([&](Sketch& sketch) {
      return sketch.add("IFCMATERIALLIST((" + named(sketch, "Glass") + "," + named(sketch, second) + "))");
    });
  };
  EXPECT_EQ(list("Glass"), "Glass");
  EXPECT_EQ(list("Alu"), "") << "which of them is where is not known";
  const auto profiles = [](Sketch& sketch) {
    const std::string shape = sketch.add("IFCRECTANGLEPROFILEDEF(.AREA.,$,$,2.,1.)");
    const std::string profile =
        sketch.add("IFCMATERIALPROFILE('p',$," + named(sketch, "Steel") + "," + shape + ",$,$)");
    return sketch.add("IFCMATERIALPROFILESET('s',$,(" + profile + "),$)");
  };
  EXPECT_EQ(material_read(profiles), "Steel");
  EXPECT_EQ(material_read(
                [&](Sketch& sketch) { return sketch.add("IFCMATERIALPROFILESETUSAGE(" + profiles(sketch) + ",$,$)"); }),
            "Steel");
  EXPECT_EQ(material_read([](Sketch& sketch) {
              return sketch.add("IFCMATERIALLAYER(" + named(sketch, "Plaster") + ",0.01,$,$,$,$,$)");
            }),
            "Plaster");
}

TEST(Materials, OfATypeAreThoseOfItsElementsWithoutTheirOwn) {
  const auto glass = [](Sketch& sketch) { return named(sketch, "Glass"); };
  EXPECT_EQ(material_read(glass, true), "Glass");
  EXPECT_EQ(material_read(glass, true, true), "own");
}

}  // namespace
}  // namespace plumbline::bim
