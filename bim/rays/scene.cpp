// SPDX-License-Identifier: Apache-2.0
#include "bim/rays/scene.h"

#include <embree3/rtcore.h>
#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bim/errors.h"
#include "bim/rays/contacts.h"
#include "bim/rays/face.h"

namespace plumbline::bim {

namespace {

constexpr std::size_t packet_size = 8;
constexpr RayTolerances tol;

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

struct ReleaseDevice {
  void operator()(RTCDevice device) const {
    const FloatModeGuard guard;
    rtcReleaseDevice(device);
  }
};

struct ReleaseScene {
  void operator()(RTCScene scene) const {
    const FloatModeGuard guard;
    rtcReleaseScene(scene);
  }
};

/// A face with what every ray on it needs at hand.
struct SceneFace {
  Face face;
  std::array<float, 3> edge_band{};  ///< barycentric width of the edge band opposite v1, v2, v0 (Embree's u, v, 1-u-v)
  FaceContacts contacts;
};

/// What Embree found: a face of its inflated, float copy of the mesh.
struct Proposal {
  unsigned face = RTC_INVALID_GEOMETRY_ID;
  float u = 0.0F;
  float v = 0.0F;
  float range = 0.0F;  ///< from the shifted origin

  [[nodiscard]] bool hit() const { return face != RTC_INVALID_GEOMETRY_ID; }
  [[nodiscard]] bool in_edge_band(const std::array<float, 3>& band) const {
    return u <= band[0] || v <= band[1] || 1.0F - u - v <= band[2];
  }
};

/// Embree starts this far behind the origin, so that no face just before it is lost to float rounding, m.
constexpr double back_off = 1e-4;
/// Embree looks this much beyond the maximum range, m.
constexpr double overreach = 1e-3;

std::array<float, 3> edge_band_of(const InflatedTriangle& t) {
  if (!t.exact) return {2.0F, 2.0F, 2.0F};  // always in the band
  const double area2 = (t.v[1] - t.v[0]).cross(t.v[2] - t.v[0]).norm();
  const auto band = [&](std::size_t a, std::size_t b) {
    return static_cast<float>((tol.inflation + tol.edge_band) * (t.v[b] - t.v[a]).norm() / area2);
  };
  return {band(2, 0), band(0, 1), band(1, 2)};
}

/// Range from the true origin up to which a proposal says what is there; Embree's own is wrong by more than the tie
/// distance for grazing rays.
double reach_of(const Proposal& proposal, std::optional<double> exact) {
  const double proposed = static_cast<double>(proposal.range) - back_off;
  return exact ? std::min(*exact, proposed) : proposed;
}

/// Range at which a ray meets a face, or infinity.
double exact_range(const Face& face, const Ray& ray, double range_max_m) {
  const std::optional<double> t = face.plane_range(ray.origin_W, ray.direction_W);
  const bool hit = t && *t > 0.0 && *t <= range_max_m && face.pierced_by(ray.origin_W, ray.direction_W);
  return hit ? *t : std::numeric_limits<double>::infinity();
}

}  // namespace

struct RayScene::Impl {
  std::unique_ptr<RTCDeviceTy, ReleaseDevice> device;
  std::unique_ptr<RTCSceneTy, ReleaseScene> scene;
  Eigen::Vector3d center_W = Eigen::Vector3d::Zero();
  std::vector<SceneFace> faces;

  Impl(const BuildingMesh& mesh, std::string_view device_options);

  void build_faces(const BuildingMesh& mesh, std::vector<InflatedTriangle>& inflated);
  void build_scene(const std::vector<InflatedTriangle>& inflated);

  void propose(std::span<const Ray> rays, double range_max_m, std::span<Proposal> proposals) const;
  [[nodiscard]] Proposal propose_after(const Ray& ray, double range_max_m, float tnear) const;
  [[nodiscard]] Hit decide(const Ray& ray, double range_max_m, Proposal proposal) const;
  [[nodiscard]] const Face* settle(const Ray& ray, double range_max_m, const Proposal& proposal,
                                   std::optional<double> exact) const;
  [[nodiscard]] const Face* settle_ties(const Ray& ray, double range_max_m, const Proposal& proposal,
                                        std::optional<double> exact) const;
};

RayScene::Impl::Impl(const BuildingMesh& mesh, std::string_view device_options) {
  const FloatModeGuard guard;
  // Embree would otherwise read settings from the user's home and start its own threads.
  std::string options = "ignore_config_files=1,threads=1,user_threads=1,set_affinity=0";
  if (!device_options.empty()) options += "," + std::string(device_options);
  device.reset(rtcNewDevice(options.c_str()));
  if (device == nullptr) throw EnvironmentError("Embree: no device for '" + options + "'");
  std::vector<InflatedTriangle> inflated;
  build_faces(mesh, inflated);
  build_scene(inflated);
}

void RayScene::Impl::build_faces(const BuildingMesh& mesh, std::vector<InflatedTriangle>& inflated) {
  const std::vector<Face> plain = make_faces(mesh);
  std::vector<FaceContacts> contacts = find_contacts(plain, tol);
  Eigen::AlignedBox3d box;
  faces.reserve(plain.size());
  inflated.reserve(plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    inflated.push_back(inflate(plain[i], tol));
    faces.push_back({plain[i], edge_band_of(inflated.back()), std::move(contacts[i])});
    for (const Eigen::Vector3d& v : plain[i].v) box.extend(v);
  }
  if (!plain.empty()) center_W = box.center();
}

void RayScene::Impl::build_scene(const std::vector<InflatedTriangle>& inflated) {
  scene.reset(rtcNewScene(device.get()));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
  if (!inflated.empty()) {
    const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), 3 * inflated.size()));
    auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned), inflated.size()));
    if (vertices == nullptr || indices == nullptr) throw EnvironmentError("Embree: no memory for the mesh");
    std::size_t k = 0;
    for (const InflatedTriangle& t : inflated) {
      for (const Eigen::Vector3d& v : t.v) {
        Eigen::Map<Eigen::Vector3f>(vertices + 3 * k) = (v - center_W).cast<float>();
        indices[k] = static_cast<unsigned>(k);
        ++k;
      }
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene.get(), geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene.get());
  if (const RTCError error = rtcGetDeviceError(device.get()); error != RTC_ERROR_NONE)
    throw EnvironmentError("Embree: error " + std::to_string(static_cast<int>(error)) + " while building a scene");
}

void RayScene::Impl::propose(std::span<const Ray> rays, double range_max_m, std::span<Proposal> proposals) const {
  alignas(32) std::array<int, packet_size> valid{};
  RTCRayHit8 packet;
  for (std::size_t i = 0; i < packet_size; ++i) {
    const Ray& ray = rays[std::min(i, rays.size() - 1)];
    const Eigen::Vector3f o = (ray.origin_W - center_W - back_off * ray.direction_W).cast<float>();
    const Eigen::Vector3f d = ray.direction_W.cast<float>();
    valid[i] = i < rays.size() ? -1 : 0;
    packet.ray.org_x[i] = o.x();
    packet.ray.org_y[i] = o.y();
    packet.ray.org_z[i] = o.z();
    packet.ray.dir_x[i] = d.x();
    packet.ray.dir_y[i] = d.y();
    packet.ray.dir_z[i] = d.z();
    packet.ray.tnear[i] = 0.0F;
    packet.ray.tfar[i] = static_cast<float>(range_max_m + overreach);
    packet.ray.time[i] = 0.0F;
    packet.ray.mask[i] = ~0U;
    packet.ray.id[i] = 0;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.primID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect8(valid.data(), scene.get(), &context, &packet);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool hit = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    proposals[i] = {hit ? packet.hit.primID[i] : RTC_INVALID_GEOMETRY_ID, packet.hit.u[i], packet.hit.v[i],
                    packet.ray.tfar[i]};
  }
}

Proposal RayScene::Impl::propose_after(const Ray& ray, double range_max_m, float tnear) const {
  const Eigen::Vector3f o = (ray.origin_W - center_W - back_off * ray.direction_W).cast<float>();
  const Eigen::Vector3f d = ray.direction_W.cast<float>();
  const auto tfar = static_cast<float>(range_max_m + overreach);
  RTCRayHit query{{o.x(), o.y(), o.z(), tnear, d.x(), d.y(), d.z(), 0.0F, tfar, ~0U, 0, 0}, {}};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (tnear <= tfar) rtcIntersect1(scene.get(), &context, &query);
  const bool hit = query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  return {hit ? query.hit.primID : RTC_INVALID_GEOMETRY_ID, query.hit.u, query.hit.v, query.ray.tfar};
}

Hit RayScene::Impl::decide(const Ray& ray, double range_max_m, Proposal proposal) const {
  double tnear = 0.0;
  while (proposal.hit()) {
    const std::optional<double> exact = faces[proposal.face].face.plane_range(ray.origin_W, ray.direction_W);
    if (const Face* face = settle(ray, range_max_m, proposal, exact)) {
      const bool from_behind = face->n.dot(ray.direction_W) > 0.0;
      return {*face->plane_range(ray.origin_W, ray.direction_W), face->element, face->triangle,
              from_behind ? Eigen::Vector3d(-face->n) : face->n};
    }
    // Nothing is really hit there: look on behind it. Faces within the tie distance have been looked at already.
    tnear = std::max(tnear, reach_of(proposal, exact) + back_off) + tol.tie;
    proposal = propose_after(ray, range_max_m, static_cast<float>(tnear));
  }
  return {};
}

/// The face a ray hits at or next to a proposed one, or nullptr. By far most hits lie well inside a face and away
/// from every other. exact: range at which the ray meets the proposed face's plane.
const Face* RayScene::Impl::settle(const Ray& ray, double range_max_m, const Proposal& proposal,
                                   std::optional<double> exact) const {
  if (!exact || proposal.in_edge_band(faces[proposal.face].edge_band))
    return settle_ties(ray, range_max_m, proposal, exact);
  const SceneFace& proposed = faces[proposal.face];
  const Eigen::Vector3d p_W = ray.origin_W + *exact * ray.direction_W;
  for (const Contact& contact : proposed.contacts.inside)
    if (contact.region_W.contains(p_W)) return settle_ties(ray, range_max_m, proposal, exact);
  return *exact > 0.0 && *exact <= range_max_m ? &proposed.face : nullptr;
}

/// Nearest exact hit on a face and its contacts; within the tie distance of it the lowest element, then triangle.
const Face* RayScene::Impl::settle_ties(const Ray& ray, double range_max_m, const Proposal& proposal,
                                        std::optional<double> exact) const {
  const SceneFace& proposed = faces[proposal.face];
  const auto for_each = [&](auto&& visit) {
    visit(proposed.face);
    for (const int border : proposed.contacts.border) visit(faces[static_cast<std::size_t>(border)].face);
    for (const Contact& contact : proposed.contacts.inside)
      if (!exact || contact.region_W.contains(ray.origin_W + *exact * ray.direction_W))
        visit(faces[static_cast<std::size_t>(contact.face)].face);
  };
  double nearest = std::numeric_limits<double>::infinity();
  for_each([&](const Face& face) { nearest = std::min(nearest, exact_range(face, ray, range_max_m)); });
  // A contact hit farther away may have other faces before it.
  const bool certain =
      nearest <= reach_of(proposal, exact) + tol.tie || nearest == exact_range(proposed.face, ray, range_max_m);
  if (std::isinf(nearest) || !certain) return nullptr;
  const Face* winner = nullptr;
  for_each([&](const Face& face) {
    if (exact_range(face, ray, range_max_m) <= nearest + tol.tie && (winner == nullptr || face.precedes(*winner)))
      winner = &face;
  });
  return winner;
}

RayScene::RayScene(const BuildingMesh& mesh, std::string_view device_options)
    : impl_(std::make_unique<Impl>(mesh, device_options)) {}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

void RayScene::cast(std::span<const Ray> rays, double range_max_m, std::span<Hit> hits) const {
  if (hits.size() != rays.size()) throw InternalError("RayScene::cast: as many hits as rays are needed");
  std::array<Proposal, packet_size> proposals;
  for (std::size_t begin = 0; begin < rays.size(); begin += packet_size) {
    const std::size_t count = std::min(packet_size, rays.size() - begin);
    impl_->propose(rays.subspan(begin, count), range_max_m, proposals);
    for (std::size_t i = 0; i < count; ++i) hits[begin + i] = impl_->decide(rays[begin + i], range_max_m, proposals[i]);
  }
}

Hit RayScene::cast(const Ray& ray, double range_max_m) const {
  return impl_->decide(ray, range_max_m, impl_->propose_after(ray, range_max_m, 0.0F));
}

}  // namespace plumbline::bim
