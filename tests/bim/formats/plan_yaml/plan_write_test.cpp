// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/plan_yaml/plan_write.h"

#include <gtest/gtest.h>

#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "tests/bim/formats/plan_yaml/plan_error.h"
#include "tests/bim/generators/option_sweep.h"

namespace plumbline::bim {
namespace {

PlanFile read_back(const std::string& text) { return from_tree<PlanFile>(read_yaml(text, "written.yaml")); }

TEST(PlanWrite, ReadsBackEqual) {
  for (std::uint64_t k = 0; k < 20; ++k) {
    const std::optional<SweepCase> c = sweep_case(k);
    if (!c) continue;
    const std::string text = write_plan(c->generated.plan, "first line\nsecond line");
    EXPECT_EQ(text.rfind("# first line\n# second line\nplan: 1\n", 0), 0U);
    EXPECT_EQ(write_json(to_tree(read_back(text))), write_json(to_tree(c->generated.plan))) << c->what;
    EXPECT_EQ(write_plan(read_back(text), "first line\nsecond line"), text);
  }
}

TEST(PlanWrite, QuotesWhatYamlWouldMistake) {
  PlanFile plan = sweep_case(0)->generated.plan;
  plan.name = "a: strange, [name] #1";
  EXPECT_EQ(read_back(write_plan(plan)).name, plan.name);
}

TEST(PlanSymmetry, NamesOnlyWhatThePlanHolds) {
  PlanFile plan = sweep_case(0)->generated.plan;
  ASSERT_TRUE(plan.symmetry.has_value());
  EXPECT_EQ(error_of(write_plan(plan)), "no error");
  PlanFile rooms = plan;
  rooms.symmetry->rooms_alike = {{"nowhere", "corridor"}};
  EXPECT_NE(error_of(write_plan(rooms)).find("there is no room 'nowhere'"), std::string::npos);
  PlanFile storeys = plan;
  storeys.symmetry->group = {{180.0, {0.0, 0.0}, {"cellar"}, {"ground"}}};
  EXPECT_NE(error_of(write_plan(storeys)).find("there is no storey 'cellar'"), std::string::npos);
  storeys.symmetry->group = {{180.0, {0.0, 0.0}, {"ground"}, {"ground", "ground"}}};
  EXPECT_NE(error_of(write_plan(storeys)).find("as many storeys"), std::string::npos);
  PlanFile feature = plan;
  feature.symmetry->feature = PlanFeatureEntry{FeatureKind::niche, 0.1, "w", "ground", "nowhere", {0.0, 0.0}, {}};
  EXPECT_NE(error_of(write_plan(feature)).find("there is no room 'nowhere'"), std::string::npos);
}

}  // namespace
}  // namespace plumbline::bim
