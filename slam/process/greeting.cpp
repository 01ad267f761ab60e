// SPDX-License-Identifier: Apache-2.0
#include "slam/process/greeting.h"

#include <cstdlib>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "slam/process/child.h"
#include "slam/process/client/plumbline_messages.h"
#include "slam/process/client_folder.h"

namespace plumbline::slam {

namespace {

Tree point(const Eigen::Vector2d& p) { return Tree::list().push(p.x()).push(p.y()); }

Tree pose(const Pose& X) {
  Tree list = Tree::list();
  for (const double value : {X.t.x(), X.t.y(), X.t.z(), X.q.x(), X.q.y(), X.q.z(), X.q.w()}) list.push(value);
  return list;
}

Tree polygon(const Polygon2& corners) {
  Tree list = Tree::list();
  for (const Eigen::Vector2d& p : corners) list.push(point(p));
  return list;
}

Tree face(const bim::PlanFace& face) {
  Tree holes = Tree::list();
  for (const bim::FaceHole& hole : face.holes)
    holes.push(Tree::list().push(hole.s0).push(hole.s1).push(hole.z0).push(hole.z1));
  return Tree::map()
      .set("id", face.id)
      .set("storey", face.storey)
      .set("p0", point(face.p0))
      .set("p1", point(face.p1))
      .set("z0", face.z0)
      .set("z1", face.z1)
      .set("openings", std::move(holes));
}

Tree plan_tree(const bim::Plan& plan) {
  Tree storeys = Tree::list(), faces = Tree::list(), rooms = Tree::list(), solids = Tree::list();
  for (const bim::PlanStorey& storey : plan.storeys)
    storeys.push(
        Tree::map().set("name", storey.name).set("elevation_m", storey.elevation_m).set("height_m", storey.height_m));
  for (const bim::PlanFace& one : plan.faces) faces.push(face(one));
  for (const bim::PlanRoom& room : plan.rooms)
    rooms.push(Tree::map().set("name", room.name).set("storey", room.storey).set("polygon", polygon(room.polygon)));
  for (const bim::PlanSolid& solid : plan.solids)
    solids.push(Tree::map()
                    .set("storey", solid.storey)
                    .set("polygon", polygon(solid.outline))
                    .set("z0", solid.z0)
                    .set("z1", solid.z1)
                    .set("furniture", solid.may_have_moved));
  return Tree::map()
      .set("storeys", std::move(storeys))
      .set("faces", std::move(faces))
      .set("rooms", std::move(rooms))
      .set("solids", std::move(solids));
}

Tree prior_tree(const Prior& prior) {
  return Tree::map()
      .set("yaw_W", prior.yaw_W ? Tree(*prior.yaw_W) : Tree())
      .set("yaw_sigma", prior.yaw_sigma)
      .set("storey", prior.storey ? Tree(*prior.storey) : Tree());
}

}  // namespace

std::string greeting(const ProcessCommand& command, const MethodInput& input, std::size_t shared_memory) {
  const bool with_plan = command.needs_plan && input.plan;
  Tree hello = Tree::map()
                   .set("protocol", wire::protocol)
                   .set("method", command.name)
                   .set("seed", std::to_string(input.seed))
                   .set("X_RL", pose(input.calibration.X_RL))
                   .set("sensor_height_m", input.calibration.sensor_height_m)
                   .set("has_odometry", input.has_odometry)
                   .set("prior", with_plan ? prior_tree(input.prior) : Tree())
                   .set("plan", with_plan ? plan_tree(*input.plan) : Tree());
  if (shared_memory > 0) hello.set("shared_memory_bytes", static_cast<std::int64_t>(shared_memory));
  return write_json(hello, 0);
}

GreetingAnswer read_greeting(const std::string& text) {
  try {
    const Tree answer = read_json(text, "HELLO_OK");
    const Tree* protocol = answer.is_map() ? answer.find("protocol") : nullptr;
    if (protocol == nullptr || protocol->as_int() != wire::protocol)
      throw ProcessFailure("speaks another protocol; " + std::to_string(wire::protocol) + " is spoken here");
    const Tree* shared = answer.find("shared_memory");
    return {shared != nullptr && shared->as_bool()};
  } catch (const InputError& error) {
    throw ProcessFailure(std::string("answered the greeting with what is no JSON of HELLO_OK: ") + error.what());
  }
}

std::vector<std::string> environment_of(const MethodInput& input) {
  std::vector<std::string> variables = {"PLUMBLINE_FD=3",
                                        "PLUMBLINE_SEED=" + std::to_string(input.seed),
                                        "OMP_NUM_THREADS=1",
                                        "OPENBLAS_NUM_THREADS=1",
                                        "MKL_NUM_THREADS=1",
                                        "PYTHONHASHSEED=0",
                                        "PYTHONUNBUFFERED=1",
                                        "LC_ALL=C.UTF-8",
                                        "TZ=UTC"};
  // Memory of a scan stays with the process until the next one, as settle_process() sets it in this program.
  variables.emplace_back("MALLOC_MMAP_THRESHOLD_=33554432");
  variables.emplace_back("MALLOC_TRIM_THRESHOLD_=134217728");
  if (const std::string clients = client_folder(); !clients.empty()) {
    const char* before = std::getenv("PYTHONPATH");
    variables.push_back("PYTHONPATH=" + clients + (before != nullptr && *before != 0 ? ":" + std::string(before) : ""));
  }
  return variables;
}

}  // namespace plumbline::slam
