// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bim/config/visit.h"
#include "bim/furniture/alter.h"
#include "bim/furniture/furnish.h"
#include "bim/model/building_options.h"
#include "scenarios/spec/faults.h"
#include "scenarios/spec/lidar_spec.h"
#include "scenarios/spec/process_spec.h"
#include "scenarios/spec/sensors.h"
#include "scenarios/spec/told_furniture.h"
#include "sim/robot/conditions.h"
#include "sim/robot/leg_odometry.h"

namespace plumbline::scenarios {

enum class Knowledge { unknown, known };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(Knowledge) { return {"unknown", "known"}; }
/// Which storeys `rooms: all` means.
enum class RouteStoreys { start, all };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(RouteStoreys) { return {"start", "all"}; }
/// Of a start that is drawn: a room with even chances and a place in it; or a place on all of the rooms' floor, or
/// often in a doorway or at a stair.
enum class RandomStart { rooms, anywhere };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(RandomStart) { return {"rooms", "anywhere"}; }
enum class Hinge { a, b };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(Hinge) { return {"a", "b"}; }
enum class Swing { left, right };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(Swing) { return {"left", "right"}; }

/// Where the robot stands at the start: a room (its freest point), a point of a storey, in W, or a place that the seed
/// draws.
struct Start {
  std::optional<RandomStart> random;
  std::optional<std::string> room;
  std::optional<std::string> storey;
  std::optional<Eigen::Vector2d> at;
  std::optional<double> yaw_deg;
  template <class V>
  void visit(V& v) {
    v("random", random,
      Field{.doc = "start drawn from the seed: a place in a room drawn first; or anywhere in the rooms, every fourth "
                   "time in a doorway or at the foot or head of a stair"});
    v("room", room, Field{.doc = "id of the room in which to start, at the point of greatest clearance"});
    v("storey", storey, Field{.doc = "id of the storey of `at` and `random`; the lowest with rooms when not given"});
    v("at", at, Field{.doc = "start position [x, y] in the plan", .unit = "m", .min = -1e4, .max = 1e4});
    v("yaw_deg", yaw_deg,
      Field{
          .doc =
              "heading, counter-clockwise from x; along the first leg of the route when not given, random for `random`",
          .min = -360.0,
          .max = 360.0});
  }
};

/// Rooms to walk through, in order; `shuttle` instead walks one room from end to end.
struct Route {
  std::vector<std::string> rooms = {"all"};
  RouteStoreys storeys = RouteStoreys::start;
  int loop = 1;
  std::optional<std::string> shuttle;
  int times = 1;
  std::optional<int> random;
  template <class V>
  void visit(V& v) {
    v("rooms", rooms,
      Field{.doc = "ids of the rooms to visit in order, also over stairs; all: every room in reach, nearest first, and "
                   "back"});
    v("storeys", storeys, Field{.doc = "storeys of `rooms: all`: only that of the start, or all that stairs lead to"});
    v("loop", loop, plain_field("number of times the list of rooms is walked", {.min = 1, .max = 1000}));
    v("shuttle", shuttle, Field{.doc = "id of a room to walk from end to end instead"});
    v("times", times, plain_field("number of walks there and back in the room of `shuttle`", {.min = 1, .max = 1000}));
    v("random", random,
      plain_field("number of rooms to visit on the start's storey, drawn from the seed", {.min = 1, .max = 1000}));
  }
};

struct OdometrySpec {
  sim::OdometryPreset preset = sim::OdometryPreset::noisy;
  template <class V>
  void visit(V& v) {
    v("preset", preset, Field{.doc = "preset of the noise of encoders, gyro and contacts"});
  }
};

/// What the robot walks on. The LiDAR does not see it, the gait does not know it.
struct GroundSpec {
  double friction = sim::Conditions().friction;
  double uneven_mm = 1e3 * sim::Conditions().terrain_noise_m;
  template <class V>
  void visit(V& v) {
    v("friction", friction,
      plain_field("sliding friction coefficient of the robot on all surfaces", {.min = 0.05, .max = 1.5}));
    v("uneven_mm", uneven_mm,
      Field{.doc = "greatest height of tilted plates on the floor; 0: an even floor", .min = 0.0, .max = 40.0});
  }
};

/// Pushes of 0.15 s against the robot, horizontal, of any direction.
struct PushesSpec {
  std::optional<double> min_n;
  double max_n = sim::PushConfig().max_n;
  double every_s = sim::PushConfig().every_s;
  bool on_stairs = sim::PushConfig().on_stairs;
  template <class V>
  void visit(V& v) {
    v("min_n", min_n, Field{.doc = "least force; 0.3 of max_n when not given", .min = 0.0, .max = 1000.0});
    v("max_n", max_n, Field{.doc = "greatest force; 0: no pushes", .min = 0.0, .max = 1000.0});
    v("every_s", every_s, Field{.doc = "length of the time spans, with one push in each", .min = 1.0, .max = 3600.0});
    v("on_stairs", on_stairs,
      Field{.doc = "whether pushes also come on stairs and their landings, where a strong one can end in a fall"});
  }
};
[[nodiscard]] sim::Conditions conditions(const GroundSpec& ground, const PushesSpec& pushes);

/// Someone who walks to and fro; exactly one of rooms and points.
struct PersonSpec {
  std::vector<std::string> rooms;
  std::vector<Eigen::Vector2d> points;
  double speed_mps = 0.8;
  double radius_m = 0.25;
  double height_m = 1.75;
  template <class V>
  void visit(V& v) {
    v("rooms", rooms, Field{.doc = "ids of the rooms to walk through on the start's storey, in order, and back"});
    v("points", points,
      Field{.doc = "points [x, y] in the plan to walk through in straight lines, and back, instead of `rooms`",
            .unit = "m",
            .min = -1e4,
            .max = 1e4});
    v("speed_mps", speed_mps,
      Field{.doc = "walking speed; a person stands while the robot is within 1 m", .min = 0.0, .max = 3.0});
    v("radius_m", radius_m, Field{.doc = "radius of the vertical capsule", .min = 0.05, .max = 0.5});
    v("height_m", height_m, Field{.doc = "height of the vertical capsule", .min = 1.05, .max = 2.5});
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
    v("swing", swing, Field{.doc = "side to which the leaf opens, seen from a to b"});
    v("angle_deg", angle_deg, Field{.doc = "opening angle", .min = 10.0, .max = 175.0});
    v("near_m", near_m,
      Field{.doc = "distance of the robot from the door's middle below which the door opens", .min = 1.0, .max = 20.0});
    v("travel_s", travel_s, Field{.doc = "time the leaf takes to open or to close", .min = 0.2, .max = 10.0});
    v("times_s", times_s,
      Field{.doc = "times in ascending order at which the door also opens, closes, opens and so on",
            .min = 0.0,
            .max = 36000.0});
  }
};

/// What plan localization knows besides the plan.
struct PriorSpec {
  Knowledge yaw = Knowledge::unknown;
  Knowledge storey = Knowledge::known;
  template <class V>
  void visit(V& v) {
    v("yaw", yaw,
      Field{.doc = "heading at the start; known: measured by a compass, with the prior's standard deviation"});
    v("storey", storey, Field{.doc = "storey at the start"});
  }
};

/// What methods with a plan are told besides what was built.
struct PlanSpec {
  ToldFurniture furniture = ToldFurniture::as_planned;
  template <class V>
  void visit(V& v) {
    v("furniture", furniture, Field{.doc = "whether the plan that methods get has the furniture as planned, or none"});
  }
};

/// How what may have moved was built.
struct WorldSpec {
  bim::FurnitureWorld furniture = bim::FurnitureWorld::as_planned;
  template <class V>
  void visit(V& v) {
    v("furniture", furniture,
      Field{.doc =
                "furniture as built: as planned; moved by up to 0.5 m and 20 degrees; swapped, a third of it gone or "
                "of another shape; more, as much again that is not planned; unknown, another layout"});
  }
};

/// The robot is lifted and set down elsewhere, and walks the rooms of its route again from there.
struct KidnapSpec {
  double after_s = 30.0;
  double away_s = 3.0;
  Start to;
  template <class V>
  void visit(V& v) {
    v("after_s", after_s,
      Field{.doc = "time at which the robot is lifted, or at the end of its route if that is earlier",
            .min = 1.0,
            .max = 36000.0});
    v("away_s", away_s, Field{.doc = "time in the air, without scans and odometry", .min = 1.0, .max = 60.0});
    v("to", to,
      Field{.doc = "where the robot is set down; it then walks the rooms of its route again", .required = true});
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
    v("method", method, Field{.doc = "name of the method", .required = true});
    v("max", max,
      Field{.doc = "upper bound of the metric; exactly one of max and min",
            .unit = "of the metric",
            .min = -1e9,
            .max = 1e9});
    v("min", min,
      Field{.doc = "lower bound of the metric; exactly one of max and min",
            .unit = "of the metric",
            .min = -1e9,
            .max = 1e9});
  }
};

/// Throws InputError at the gate as written where it has not exactly one bound, or is of no metric.
void check_gate(const GateSpec& gate, const Tree& written);

/// One run, as written by a user (`scenario: 1`).
struct Scenario {
  int version = 1;
  std::string name = "unnamed";
  std::string building;
  bim::BuildingOptions building_options;
  std::optional<bim::FurnishOptions> furnish;
  PlanSpec plan;
  WorldSpec world;
  std::uint64_t seed = 1;
  Start start;
  Route route;
  double speed_mps = 0.6;
  double duration_s = 120.0;
  LidarSpec lidar;
  OdometrySpec odometry;
  std::optional<FaultsSpec> faults;
  GroundSpec ground;
  PushesSpec pushes;
  std::vector<PersonSpec> people;
  std::vector<MovingDoorSpec> moving_doors;
  std::optional<KidnapSpec> kidnap;
  PriorSpec prior;
  std::vector<std::string> methods;
  std::vector<ProcessSpec> processes;
  std::vector<Sensors> sensors;
  std::vector<GateSpec> gates;
  template <class V>
  void visit(V& v) {
    v("scenario", version, plain_field("version of the format", {.min = 1, .max = 1, .required = true}));
    v("name", name, Field{.doc = "name of the run"});
    v("building", building,
      Field{.doc = "path of the plan, IFC file or other building, relative to the scenario's folder",
            .required = true});
    building_options.visit(v);
    v("furnish", furnish, Field{.doc = "generated furniture in every room, as planned and as built alike"});
    v("plan", plan, Field{.doc = "what methods that localize in the plan are told of it"});
    v("world", world, Field{.doc = "how the furniture as built differs from the plan; the seed decides"});
    v("seed", seed, plain_field("seed of all random numbers", {.min = 0, .max = 9.2e18}));
    v("start", start, Field{.doc = "where the robot starts"});
    v("route", route, Field{.doc = "where the robot walks"});
    v("speed_mps", speed_mps, Field{.doc = "walking speed", .min = 0.1, .max = 1.2});
    v("duration_s", duration_s, Field{.doc = "greatest duration of the run", .min = 1.0, .max = 36000.0});
    v("lidar", lidar, Field{.doc = "LiDAR"});
    v("odometry", odometry, Field{.doc = "leg odometry"});
    v("faults", faults,
      Field{.doc = "errors of clocks, mount, IMU and feet that no method is told of; none when not given"});
    v("ground", ground, Field{.doc = "ground the robot walks on; neither the LiDAR nor the gait controller knows it"});
    v("pushes", pushes, Field{.doc = "horizontal pushes of 0.15 s against the robot, from any direction"});
    v("people", people, Field{.doc = "people who walk about; the LiDAR sees them, no plan has them"});
    v("moving_doors", moving_doors, Field{.doc = "doors that open and close; the LiDAR sees their leaves"});
    v("kidnap", kidnap,
      Field{.doc = "once on its way the robot is lifted and set down elsewhere; people and doors then start again"});
    v("prior", prior, Field{.doc = "what plan localization knows at the start beside the plan"});
    v("methods", methods,
      Field{.doc = "names of the methods to run, `NAME.lidar` for one with LiDAR alone; the default ones when none is "
                   "named; `{name: NAME, command: [PROGRAM, ARGUMENT]}` for a process of your own, see `processes`"});
    v("processes", processes,
      Field{.doc = "methods that are programs of the user's; each is run where `methods` names it, and may stand there "
                   "in place of its name"});
    v("sensors", sensors,
      Field{.doc =
                "what methods get: all records, or lidar, the scans without odometry and IMU; with both, each method "
                "that can runs twice, the second time as `NAME.lidar`; all when not given"});
    v("gates", gates, Field{.doc = "bounds on metrics that decide whether the run passes"});
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
