// SPDX-License-Identifier: Apache-2.0
#include "slam/process/answers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "bim/digest/digest.h"
#include "slam/process/child.h"
#include "slam/process/client/plumbline_messages.h"

namespace plumbline::slam {
namespace {

using Bytes = std::vector<std::byte>;

template <class T>
void append(Bytes& bytes, const T& value) {
  const auto* from = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), from, from + sizeof(T));
}

struct Answer {
  wire::Output head;
  std::vector<wire::Hypothesis> hypotheses;
  std::vector<wire::Particle> particles;

  [[nodiscard]] Bytes payload() const {
    Bytes bytes;
    append(bytes, head);
    for (const wire::Hypothesis& hypothesis : hypotheses) append(bytes, hypothesis);
    for (const wire::Particle& particle : particles) append(bytes, particle);
    return bytes;
  }
};

wire::Pose pose_at(double x, double yaw) {
  return {{x, -2.0 * x, 0.1}, {0.0, 0.0, std::sin(yaw / 2), std::cos(yaw / 2)}};
}

Answer good() {
  Answer answer;
  answer.head.stamp_ns = 100;
  answer.head.has_pose = 1;
  answer.head.state = 1;
  answer.head.X_FR = pose_at(1.25, 0.3);
  for (int i = 0; i < 3; ++i) answer.hypotheses.push_back({0.25, pose_at(i, 0.1 * i), {4, 1, 2, 5, 3, 6}});
  for (int i = 0; i < 5; ++i) answer.particles.push_back({1.0F, 2.0F, 0.5F, 0.2F});
  answer.head.hypotheses = 3;
  answer.head.particles = 5;
  return answer;
}

TEST(ProcessAnswers, AreReadAsTheyWereWritten) {
  const Output output = read_output(good().payload(), 100, true);
  EXPECT_EQ(output.stamp, 100);
  EXPECT_EQ(output.state, State::ambiguous);
  ASSERT_TRUE(output.X_FR.has_value());
  EXPECT_EQ(output.X_FR->t, Eigen::Vector3d(1.25, -2.5, 0.1));
  EXPECT_EQ(output.X_FR->q.z(), std::sin(0.15));
  ASSERT_EQ(output.hypotheses.size(), 3U);
  EXPECT_EQ(output.hypotheses[2].X_WR.t.x(), 2.0);
  EXPECT_EQ(output.hypotheses[0].covariance, output.hypotheses[0].covariance.transpose());
  EXPECT_EQ(output.hypotheses[0].covariance(1, 2), 3.0);
  EXPECT_EQ(output.particles.size(), 5U);
}

TEST(ProcessAnswers, WhatIsNoneIsRefused) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const Answer& answer, bool localization = true) {
    EXPECT_THROW((void)read_output(answer.payload(), 100, localization), ProcessFailure);
  };
  refused(good(), false);
  Answer answer = good();
  answer.hypotheses[1].covariance[0] = -0.01;
  refused(answer);
  answer = good();
  answer.hypotheses[1].covariance[1] = 5.0;  // more than the two variances allow
  refused(answer);
  answer = good();
  answer.head.stamp_ns = 99;
  refused(answer);
  answer = good();
  answer.hypotheses[1].mass = -0.1;
  refused(answer);
  answer = good();
  for (wire::Hypothesis& hypothesis : answer.hypotheses) hypothesis.mass = 0.5;
  refused(answer);
  answer = good();
  answer.hypotheses[0].covariance[3] = nan;
  refused(answer);
  answer = good();
  answer.particles[4].yaw = std::numeric_limits<float>::infinity();
  refused(answer);
  answer = good();
  answer.head.X_FR.q[0] = 0.5;
  refused(answer);
  answer = good();
  answer.head.has_pose = 0;
  answer.head.X_FR.t[0] = nan;
  EXPECT_FALSE(read_output(answer.payload(), 100, true).X_FR.has_value()) << "no pose was given";
}

TEST(ProcessAnswers, ReservedBytesAreRefusedWhereThatIsAsked) {
  const wire::Estimate head{4, 0, 0};
  Bytes payload(sizeof head + 4);
  std::memcpy(payload.data(), &head, sizeof head);
  EXPECT_TRUE(read_estimate(payload, false).trajectory.empty());
  EXPECT_THROW((void)read_estimate(payload, false, true), ProcessFailure);
}

// Any bytes are an answer or a ProcessFailure; lengths in them allocate nothing.
TEST(ProcessAnswers, AnyBytesAreReadOrRefused) {
  std::uint64_t drawn = 0;
  const auto random = [&] { return Digest().add(static_cast<std::int64_t>(++drawn)).value() >> 8U; };
  int read = 0;
  for (int i = 0; i < 20000; ++i) {
    Bytes bytes = good().payload();
    const auto changes = 1 + random() % 4;
    for (unsigned k = 0; k < changes; ++k) bytes[random() % bytes.size()] = static_cast<std::byte>(random());
    if (random() % 3 == 0) bytes.resize(random() % (bytes.size() + 50));
    try {
      const Output output = read_output(bytes, 100, true);
      ++read;
      for (const Hypothesis& hypothesis : output.hypotheses) EXPECT_TRUE(hypothesis.covariance.allFinite());
    } catch (const ProcessFailure&) {
    }
    try {
      EXPECT_LE(read_estimate(bytes, false).trajectory.size(), bytes.size());
    } catch (const ProcessFailure&) {
    }
  }
  EXPECT_GT(read, 100);
}

TEST(ProcessAnswers, ATrajectoryGoesForward) {
  const auto estimate = [](std::vector<std::int64_t> stamps) {
    Bytes bytes;
    append(bytes, wire::Estimate{0, stamps.size(), 1});
    for (const std::int64_t stamp : stamps) append(bytes, wire::Odometry{stamp, pose_at(1.0, 0.0)});
    for (const float x : {1.0F, 2.0F, 3.0F}) append(bytes, x);
    return read_estimate(bytes, true);
  };
  EXPECT_EQ(estimate({0, 1, 5}).trajectory.size(), 3U);
  EXPECT_EQ(estimate({0, 1, 5}).frame, Frame::world);
  EXPECT_EQ(estimate({}).map_F.front(), Eigen::Vector3f(1, 2, 3));
  EXPECT_THROW((void)estimate({0, 5, 5}), ProcessFailure);
  EXPECT_EQ(estimate({-5, 0}).trajectory.size(), 2U)
      << "clouds stamped at the start of a sweep, before the first record";
  EXPECT_THROW((void)estimate({-5, -6}), ProcessFailure);
  EXPECT_THROW((void)estimate({-9'000'000'000'000'000'000, 0}), ProcessFailure);
}

}  // namespace
}  // namespace plumbline::slam
