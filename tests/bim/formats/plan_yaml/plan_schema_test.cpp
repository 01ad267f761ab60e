// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/plan_schema.h"

#include <gtest/gtest.h>

#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/mesh/mesh.h"
#include "tests/schema_example.h"

namespace plumbline::bim {
namespace {

TEST(PlanSchema, TheExampleIsASoundPlan) {
  const PlanWithDeviations site = read_plan_with_deviations(plan_example(), "example");
  for (const Building* building : {&site.as_planned, &site.as_built.building})
    for (const MeshElement& element : build_mesh(*building).elements) EXPECT_TRUE(element.closed) << element.id;
  EXPECT_EQ(site.as_planned.stairs.size(), 1U);
}

TEST(PlanSchema, EveryKeyHasAMeaningAndAnExample) {
  const Tree example = read_yaml(plan_example(), "example");
  std::size_t keys = 0;
  for (const SchemaSection& section : plan_schema())
    for (const SchemaField& field : section.fields) {
      const std::string where = section.name + " " + section.variant + " " + field.key;
      EXPECT_FALSE(example_of({example}, section, field).empty()) << where;
      EXPECT_FALSE(field.meaning.empty()) << where;
      ++keys;
    }
  EXPECT_GT(keys, 90U);
}

TEST(PlanSchema, EveryDeviationHasItsOwnKeys) {
  std::size_t ops = 0;
  for (const SchemaSection& section : plan_schema()) {
    if (section.name != "deviations") continue;
    ++ops;
    EXPECT_EQ(section.fields[0].key, "op");
    if (section.variant != "op: tilt_wall") continue;
    EXPECT_EQ(section.fields[2].range, "-10 to 10");
  }
  EXPECT_EQ(ops, 9U);
}

}  // namespace
}  // namespace plumbline::bim
