// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/range_image.h"

#include <gtest/gtest.h>

#include <limits>

namespace plumbline::scenarios {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();
const double full = beam_cost(1.0, 5.0);  // of a residual at the cap

TEST(BeamEvidence, OfWhatStandsIsTheDifferenceOfCosts) {
  for (const double seen : {1.0, 2.99, 3.0, 3.02, 5.0, none})
    for (const double own : {3.0, 4.0, none})
      for (const double other : {2.0, 3.01, none})
        EXPECT_EQ(beam_evidence(seen, own, other, false), beam_cost(seen, other) - beam_cost(seen, own));
}

TEST(BeamEvidence, OfABeamCutShortAtBothPosesIsNone) {
  EXPECT_EQ(beam_evidence(2.0, 3.0, 4.0, true), 0.0);
  EXPECT_EQ(beam_evidence(2.0, 3.0, none, true), 0.0);
}

TEST(BeamEvidence, FurnitureBesideTheOwnWallDoesNotSpeakForThePose) {
  EXPECT_GT(beam_evidence(2.97, 3.0, 4.0, false), 0.0);
  EXPECT_EQ(beam_evidence(2.97, 3.0, 4.0, true), 0.0);
  EXPECT_EQ(beam_evidence(3.0, 3.0, 4.0, true), 0.0);
}

TEST(BeamEvidence, FurnitureAtAFaceOfTheOtherPoseSpeaksForThat) {
  EXPECT_DOUBLE_EQ(beam_evidence(2.0, 3.0, 2.0, true), -full);
  EXPECT_DOUBLE_EQ(beam_evidence(2.0, 3.0, 2.0, false), -full);
}

TEST(BeamEvidence, AFaceOfTheOtherPoseThatABeamPassesSpeaksAgainstIt) {
  EXPECT_DOUBLE_EQ(beam_evidence(2.0, 3.0, 1.0, true), full);  // whatever stands behind
  EXPECT_DOUBLE_EQ(beam_evidence(3.0, 3.0, 1.0, true), full);
  EXPECT_DOUBLE_EQ(beam_evidence(3.0, 3.0, 1.0, false), full);
  EXPECT_DOUBLE_EQ(beam_evidence(4.0, 3.0, 2.0, true), 0.0);  // as one of its own does
}

TEST(BeamEvidence, OfPosesThatPredictAlikeIsNoneWhateverStandsThere) {
  for (const double seen : {0.5, 2.0, 2.95, 3.0, 3.05, 6.0})
    for (const double predicted : {3.0, none}) EXPECT_EQ(beam_evidence(seen, predicted, predicted, true), 0.0);
}

}  // namespace
}  // namespace plumbline::scenarios
