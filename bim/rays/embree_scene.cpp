// SPDX-License-Identifier: Apache-2.0
#include "bim/rays/embree_scene.h"

#include <embree3/rtcore.h>
#include <immintrin.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "bim/errors.h"

namespace plumbline::bim {

namespace {

/// Embree sets its own floating-point mode while it builds; the caller's comes back when this goes.
class FloatModeGuard {
 public:
  FloatModeGuard() : mode_(_mm_getcsr()) {}
  ~FloatModeGuard() { _mm_setcsr(mode_); }
  FloatModeGuard(const FloatModeGuard&) = delete;
  FloatModeGuard& operator=(const FloatModeGuard&) = delete;

 private:
  unsigned mode_;
};

std::string device_options(std::string_view more) {
  // Embree would otherwise read settings from the user's home and start its own threads.
  std::string options = "ignore_config_files=1,threads=1,user_threads=1,set_affinity=0";
  if (!more.empty()) options += "," + std::string(more);
  return options;
}

}  // namespace

void EmbreeScene::ReleaseDevice::operator()(RTCDeviceTy* device) const {
  const FloatModeGuard guard;
  rtcReleaseDevice(device);
}

void EmbreeScene::ReleaseScene::operator()(RTCSceneTy* scene) const {
  const FloatModeGuard guard;
  rtcReleaseScene(scene);
}

EmbreeScene::EmbreeScene(std::span<const Face> faces, const RayTolerances& tolerances, const RaySceneOptions& options) {
  const FloatModeGuard guard;
  const std::string text = device_options(options.embree);
  device_.reset(rtcNewDevice(text.c_str()));
  if (device_ == nullptr) throw EnvironmentError("Embree: no device for '" + text + "'");
  const bool wide = rtcGetDeviceProperty(device_.get(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
  width_ = options.width != 0 ? options.width : (wide ? 16 : 8);
  Eigen::AlignedBox3d box;
  for (const Face& face : faces)
    for (const Eigen::Vector3d& v : face.v) box.extend(v);
  if (!faces.empty()) center_W_ = box.center();
  build(faces, tolerances);
}

void EmbreeScene::build(std::span<const Face> faces, const RayTolerances& tolerances) {
  scene_.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_MEDIUM);
  if (!faces.empty()) {
    const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), 3 * faces.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned), faces.size()));
    if (vertices == nullptr || indices == nullptr) throw EnvironmentError("Embree: no memory for the mesh");
    std::size_t k = 0;
    for (const Face& face : faces)
      for (const Eigen::Vector3d& v : inflate(face, tolerances).v) {
        Eigen::Map<Eigen::Vector3f>(vertices + 3 * k) = (v - center_W_).cast<float>();
        indices[k] = static_cast<unsigned>(k);
        ++k;
      }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene_.get());
  if (const RTCError error = rtcGetDeviceError(device_.get()); error != RTC_ERROR_NONE)
    throw EnvironmentError("Embree: error " + std::to_string(static_cast<int>(error)) + " while building a scene");
}

template <class Packet, class Trace>
void EmbreeScene::propose_packet(std::span<const Ray> rays, double range_max_m, Proposals& proposals,
                                 Trace&& trace) const {
  constexpr std::size_t width = sizeof(Packet::ray.org_x) / sizeof(float);
  alignas(64) std::array<int, width> valid;
  Packet packet;
  const auto tfar = static_cast<float>(range_max_m + overreach);
  for (std::size_t i = 0; i < width; ++i) {
    const Ray& ray = rays[std::min(i, rays.size() - 1)];
    valid[i] = i < rays.size() ? -1 : 0;
    packet.ray.org_x[i] = static_cast<float>(ray.origin_W.x() - center_W_.x() - back_off * ray.direction_W.x());
    packet.ray.org_y[i] = static_cast<float>(ray.origin_W.y() - center_W_.y() - back_off * ray.direction_W.y());
    packet.ray.org_z[i] = static_cast<float>(ray.origin_W.z() - center_W_.z() - back_off * ray.direction_W.z());
    packet.ray.dir_x[i] = static_cast<float>(ray.direction_W.x());
    packet.ray.dir_y[i] = static_cast<float>(ray.direction_W.y());
    packet.ray.dir_z[i] = static_cast<float>(ray.direction_W.z());
  }
  for (std::size_t i = 0; i < width; ++i) {
    packet.ray.tnear[i] = 0.0F;
    packet.ray.tfar[i] = tfar;
    packet.ray.time[i] = 0.0F;
    packet.ray.mask[i] = ~0U;
    packet.ray.id[i] = 0;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.primID[i] = Proposals::none;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  trace(valid.data(), scene_.get(), &context, &packet);
  for (std::size_t i = 0; i < width; ++i) {
    proposals.face[i] = packet.hit.primID[i];
    proposals.u[i] = packet.hit.u[i];
    proposals.v[i] = packet.hit.v[i];
    proposals.range[i] = packet.ray.tfar[i];
  }
}

void EmbreeScene::propose(std::span<const Ray> rays, double range_max_m, Proposals& proposals) const {
  if (rays.size() == 1) {
    propose_after(rays[0], range_max_m, 0.0F, proposals);
  } else if (rays.size() <= 8) {
    propose_packet<RTCRayHit8>(rays, range_max_m, proposals, rtcIntersect8);
  } else {
    propose_packet<RTCRayHit16>(rays, range_max_m, proposals, rtcIntersect16);
  }
}

void EmbreeScene::propose_after(const Ray& ray, double range_max_m, float tnear, Proposals& proposals) const {
  const Eigen::Vector3f o = (ray.origin_W - center_W_ - back_off * ray.direction_W).cast<float>();
  const Eigen::Vector3f d = ray.direction_W.cast<float>();
  const auto tfar = static_cast<float>(range_max_m + overreach);
  RTCRayHit query{{o.x(), o.y(), o.z(), tnear, d.x(), d.y(), d.z(), 0.0F, tfar, ~0U, 0, 0}, {}};
  query.hit.primID = Proposals::none;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (tnear <= tfar) rtcIntersect1(scene_.get(), &context, &query);
  proposals.face[0] = query.hit.primID;
  proposals.u[0] = query.hit.u;
  proposals.v[0] = query.hit.v;
  proposals.range[0] = query.ray.tfar;
}

}  // namespace plumbline::bim
