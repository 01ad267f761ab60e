// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/scenario_schema.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenarios/spec/resolve.h"
#include "tests/data.h"
#include "tests/folder.h"
#include "tests/schema_example.h"

namespace plumbline::scenarios {
namespace {

TEST(ScenarioSchema, TheExamplesResolveBesideTheLibrary) {
  const Folder folder;
  std::filesystem::copy(project_file("scenarios/library"), folder / "library",
                        std::filesystem::copy_options::recursive);
  for (const std::string& example : scenario_examples()) {
    std::ofstream(folder / "example.yaml") << example;
    EXPECT_GE(resolve(folder / "example.yaml", {}).world.waypoints.size(), 2U) << example;
  }
}

TEST(ScenarioSchema, EveryKeyHasAMeaningAndAnExample) {
  std::vector<Tree> examples;
  for (const std::string& text : scenario_examples()) examples.push_back(read_yaml(text, "example"));
  for (const SchemaSection& section : scenario_schema())
    for (const SchemaField& field : section.fields) {
      EXPECT_FALSE(field.meaning.empty()) << field.key;
      if (field.type == "list of entry") continue;
      EXPECT_FALSE(example_of(examples, section, field).empty()) << section.name << " " << field.key;
    }
}

}  // namespace
}  // namespace plumbline::scenarios
