// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// What travels between plumbline and a method that is a process of its own: little endian, in this layout without
/// gaps. One message each way at a time; docs/guide/your_method.md.
namespace plumbline::slam::wire {

inline constexpr std::uint32_t magic = 0x31424C50;  ///< "PLB1"
inline constexpr int protocol = 2;
/// Most bytes of an answer's payload.
inline constexpr std::uint64_t max_payload = 256ULL << 20U;

enum class Type : std::uint16_t {
  hello = 1,
  step = 2,
  finish = 3,
  hello_ok = 0x81,
  output = 0x82,
  estimate = 0x83,
  log = 0x84,
  fail = 0x8F,
};

struct Head {
  std::uint32_t magic = wire::magic;
  std::uint16_t type = 0;
  std::uint16_t memory = 0;  ///< where the payload is: 0 it follows; 1, 2: in this half of the shared memory
  std::uint64_t size = 0;    ///< of the payload
};
static_assert(sizeof(Head) == 16);

// HELLO names shared_memory_bytes where there is some: file descriptor 4, to be mapped for reading. A process whose
// HELLO_OK says "shared_memory": true gets the payloads of STEP there, in each half in turn: a scan stays until the one
// after it is answered.

/// Begins a STEP; then imus, odometries, and of each slot of the scan (index column * rings + ring) first all ranges
/// (double, m; 0: no return), then all points (three doubles, in L), all reflectivities (float) and all times relative
/// to the scan's stamp (int32, ns, <= 0).
struct Step {
  std::int64_t stamp_ns = 0;
  std::uint32_t imus = 0;
  std::uint32_t odometries = 0;
  std::uint32_t slots = 0;
  std::uint16_t rings = 0;
  std::uint16_t columns = 0;  ///< slots / rings, or the largest number where that is more
  std::uint64_t reserved = 0;
};
static_assert(sizeof(Step) == 32);

/// In R: rad/s; m/s², specific force ((0, 0, 9.81) at rest and level).
struct Imu {
  std::int64_t stamp_ns = 0;
  double angular_velocity[3] = {};
  double linear_acceleration[3] = {};
};
static_assert(sizeof(Imu) == 56);

/// Position, m, then the unit quaternion x, y, z, w.
struct Pose {
  double t[3] = {};
  double q[4] = {};
};
static_assert(sizeof(Pose) == 56);

struct Odometry {
  std::int64_t stamp_ns = 0;
  Pose X_OR;
};
static_assert(sizeof(Odometry) == 64);

struct Point {
  double x = 0.0, y = 0.0, z = 0.0;
};
static_assert(sizeof(Point) == 24);

/// Begins an OUTPUT; then hypotheses and particles.
struct Output {
  std::int64_t stamp_ns = 0;  ///< of the scan that is answered
  std::uint8_t has_pose = 0;
  std::uint8_t state = 2;  ///< 0 SEARCHING, 1 AMBIGUOUS, 2 CONVERGED, 3 LOST
  std::uint16_t hypotheses = 0;
  std::uint32_t particles = 0;
  Pose X_FR;
};
static_assert(sizeof(Output) == 72);

struct Hypothesis {
  double mass = 0.0;
  Pose X_WR;
  double covariance[6] = {};  ///< xx, xy, xyaw, yy, yyaw, yawyaw; m², m rad, rad²
};
static_assert(sizeof(Hypothesis) == 112);

/// x, y in W, m; yaw, rad.
struct Particle {
  float x = 0.0F, y = 0.0F, yaw = 0.0F, weight = 0.0F;
};
static_assert(sizeof(Particle) == 16);

/// Begins an ESTIMATE; then reserved bytes, poses of the trajectory (as Odometry), and points of the map (three floats
/// each).
struct Estimate {
  std::uint64_t json_bytes = 0;  ///< reserved for planes, rooms and floors: 0
  std::uint64_t poses = 0;
  std::uint64_t points = 0;
};
static_assert(sizeof(Estimate) == 24);

}  // namespace plumbline::slam::wire
