// SPDX-License-Identifier: Apache-2.0
#include "sim/robot/model.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "bim/errors.h"

namespace plumbline::sim {

namespace {

/// MuJoCo's own handlers exit the process and write a log with the wall clock into the working directory.
void throw_error(const char* message) { throw EnvironmentError(std::string("MuJoCo: ") + message); }
/// Warnings are counted in mjData::warning, which the robot checks after each step.
void ignore_warning(const char*) {}

void install_handlers() {
  static const bool installed = [] {
    mju_user_error = throw_error;
    mju_user_warning = ignore_warning;
    return true;
  }();
  static_cast<void>(installed);
}

struct VfsDeleter {
  void operator()(mjVFS* vfs) const {
    mj_deleteVFS(vfs);
    delete vfs;
  }
};

}  // namespace

void ModelDeleter::operator()(mjModel_* model) const { mj_deleteModel(model); }
void DataDeleter::operator()(mjData_* data) const { mj_deleteData(data); }

ModelPtr load_model(const std::string& xml) {
  install_handlers();
  const std::unique_ptr<mjVFS, VfsDeleter> vfs(new mjVFS);
  mj_defaultVFS(vfs.get());
  if (mj_makeEmptyFileVFS(vfs.get(), "robot.xml", static_cast<int>(xml.size())) != 0)
    throw EnvironmentError("MuJoCo: cannot make a file in memory");
  std::copy(xml.begin(), xml.end(), static_cast<char*>(vfs->filedata[0]));
  std::array<char, 1000> error{};
  ModelPtr model(mj_loadXML("robot.xml", vfs.get(), error.data(), static_cast<int>(error.size())));
  if (!model) throw EnvironmentError(std::string("MuJoCo refuses the robot model: ") + error.data());
  return model;
}

DataPtr make_data(const mjModel_& model) {
  DataPtr data(mj_makeData(&model));
  if (!data) throw EnvironmentError("MuJoCo: cannot allocate the simulation data");
  return data;
}

namespace {

std::vector<int> geoms_named(const std::string& name, const mjModel_& model, int count) {
  std::vector<int> geoms;
  geoms.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) geoms.push_back(mj_name2id(&model, mjOBJ_GEOM, (name + std::to_string(i)).c_str()));
  return geoms;
}

}  // namespace

std::vector<int> pool_geoms(const mjModel_& model, int box_pool) { return geoms_named("pool", model, box_pool); }

std::vector<int> plate_geoms(const mjModel_& model, int plates) { return geoms_named("plate", model, plates); }

void place_floor(mjModel_& model, double z_W) {
  const int geom = mj_name2id(&model, mjOBJ_GEOM, "floor");
  model.geom_pos[std::ptrdiff_t{3} * geom + 2] = z_W;
  model.geom_sameframe[geom] = 0;
}

void place_box(mjModel_& model, int geom, const Eigen::Vector3d& center_W, const Eigen::Vector4d& q_wxyz,
               const Eigen::Vector3d& half) {
  std::copy_n(center_W.data(), 3, model.geom_pos + std::ptrdiff_t{3} * geom);
  std::copy_n(q_wxyz.data(), 4, model.geom_quat + std::ptrdiff_t{4} * geom);
  std::copy_n(half.data(), 3, model.geom_size + std::ptrdiff_t{3} * geom);
  model.geom_rbound[geom] = half.norm();
  model.geom_sameframe[geom] = 0;  // a geom at its body's origin would otherwise keep its old pose
}

}  // namespace plumbline::sim
