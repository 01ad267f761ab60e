// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/config/visit.h"
#include "bim/model/building_options.h"
#include "sim/lidar/lidar.h"
#include "sim/robot/conditions.h"
#include "sim/robot/leg_odometry.h"

namespace plumbline {

template <>
struct EnumNames<sim::LidarPreset> {
  static constexpr std::array<std::string_view, 4> names = {"ideal", "datasheet", "real", "full"};
};
template <>
struct EnumNames<sim::Footprint> {
  static constexpr std::array<std::string_view, 3> names = {"none", "edges", "everywhere"};
};
template <>
struct EnumNames<slam::LidarModelId> {
  static constexpr std::array<std::string_view, 4> names = {"vlp16", "vlp32c", "hdl32e", "os1_64"};
};
template <>
struct EnumNames<slam::ReturnMode> {
  static constexpr std::array<std::string_view, 3> names = {"strongest", "last", "dual"};
};
template <>
struct EnumNames<sim::OdometryPreset> {
  static constexpr std::array<std::string_view, 3> names = {"ideal", "noisy", "uncorrected"};
};

}  // namespace plumbline

namespace plumbline::scenarios {

enum class Knowledge { unknown, known };
/// Which storeys `rooms: all` means.
enum class RouteStoreys { start, all };
/// Of a start that is drawn: a room with even chances and a place in it, or a place on all of the rooms' floor.
enum class StartDraw { rooms, anywhere };
enum class Hinge { a, b };
enum class Swing { left, right };

/// Where the robot stands at the start: a room (its freest point), a point of a storey, in W, or a place that the seed
/// draws.
struct Start {
  std::optional<StartDraw> random;
  std::optional<std::string> room;
  std::optional<std::string> storey;
  std::optional<Eigen::Vector2d> at;  ///< m, W
  std::optional<double> yaw_deg;      ///< absent: along the first leg of the route
  template <class V>
  void visit(V& v) {
    v("random", random, Field{.doc = "start where the seed says: in a room drawn first, or anywhere in the rooms"});
    v("room", room, Field{.doc = "start at the freest point of this room"});
    v("storey", storey, Field{.doc = "storey of `at` and `random`; the lowest with rooms when not given"});
    v("at", at, Field{.doc = "start here: [x, y] in the plan, m"});
    v("yaw_deg", yaw_deg,
      Field{.doc = "heading, degrees counter-clockwise from x; of a drawn start any", .min = -360.0, .max = 360.0});
  }
};

/// Rooms to walk through, in order; `shuttle` instead walks one room from end to end.
struct Route {
  std::vector<std::string> rooms = {"all"};  ///< "all": every room in reach, nearest first, and back
  RouteStoreys storeys = RouteStoreys::start;
  int loop = 1;  ///< how many times the list is walked
  std::optional<std::string> shuttle;
  int times = 1;
  std::optional<int> random;  ///< so many rooms, drawn by the seed
  template <class V>
  void visit(V& v) {
    v("rooms", rooms, Field{.doc = "rooms to visit in order, also over stairs; or all in reach"});
    v("storeys", storeys, Field{.doc = "of `rooms: all`: the start's storey alone, or all that stairs lead to"});
    v("loop", loop, Field{.doc = "walk the list so many times", .min = 1, .max = 1000});
    v("shuttle", shuttle, Field{.doc = "walk this room from end to end instead"});
    v("times", times, Field{.doc = "how many times there and back", .min = 1, .max = 1000});
    v("random", random,
      Field{.doc = "walk to so many rooms of the start's storey that the seed draws", .min = 1, .max = 1000});
  }
};

/// The sensor. A switch that is not given is as the preset has it.
struct LidarSpec {
  slam::LidarModelId model = slam::LidarModelId::vlp16;
  sim::LidarPreset preset = sim::LidarPreset::real;
  slam::ReturnMode returns = slam::ReturnMode::strongest;
  double rpm = 600.0;
  bool vertical_offsets = true;
  std::optional<bool> range_noise;
  std::optional<bool> unit_bias;
  std::optional<bool> laser_bias;
  std::optional<bool> reflectivity_noise;
  std::optional<bool> dropout;
  std::optional<bool> optics;
  std::optional<sim::Footprint> footprint;
  template <class V>
  void visit(V& v) {
    v("model", model, Field{.doc = "sensor model"});
    v("preset", preset, Field{.doc = "noise: as measured on real units (real) unless said otherwise"});
    v("returns", returns, Field{.doc = "echo of a beam that is sent: the strongest, the last, or both (dual)"});
    v("rpm", rpm, Field{.doc = "turns a minute", .min = 300.0, .max = 1200.0});
    v("vertical_offsets", vertical_offsets, Field{.doc = "the driver knows that lasers do not leave from one point"});
    v("range_noise", range_noise, Field{.doc = "noise of each range; the preset's when not given"});
    v("unit_bias", unit_bias, Field{.doc = "one range bias of the unit; the preset's when not given"});
    v("laser_bias", laser_bias, Field{.doc = "one range bias a laser; the preset's when not given"});
    v("reflectivity_noise", reflectivity_noise,
      Field{.doc = "noise of each reflectivity; the preset's when not given"});
    v("dropout", dropout, Field{.doc = "lost returns; the preset's when not given"});
    v("optics", optics, Field{.doc = "glass and mirrors; off: glass is not there; the preset's when not given"});
    v("footprint", footprint, Field{.doc = "where a beam has a width; the preset's when not given"});
  }
};
/// The preset with the switches that are given.
[[nodiscard]] sim::LidarConfig lidar_config(const LidarSpec& spec);

struct OdometrySpec {
  sim::OdometryPreset preset = sim::OdometryPreset::noisy;
  template <class V>
  void visit(V& v) {
    v("preset", preset, Field{.doc = "noise of encoders, gyro and contacts"});
  }
};

/// What the robot walks on. The LiDAR does not see it, the gait does not know it.
struct GroundSpec {
  double friction = sim::Conditions().friction;
  double uneven_mm = 1e3 * sim::Conditions().uneven_m;
  template <class V>
  void visit(V& v) {
    v("friction", friction,
      Field{.doc = "sliding friction of the feet on the floor and of the robot on all else", .min = 0.05, .max = 1.5});
    v("uneven_mm", uneven_mm,
      Field{.doc = "tilted plates lie on the floor, at most so high, mm; 0: even", .min = 0.0, .max = 40.0});
  }
};

/// Pushes of 0.15 s against the robot, horizontal, of any direction.
struct PushesSpec {
  std::optional<double> min_n;  ///< absent: 0.3 of max_n
  double max_n = sim::PushConfig().max_n;
  double every_s = sim::PushConfig().every_s;
  bool on_stairs = sim::PushConfig().on_stairs;
  template <class V>
  void visit(V& v) {
    v("min_n", min_n, Field{.doc = "least force, N; 0.3 of max_n when not given", .min = 0.0, .max = 1000.0});
    v("max_n", max_n, Field{.doc = "largest force, N; 0: no pushes", .min = 0.0, .max = 1000.0});
    v("every_s", every_s, Field{.doc = "one push in each span of so long, s", .min = 1.0, .max = 3600.0});
    v("on_stairs", on_stairs, Field{.doc = "also on stairs and their landings, where a strong push can end in a fall"});
  }
};
[[nodiscard]] sim::Conditions conditions(const GroundSpec& ground, const PushesSpec& pushes);

/// Someone who walks to and fro; exactly one of rooms and points.
struct PersonSpec {
  std::vector<std::string> rooms;
  std::vector<Eigen::Vector2d> points;  ///< m, W
  double speed_mps = 0.8;
  double radius_m = 0.25;
  double height_m = 1.75;
  template <class V>
  void visit(V& v) {
    v("rooms", rooms, Field{.doc = "rooms to walk through on the storey of the start, in order, and back"});
    v("points", points, Field{.doc = "or points [x, y], m, straight from one to the next, and back"});
    v("speed_mps", speed_mps,
      Field{.doc = "walking speed, m/s; stands while the robot is within 1 m", .min = 0.0, .max = 3.0});
    v("radius_m", radius_m, Field{.doc = "radius of the upright capsule, m", .min = 0.05, .max = 0.5});
    v("height_m", height_m, Field{.doc = "height, m", .min = 1.05, .max = 2.5});
  }
};

/// A door whose leaf turns, shut until then.
struct MovingDoorSpec {
  std::string door;
  Hinge hinge = Hinge::a;
  Swing swing = Swing::left;
  double angle_deg = 90.0;
  double near_m = 1.5;
  double travel_s = 1.0;
  std::vector<double> times_s;
  template <class V>
  void visit(V& v) {
    v("door", door, Field{.doc = "id of a door that is open in the building", .required = true});
    v("hinge", hinge, Field{.doc = "end of the opening with the hinge, along the wall's line from a to b"});
    v("swing", swing, Field{.doc = "side it opens to, seen from a to b"});
    v("angle_deg", angle_deg, Field{.doc = "how far it opens, degrees", .min = 10.0, .max = 175.0});
    v("near_m", near_m, Field{.doc = "opens while the robot is this near to its middle, m", .min = 1.0, .max = 20.0});
    v("travel_s", travel_s, Field{.doc = "time to open or to shut, s", .min = 0.2, .max = 10.0});
    v("times_s", times_s, Field{.doc = "opens, shuts, opens, ... at these times as well, s", .min = 0.0});
  }
};

/// What plan localization is told besides the plan.
struct PriorSpec {
  Knowledge yaw = Knowledge::unknown;
  Knowledge storey = Knowledge::known;
  template <class V>
  void visit(V& v) {
    v("yaw", yaw, Field{.doc = "heading at the start: a compass with slam::Prior's sigma, or nothing"});
    v("storey", storey, Field{.doc = "storey of the start"});
  }
};

/// The robot is lifted, carried off and set down elsewhere, and walks the rooms of its route again from there.
struct KidnapSpec {
  double after_s = 30.0;
  double away_s = 3.0;
  Start to;
  template <class V>
  void visit(V& v) {
    v("after_s", after_s,
      Field{.doc = "lifted after this time, s, or at the end of its route", .min = 1.0, .max = 36000.0});
    v("away_s", away_s, Field{.doc = "in the air, s: no scans, no odometry", .min = 1.0, .max = 60.0});
    v("to", to, Field{.doc = "where it is set down", .required = true});
  }
};

/// A bound on one metric of one method; exactly one of max and min.
struct GateSpec {
  std::string metric;
  std::string method;
  std::optional<double> max;
  std::optional<double> min;
  template <class V>
  void visit(V& v) {
    v("metric", metric, Field{.doc = "name of the metric, as in results.json", .required = true});
    v("method", method, Field{.doc = "method it is asked of", .required = true});
    v("max", max, Field{.doc = "passes when value <= max"});
    v("min", min, Field{.doc = "passes when value >= min"});
  }
};

/// One run, as written by a user (`scenario: 1`).
struct Scenario {
  int version = 1;
  std::string name = "unnamed";
  std::string building;                   ///< path of the plan or IFC file, relative to the scenario's folder
  bim::BuildingOptions building_options;  ///< its keys stand beside `building`
  std::uint64_t seed = 1;
  Start start;
  Route route;
  double speed_mps = 0.6;
  double duration_s = 120.0;
  LidarSpec lidar;
  OdometrySpec odometry;
  GroundSpec ground;
  PushesSpec pushes;
  std::vector<PersonSpec> people;
  std::vector<MovingDoorSpec> moving_doors;
  std::optional<KidnapSpec> kidnap;
  PriorSpec prior;
  std::vector<std::string> methods;  ///< empty: the standard ones of the table
  std::vector<GateSpec> gates;
  template <class V>
  void visit(V& v) {
    v("scenario", version, Field{.doc = "version of this format", .min = 1, .max = 1, .required = true});
    v("name", name, Field{.doc = "name of the run"});
    v("building", building, Field{.doc = "plan or IFC file, relative to this file", .required = true});
    building_options.visit(v);
    v("seed", seed, Field{.doc = "seed of everything random", .min = 0, .max = 9.2e18});
    v("start", start, Field{.doc = "where the robot starts"});
    v("route", route, Field{.doc = "where it walks"});
    v("speed_mps", speed_mps, Field{.doc = "walking speed, m/s", .min = 0.1, .max = 1.2});
    v("duration_s", duration_s, Field{.doc = "longest duration, s", .min = 1.0, .max = 36000.0});
    v("lidar", lidar, Field{.doc = "LiDAR"});
    v("odometry", odometry, Field{.doc = "leg odometry"});
    v("ground", ground, Field{.doc = "what the robot walks on; unseen by the LiDAR, unknown to the gait"});
    v("pushes", pushes, Field{.doc = "pushes of 0.15 s against the robot, horizontal, from any side"});
    v("people", people, Field{.doc = "people who walk about; the LiDAR sees them, no plan knows them"});
    v("moving_doors", moving_doors, Field{.doc = "doors that open and shut; the LiDAR sees their leaves"});
    v("kidnap", kidnap, Field{.doc = "once on its way the robot is carried off; people and doors then begin anew"});
    v("prior", prior, Field{.doc = "what plan localization is told"});
    v("methods", methods, Field{.doc = "methods to run"});
    v("gates", gates, Field{.doc = "bounds that decide pass or fail"});
  }
};

/// A scenario with the tree it was read from, whose marks say where each value stands.
struct ScenarioText {
  Scenario scenario;
  Tree tree;
};

/// Reads and checks the form of a scenario (keys, types, ranges, gates); what needs the building is checked by
/// resolve(). Throws InputError.
[[nodiscard]] ScenarioText read_scenario(std::string_view text, const std::string& file);
/// Names of scenarios and sweeps become folders, which the system lets have 255 letters.
inline constexpr std::size_t longest_name = 100;
/// Throws InputError at the mark.
void check_name(const std::string& name, const Mark& mark);
[[nodiscard]] std::string write_scenario(const Scenario& scenario);
/// Mark of a nested value ("route", "rooms"); of the innermost that exists where some are missing.
[[nodiscard]] Mark mark_at(const Tree& tree, std::initializer_list<std::string_view> path);
/// Switches of the sensors and the building that differ from the defaults, as "lidar.preset: ideal", in the order of
/// the fields; then how many people and moving doors there are.
[[nodiscard]] std::vector<std::string> off_defaults(const Scenario& scenario);

}  // namespace plumbline::scenarios

namespace plumbline {

template <>
struct EnumNames<scenarios::RouteStoreys> {
  static constexpr std::array<std::string_view, 2> names = {"start", "all"};
};
template <>
struct EnumNames<scenarios::StartDraw> {
  static constexpr std::array<std::string_view, 2> names = {"rooms", "anywhere"};
};
template <>
struct EnumNames<scenarios::Hinge> {
  static constexpr std::array<std::string_view, 2> names = {"a", "b"};
};
template <>
struct EnumNames<scenarios::Swing> {
  static constexpr std::array<std::string_view, 2> names = {"left", "right"};
};
template <>
struct EnumNames<scenarios::Knowledge> {
  static constexpr std::array<std::string_view, 2> names = {"unknown", "known"};
};

}  // namespace plumbline
