// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/outside_gate.h"

#include <gtest/gtest.h>

#include "bim/errors.h"

namespace plumbline::scenarios {
namespace {

TEST(OutsideGate, ReadsAMetricASignAndANumber) {
  const GateSpec at_most = parse_gate("ate_rmse_m<=0.05");
  EXPECT_EQ(at_most.metric, "ate_rmse_m");
  EXPECT_EQ(at_most.max, 0.05);
  EXPECT_FALSE(at_most.min);
  const GateSpec at_least = parse_gate(" rooms.recall  >= 1e-1 ");
  EXPECT_EQ(at_least.metric, "rooms.recall");
  EXPECT_EQ(at_least.min, 0.1);
  EXPECT_FALSE(at_least.max);
}

TEST(OutsideGate, RefusesWhatIsNoBound) {
  for (const char* text : {"", "ate_rmse_m", "ate_rmse_m<0.05", "ate_rmse_m=0.05", "<=0.05", "a<=", "a<=x", "a<=1m",
                           "a<=nan", "a<=inf", "a<=1e10", "a<=-2e9"})
    EXPECT_THROW(static_cast<void>(parse_gate(text)), InputError) << text;
}

}  // namespace
}  // namespace plumbline::scenarios
