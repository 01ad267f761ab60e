// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "bim/config/schema.h"
#include "scenarios/hunt/hunt_schema.h"
#include "scenarios/spec/scenario_schema.h"
#include "slam/methods.h"

namespace plumbline {
namespace {

bool is_number(const SchemaField& field) { return field.type == "number" || field.type == "integer"; }

void expect_described(const std::vector<SchemaSection>& sections, std::string_view owner) {
  for (const SchemaSection& section : sections)
    for (const SchemaField& field : section.fields) {
      const std::string key = std::string(owner) + ": " + section.name + " " + section.variant + " " + field.key;
      EXPECT_FALSE(field.meaning.empty()) << key << " has no sentence";
      EXPECT_FALSE(field.meaning.ends_with('.')) << key << " ends with a full stop";
      if (!is_number(field)) continue;
      EXPECT_FALSE(field.unit.empty()) << key << " has no unit";
      EXPECT_FALSE(field.range.empty()) << key << " has no range";
    }
}

TEST(Keys, EveryKeyOfEveryMethodHasASentenceAUnitAndARange) {
  for (const slam::MethodRow& row : slam::methods())
    if (row.config_schema) expect_described(row.config_schema(), row.name);
}

TEST(Keys, EveryKeyOfScenariosHasASentenceAUnitAndARange) {
  expect_described(scenarios::scenario_schema(), "scenario");
}

TEST(Keys, EveryKeyOfHuntsHasASentenceAUnitAndARange) { expect_described(scenarios::hunt_schema(), "hunt"); }

TEST(Keys, EveryMethodHasAShortListOfBasicKeys) {
  for (const slam::MethodRow& row : slam::methods()) {
    if (!row.config_schema) continue;
    std::size_t basic = 0;
    const std::vector<SchemaSection> sections = row.config_schema();
    for (const SchemaField& field : sections.front().fields) basic += field.basic ? 1 : 0;
    EXPECT_GE(basic, 1U) << row.name;
    EXPECT_LE(basic, 16U) << row.name;
  }
}

TEST(Keys, TheBasicKeysAtTheirDefaultsAreAValidFile) {
  for (const slam::MethodRow& row : slam::methods()) {
    if (!row.config_schema) continue;
    const std::string text = schema_yaml(basic_fields(row.config_schema().front().fields));
    EXPECT_EQ(write_yaml(row.configure(read_yaml(text, "c.yaml"))), write_yaml(row.configure({}))) << row.name;
  }
}

}  // namespace
}  // namespace plumbline
