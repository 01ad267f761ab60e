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

#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
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
#include <type_traits>
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

/// Values in the memory of someone else.
template <class T>
class View {
 public:
  View() = default;
  View(const T* from, std::size_t count) : from_(from), count_(count) {}
  [[nodiscard]] const T* begin() const { return from_; }
  [[nodiscard]] const T* end() const { return from_ + count_; }
  [[nodiscard]] const T* data() const { return from_; }
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] bool empty() const { return count_ == 0; }
  const T& operator[](std::size_t i) const { return from_[i]; }

 private:
  const T* from_ = nullptr;
  std::size_t count_ = 0;
};

/// One turn of the LiDAR and what was measured since the scan before. There until the next one is asked for: copy what
/// you keep. Of the slots of the scan, index column * rings + ring, there are range, point, reflectivity and time.
struct Scan {
  std::int64_t stamp_ns = 0;
  int rings = 0, columns = 0;
  View<wire::Imu> imu;
  View<wire::Odometry> odometry;
  View<double> range_m;  ///< 0: no return
  View<wire::Point> point_L;
  View<float> reflectivity;      ///< 0 to 255
  View<std::int32_t> offset_ns;  ///< relative to the scan's stamp, <= 0

  /// What came back, in the LiDAR's frame at each point's own time; Point is made of x, y, z (Eigen::Vector3d), or has
  /// them as members of type double (std::array<double, 3>).
  template <class Point>
  [[nodiscard]] std::vector<Point> points() const {
    std::vector<Point> out;
    for (std::size_t i = 0; i < range_m.size(); ++i)
      if (range_m[i] > 0.0) out.push_back(made<Point>(point_L[i]));
    return out;
  }
  /// Of these points, 0 at the first to 1 at the last; empty where all have one time, since there is nothing to deskew.
  [[nodiscard]] std::vector<double> relative_times() const {
    std::int32_t first = 0, last = std::numeric_limits<std::int32_t>::min();
    for (std::size_t i = 0; i < range_m.size(); ++i)
      if (range_m[i] > 0.0) {
        first = std::min(first, offset_ns[i]);
        last = std::max(last, offset_ns[i]);
      }
    std::vector<double> out;
    if (first >= last) return out;
    for (std::size_t i = 0; i < range_m.size(); ++i)
      if (range_m[i] > 0.0) out.push_back((double(offset_ns[i]) - first) / (double(last) - first));
    return out;
  }

 private:
  template <class Point>
  [[nodiscard]] static Point made(const wire::Point& p) {
    if constexpr (std::is_constructible_v<Point, double, double, double>)
      return Point(p.x, p.y, p.z);
    else
      return Point{p.x, p.y, p.z};
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
    wire::Head head;
    if (!receive(head) || head.type != static_cast<std::uint16_t>(wire::Type::hello))
      throw std::runtime_error("plumbline did not greet");
    hello_.assign(payload_.begin(), payload_.end());
    map_memory();
    const std::string answer = "{\"protocol\": " + std::to_string(wire::protocol) +
                               ", \"shared_memory\": " + (memory_ != nullptr ? "true}" : "false}");
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
    wire::Head head;
    if (!receive(head) || head.type != static_cast<std::uint16_t>(wire::Type::step)) return nullptr;
    const char* at = head.memory == 0 ? payload_.data() : memory_ + (head.memory - 1) * (memory_bytes_ / 2);
    const char* end = at + head.size;
    const wire::Step& step = *view<wire::Step>(at, end, 1).data();
    scan_.stamp_ns = step.stamp_ns;
    scan_.rings = step.rings;
    scan_.columns = step.rings == 0 ? 0 : static_cast<int>(step.slots / step.rings);
    scan_.imu = view<wire::Imu>(at, end, step.imus);
    scan_.odometry = view<wire::Odometry>(at, end, step.odometries);
    scan_.range_m = view<double>(at, end, step.slots);
    scan_.point_L = view<wire::Point>(at, end, step.slots);
    scan_.reflectivity = view<float>(at, end, step.slots);
    scan_.offset_ns = view<std::int32_t>(at, end, step.slots);
    return &scan_;
  }

  void answer(const Pose& X_FR, int state = 2) {
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
    if (hypotheses.size() > std::numeric_limits<std::uint16_t>::max())
      throw std::invalid_argument("an answer has at most 65535 hypotheses");
    if (output.has_pose != 0) answered_.push_back({scan_.stamp_ns, output.X_FR});
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

  /// The next values of a payload, of which nothing is copied.
  template <class T>
  static View<T> view(const char*& from, const char* end, std::size_t count) {
    if (count * sizeof(T) > static_cast<std::size_t>(end - from)) throw std::runtime_error("a message is cut off");
    const View<T> values(reinterpret_cast<const T*>(from), count);
    from += count * sizeof(T);
    return values;
  }
  template <class T>
  static void put(std::vector<char>& to, const T* from, std::size_t count) {
    const char* bytes = reinterpret_cast<const char*>(from);
    to.insert(to.end(), bytes, bytes + count * sizeof(T));
  }

  /// Memory that plumbline shares spares both sides the copies; without it scans come through the stream.
  void map_memory() {
    const std::string key = "\"shared_memory_bytes\":";
    const std::size_t at = hello_.find(key);
    if (at == std::string::npos) return;
    constexpr int file = 4;
    struct stat status {};
    const auto bytes = static_cast<std::size_t>(std::strtoull(hello_.c_str() + at + key.size(), nullptr, 10));
    if (::fstat(file, &status) != 0 || static_cast<std::size_t>(status.st_size) != bytes) return;
    void* mapped = ::mmap(nullptr, bytes, PROT_READ, MAP_SHARED, file, 0);
    if (mapped == MAP_FAILED) return;
    memory_ = static_cast<const char*>(mapped);
    memory_bytes_ = bytes;
  }

  /// False: plumbline is gone. The payload comes into payload_, unless it stands in the memory.
  bool receive(wire::Head& head) {
    if (!read(&head, sizeof head)) return false;
    if (head.magic != wire::magic) throw std::runtime_error("this is no message of plumbline");
    if (head.memory != 0) return true;
    payload_.resize(head.size);
    return read(payload_.data(), payload_.size());
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
    // In one piece: two would wake plumbline twice.
    const wire::Head head{wire::magic, static_cast<std::uint16_t>(type), 0, size};
    sent_.clear();
    put(sent_, &head, 1);
    put(sent_, static_cast<const char*>(bytes), size);
    write(sent_.data(), sent_.size());
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
  std::vector<char> payload_;  ///< of the last message; its memory is used again
  std::vector<char> sent_;     ///< likewise
  const char* memory_ = nullptr;
  std::size_t memory_bytes_ = 0;
  Scan scan_;
  std::vector<StampedPose> answered_;
};

}  // namespace plumbline_client
