// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/scenario_schema.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "scenarios/spec/resolve.h"

namespace plumbline::scenarios {
namespace {

std::string source() {
  const char* folder = std::getenv("PLUMBLINE_SOURCE");
  return folder == nullptr ? "." : folder;
}

TEST(ScenarioSchema, TheExamplesResolveBesideTheLibrary) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "plumbline_schema";
  std::filesystem::create_directories(folder);
  std::filesystem::copy(source() + "/scenarios/library", folder / "library",
                        std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing);
  for (const std::string& example : scenario_examples()) {
    std::ofstream(folder / "example.yaml") << example;
    EXPECT_GE(resolve((folder / "example.yaml").string(), {}).world.waypoints.size(), 2U) << example;
  }
  std::filesystem::remove_all(folder);
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

TEST(ScenarioSchema, ThePageIsTheOneThatIsKept) {
  EXPECT_EQ(read_text_file(source() + "/scenarios/SCENARIO.md"), scenario_page())
      << "write it with: plumbline scenarios --schema > scenarios/SCENARIO.md";
}

}  // namespace
}  // namespace plumbline::scenarios
