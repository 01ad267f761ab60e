// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/digest_log.h"

#include <gtest/gtest.h>

namespace plumbline::scenarios {
namespace {

TEST(DigestLog, HasADigestForTheSensorDataAndForEachMethod) {
  const DigestLog log = {{1, "sim.lidar", 5}, {1, "vgicp/planes", 6}, {1, "vgicp/output", 7}, {2, "sim.lidar", 8}};
  const auto parts = digests_by_part(log);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts.at("sim"), digest_of({log[0], log[3]}));
  EXPECT_EQ(parts.at("vgicp"), digest_of({log[1], log[2]}));
  DigestLog changed = log;
  changed[2].digest = 9;
  EXPECT_EQ(digests_by_part(changed).at("sim"), parts.at("sim"));
  EXPECT_NE(digests_by_part(changed).at("vgicp"), parts.at("vgicp"));
}

}  // namespace
}  // namespace plumbline::scenarios
