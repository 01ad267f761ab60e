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

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
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
};

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

  /// The next scan, to be answered; null after the last.
  [[nodiscard]] const Scan* next() {
    std::vector<char> payload;
    if (receive(payload) != wire::Type::step) return nullptr;
    const char* at = payload.data();
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
  Scan scan_;
  std::vector<StampedPose> answered_;
};

}  // namespace plumbline_client
