// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/bench/plain_rays.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <vector>

#include "bim/digest/float_mode.h"
#include "bim/errors.h"

namespace plumbline::scenarios {

namespace {

struct PlainFace {
  Eigen::Vector3d n;
  Eigen::Vector3d v0;
  int element = -1;
};

}  // namespace

struct PlainRays::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<PlainFace> faces;

  ~Impl() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
    set_float_mode();
  }
};

PlainRays::PlainRays(const bim::BuildingMesh& mesh) : impl_(std::make_unique<Impl>()) {
  impl_->device = rtcNewDevice("ignore_config_files=1,threads=1,user_threads=1,set_affinity=0");
  if (impl_->device == nullptr) throw EnvironmentError("Embree: no device");
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
  const RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.vertices.size()));
  auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned), mesh.triangles.size()));
  if (vertices == nullptr || indices == nullptr) throw EnvironmentError("Embree: no memory for the mesh");
  for (const Eigen::Vector3d& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) *vertices++ = static_cast<float>(v[k]);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Eigen::Vector3i& t = mesh.triangles[i];
    const auto vertex = [&](int k) -> const Eigen::Vector3d& { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    for (int k = 0; k < 3; ++k) *indices++ = static_cast<unsigned>(t[k]);
    const Eigen::Vector3d n = (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0)).normalized();
    impl_->faces.push_back({n, vertex(0), mesh.element[i]});
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(impl_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(impl_->scene);
  set_float_mode();
  if (rtcGetDeviceError(impl_->device) != RTC_ERROR_NONE) throw EnvironmentError("Embree: cannot build the scene");
}

PlainRays::~PlainRays() = default;

void PlainRays::cast(std::span<const bim::Ray> rays, double range_max_m, std::span<bim::Hit> hits) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Vector3d& o = rays[i].origin_W;
    const Eigen::Vector3d& d = rays[i].direction_W;
    RTCRayHit query;
    query.ray = {static_cast<float>(o.x()),
                 static_cast<float>(o.y()),
                 static_cast<float>(o.z()),
                 0.0F,
                 static_cast<float>(d.x()),
                 static_cast<float>(d.y()),
                 static_cast<float>(d.z()),
                 0.0F,
                 static_cast<float>(range_max_m),
                 ~0U,
                 0,
                 0};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(impl_->scene, &context, &query);
    hits[i] = {};
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
    const PlainFace& face = impl_->faces[query.hit.primID];
    const double slope = face.n.dot(d);
    if (slope == 0.0) continue;
    hits[i].range_m = face.n.dot(face.v0 - o) / slope;
    hits[i].element = face.element;
    hits[i].triangle = static_cast<int>(query.hit.primID);
    hits[i].normal_W = slope > 0.0 ? Eigen::Vector3d(-face.n) : face.n;
  }
}

}  // namespace plumbline::scenarios
