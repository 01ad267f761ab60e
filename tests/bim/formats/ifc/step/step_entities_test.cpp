// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_entities.h"

#include <gtest/gtest.h>

#include "bim/errors.h"

namespace plumbline::bim {
namespace {

constexpr const char* text =
    "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n"
    "#7 = IFCWALL ('it''s; #1', $, *, (1., -2.5E3), .T., #3,\n IFCTEXT('a'), ());\n"
    "#3=IFCPOINT((1,2));\n"
    "ENDSEC;\nEND-ISO-10303-21;\n";

TEST(StepEntities, TakesAttributesApart) {
  const StepEntities entities(text, "t.ifc");
  ASSERT_EQ(entities.all().size(), 2u);
  EXPECT_EQ(entities.all()[0].number, 3);
  EXPECT_EQ(entities.entity(7).type, "IFCWALL");
  const StepValue wall = entities.attributes(7);
  ASSERT_EQ(wall.as_list().size(), 8u);
  EXPECT_EQ(wall.at(0).as_text(), "it's; #1");
  EXPECT_EQ(wall.at(1).kind, StepValue::Kind::none);
  EXPECT_EQ(wall.at(2).kind, StepValue::Kind::none);
  EXPECT_EQ(wall.at(3).at(1).as_number(), -2500.0);
  EXPECT_TRUE(wall.at(4).as_flag());
  EXPECT_EQ(entities.attributes(wall.at(5), "IFCPOINT").at(0).at(1).as_integer(), 2);
  EXPECT_EQ(wall.at(6).as_typed().as_text(), "a");
  EXPECT_TRUE(wall.at(7).as_list().empty());
}

TEST(StepEntities, WhatIsNotThereOrOfAnotherKindIsAnInputError) {
  const StepEntities entities(text, "t.ifc");
  EXPECT_THROW((void)entities.entity(8), InputError);
  const StepValue wall = entities.attributes(7);
  EXPECT_THROW((void)wall.at(8), InputError);
  EXPECT_THROW((void)wall.at(0).as_number(), InputError);
  EXPECT_THROW((void)wall.at(1).as_list(), InputError);
  EXPECT_THROW((void)wall.at(4).as_reference(), InputError);
  EXPECT_THROW((void)entities.attributes(wall.at(5), "IFCWALL"), InputError);
  try {
    (void)wall.at(0).as_flag();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).substr(0, 8), "t.ifc:5:");
  }
}

TEST(StepEntities, MalformedAttributesAreInputErrors) {
  for (const char* attributes :
       {"(", "(1", "('a)", "(.T)", "(#)", "(1,)", "(IFCTEXT)", "(IFCTEXT('a','b'))", "(1e999)", "(-)"}) {
    const std::string file = std::string("DATA;\n#1=IFCWALL") + attributes + ";\n";
    const StepEntities entities(file, "t.ifc");
    EXPECT_THROW((void)entities.attributes(1), InputError) << attributes;
  }
}

}  // namespace
}  // namespace plumbline::bim
