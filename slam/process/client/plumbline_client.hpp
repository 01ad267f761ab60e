// SPDX-License-Identifier: Apache-2.0
#pragma once

// Runs an estimator as a process of plumbline. Two headers, no library:
//
//   #include "plumbline_client.hpp"
//   int main() {
//     plumbline_client::Client client;
//     while (const plumbline_client::Scan* scan = client.next())
//       client.answer(my_pose(*scan));   // the robot in a frame of your own
//     client.finish();                    // the poses given stand; or finish(trajectory, points)
//   }
//
// Then: plumbline run quickstart.yaml --method mine=./my_slam

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "plumbline_messages.h"

namespace plumbline_client {

namespace wire = plumbline::slam::wire;

/// Position in m and quaternion x, y, z, w.
using Pose = wire::Pose;
struct StampedPose {
  std::int64_t stamp_ns = 0;
  Pose pose;
};

/// One turn of the LiDAR and what was measured since the scan before.
struct Scan {
  std::int64_t stamp_ns = 0;
  int rings = 0, columns = 0;
  std::vector<wire::Imu> imu;
  std::vector<wire::Odometry> odometry;
  std::vector<wire::Return> returns;  ///< index column * rings + ring; range 0: no return

  /// What came back, in the LiDAR's frame at each point's own time; Point is made of x, y, z (Eigen::Vector3d).
  template <class Point>
  [[nodiscard]] std::vector<Point> points() const {
    std::vector<Point> out;
    for (const wire::Return& r : returns)
      if (r.range_m > 0.0) out.push_back(Point(r.point_L[0], r.point_L[1], r.point_L[2]));
    return out;
  }
  /// Of these points, 0 at the first to 1 at the last; empty where all have one time, since there is nothing to deskew.
  [[nodiscard]] std::vector<double> relative_times() const {
    std::int32_t first = 0, last = std::numeric_limits<std::int32_t>::min();
    for (const wire::Return& r : returns)
      if (r.range_m > 0.0) {
        first = std::min(first, r.offset_ns);
        last = std::max(last, r.offset_ns);
      }
    std::vector<double> out;
    if (first >= last) return out;
    for (const wire::Return& r : returns)
      if (r.range_m > 0.0) out.push_back((double(r.offset_ns) - first) / (double(last) - first));
    return out;
  }
};

/// X_AC = X_AB * X_BC.
[[nodiscard]] inline Pose compose(const Pose& a, const Pose& b) {
  const auto turned = [](const double(&q)[4], const double(&v)[3], double(&out)[3]) {
    const double u[3] = {2 * (q[1] * v[2] - q[2] * v[1]), 2 * (q[2] * v[0] - q[0] * v[2]),
                         2 * (q[0] * v[1] - q[1] * v[0])};
    out[0] = v[0] + q[3] * u[0] + q[1] * u[2] - q[2] * u[1];
    out[1] = v[1] + q[3] * u[1] + q[2] * u[0] - q[0] * u[2];
    out[2] = v[2] + q[3] * u[2] + q[0] * u[1] - q[1] * u[0];
  };
  Pose out;
  turned(a.q, b.t, out.t);
  for (int i = 0; i < 3; ++i) out.t[i] += a.t[i];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    out.q[i] = a.q[3] * b.q[i] + b.q[3] * a.q[i] + a.q[j] * b.q[k] - a.q[k] * b.q[j];
  }
  out.q[3] = a.q[3] * b.q[3] - a.q[0] * b.q[0] - a.q[1] * b.q[1] - a.q[2] * b.q[2];
  const double norm = std::sqrt(out.q[0] * out.q[0] + out.q[1] * out.q[1] + out.q[2] * out.q[2] + out.q[3] * out.q[3]);
  for (double& value : out.q) value /= norm;
  return out;
}

[[nodiscard]] inline Pose inverse(const Pose& a) {
  const Pose turn{{0, 0, 0}, {-a.q[0], -a.q[1], -a.q[2], a.q[3]}};
  return compose(turn, Pose{{-a.t[0], -a.t[1], -a.t[2]}, {0, 0, 0, 1}});
}

class Client {
 public:
  /// Greets; throws std::runtime_error where plumbline did not start this program.
  Client() {
    const char* descriptor = std::getenv("PLUMBLINE_FD");
    if (descriptor == nullptr) throw std::runtime_error("give this command to plumbline as --method NAME=COMMAND");
    stream_ = std::atoi(descriptor);
    std::vector<char> payload;
    if (receive(payload) != wire::Type::hello) throw std::runtime_error("plumbline did not greet");
    hello_.assign(payload.begin(), payload.end());
    const std::string answer = "{\"protocol\": 1}";
    send(wire::Type::hello_ok, answer.data(), answer.size());
  }

  /// JSON: seed, X_RL (the LiDAR's mount), sensor_height_m, has_odometry, plan, prior.
  [[nodiscard]] const std::string& hello() const { return hello_; }

  /// X_RL: the LiDAR in the robot.
  [[nodiscard]] Pose mount() const {
    Pose X_RL;
    const std::size_t at = hello_.find("\"X_RL\":");
    if (at == std::string::npos) throw std::runtime_error("plumbline did not say where the LiDAR is mounted");
    const char* from = hello_.c_str() + at + 7;
    for (int i = 0; i < 7; ++i) {
      while (*from == ' ' || *from == '[' || *from == ',') ++from;
      char* end = nullptr;
      (i < 3 ? X_RL.t[i] : X_RL.q[i - 3]) = std::strtod(from, &end);
      from = end;
    }
    return X_RL;
  }
  /// The robot's pose, from that of the LiDAR in the frame of its first scan, as LiDAR odometry gives it.
  [[nodiscard]] Pose robot_pose(const Pose& lidar) const {
    const Pose X_RL = mount();
    return compose(compose(X_RL, lidar), inverse(X_RL));
  }

  /// The next scan, to be answered; null after the last.
  [[nodiscard]] const Scan* next() {
    if (receive(payload_) != wire::Type::step) return nullptr;
    const char* at = payload_.data();
    wire::Step step;
    take(at, &step, 1);
    scan_.stamp_ns = step.stamp_ns;
    scan_.rings = step.rings;
    scan_.columns = step.columns;
    scan_.imu.resize(step.imus);
    scan_.odometry.resize(step.odometries);
    scan_.returns.resize(step.returns);
    take(at, scan_.imu.data(), scan_.imu.size());
    take(at, scan_.odometry.data(), scan_.odometry.size());
    take(at, scan_.returns.data(), scan_.returns.size());
    return &scan_;
  }

  void answer(const Pose& X_FR, int state = 2) {
    answered_.push_back({scan_.stamp_ns, X_FR});
    wire::Output output;
    output.has_pose = 1;
    output.X_FR = X_FR;
    answer(output, state, {});
  }
  /// Where no pose is known.
  void answer_without_pose(int state = 0) {
    wire::Output output;
    output.X_FR.q[3] = 1.0;
    answer(output, state, {});
  }
  /// Of a localization in a plan.
  void answer(wire::Output output, int state, const std::vector<wire::Hypothesis>& hypotheses) {
    output.stamp_ns = scan_.stamp_ns;
    output.state = static_cast<std::uint8_t>(state);
    output.hypotheses = static_cast<std::uint16_t>(hypotheses.size());
    std::vector<char> payload;
    put(payload, &output, 1);
    put(payload, hypotheses.data(), hypotheses.size());
    send(wire::Type::output, payload.data(), payload.size());
  }

  /// The poses given scan by scan are the trajectory.
  void finish() { finish(std::exchange(answered_, {}), {}); }
  /// points: x, y, z one after the other.
  void finish(const std::vector<StampedPose>& trajectory, const std::vector<float>& points) {
    const wire::Estimate head{0, trajectory.size(), points.size() / 3};
    std::vector<char> payload;
    put(payload, &head, 1);
    put(payload, trajectory.data(), trajectory.size());
    put(payload, points.data(), 3 * head.points);
    send(wire::Type::estimate, payload.data(), payload.size());
  }

 private:
  static_assert(sizeof(StampedPose) == sizeof(wire::Odometry));

  template <class T>
  static void take(const char*& from, T* to, std::size_t count) {
    if (count > 0) std::memcpy(to, from, count * sizeof(T));
    from += count * sizeof(T);
  }
  template <class T>
  static void put(std::vector<char>& to, const T* from, std::size_t count) {
    const char* bytes = reinterpret_cast<const char*>(from);
    to.insert(to.end(), bytes, bytes + count * sizeof(T));
  }

  /// fail: plumbline is gone.
  wire::Type receive(std::vector<char>& payload) {
    wire::Head head;
    if (!read(&head, sizeof head)) return wire::Type::fail;
    if (head.magic != wire::magic) throw std::runtime_error("this is no message of plumbline");
    payload.resize(head.size);
    return read(payload.data(), payload.size()) ? static_cast<wire::Type>(head.type) : wire::Type::fail;
  }
  bool read(void* bytes, std::size_t size) {
    char* at = static_cast<char*>(bytes);
    while (size > 0) {
      const ssize_t got = ::recv(stream_, at, size, 0);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return false;
      at += got;
      size -= static_cast<std::size_t>(got);
    }
    return true;
  }
  void send(wire::Type type, const void* bytes, std::size_t size) {
    const wire::Head head{wire::magic, static_cast<std::uint16_t>(type), 0, size};
    write(&head, sizeof head);
    write(bytes, size);
  }
  void write(const void* bytes, std::size_t size) {
    const char* at = static_cast<const char*>(bytes);
    while (size > 0) {
      const ssize_t sent = ::send(stream_, at, size, MSG_NOSIGNAL);
      if (sent < 0 && errno == EINTR) continue;
      if (sent <= 0) throw std::runtime_error("plumbline is gone");
      at += sent;
      size -= static_cast<std::size_t>(sent);
    }
  }

  int stream_ = -1;
  std::string hello_;
  std::vector<char> payload_;  ///< of the last scan; its memory is used again
  Scan scan_;
  std::vector<StampedPose> answered_;
};

}  // namespace plumbline_client
