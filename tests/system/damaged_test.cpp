// SPDX-License-Identifier: Apache-2.0
// A building with the faults of real files: what was done to it is said, and where a robot can walk then.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

class Damaged : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
    const Outcome made = plumbline({"generate", "corridor", "--rooms", "6", "-o", plan_});
    ASSERT_EQ(made.code, 0) << made.err;
  }

  const Folder folder_;
  const std::string plan_ = folder_ / "corridor.plan.yaml", ifc_ = folder_ / "damaged.ifc",
                    page_ = folder_ / "walk.html";
};

TEST_F(Damaged, SaysWhatWasDoneAndWhatStopsTheRobot) {
  const Outcome done = plumbline({"generate", "damage", plan_, "--fault", "split_level", "--fault", "crossing_wall",
                                  "--fault", "missing_slabs", "--seed", "5", "-o", ifc_});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(done.out, "split_level of room_2, 0.46 m up\ncrossing_wall of door_5\nmissing_slabs\n");

  const Outcome lines = plumbline({"inspect", ifc_, "--walk", page_});
  ASSERT_EQ(lines.code, 0) << lines.err;
  EXPECT_NE(lines.out.find("through 5 of the 7 rooms on ground\n"), std::string::npos) << lines.out;
  EXPECT_NE(lines.out.find("out of reach: room_2: a step of 0.46 m"), std::string::npos) << lines.out;

  const Outcome json = plumbline({"inspect", ifc_, "--walk", page_, "--json", "--force"});
  ASSERT_EQ(json.code, 0) << json.err;
  const nlohmann::json storey = nlohmann::json::parse(json.out)["storeys"].at(0);
  EXPECT_EQ(storey["storey"], "ground");
  EXPECT_EQ(storey["rooms"]["on_storey"], 7);
  EXPECT_EQ(storey["rooms"]["on_route"], 5);
  ASSERT_EQ(storey["out_of_reach"].size(), 2U);
  for (const nlohmann::json& room : storey["out_of_reach"])
    EXPECT_NE(room["why"].get<std::string>().find(room["name"] == "room_2" ? "higher than the 0.2 m" : "0.63 m free"),
              std::string::npos)
        << room;
}

}  // namespace
}  // namespace plumbline::system_tests
