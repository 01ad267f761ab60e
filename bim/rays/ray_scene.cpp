// SPDX-License-Identifier: Apache-2.0
#include "bim/rays/ray_scene.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "bim/errors.h"
#include "bim/rays/coplanar_table.h"
#include "bim/rays/embree_scene.h"
#include "bim/rays/face.h"
#include "bim/rays/ray_bodies.h"

namespace plumbline::bim {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Upper half of a float, rounded up: a positive width in two bytes that is never less than the value.
std::uint16_t half_up(double width) {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(width) * 1.000001F);
  return static_cast<std::uint16_t>((bits + 0xffffU) >> 16U);
}
float from_half(std::uint16_t half) { return std::bit_cast<float>(std::uint32_t{half} << 16U); }

/// What every ray on a face needs, in one cache line.
struct alignas(64) FacePlane {
  Eigen::Vector3d n, v0;
  int element = -1;
  int triangle = -1;
  std::array<std::uint16_t, 3> edge_band{};  ///< barycentric, opposite v1, v2, v0 (Embree's u, v, 1-u-v), half floats
  std::uint16_t has_inside = 0;              ///< 1 when it has coplanar neighbours inside

  [[nodiscard]] bool in_edge_band(float u, float v) const {
    return u <= from_half(edge_band[0]) || v <= from_half(edge_band[1]) || 1.0F - u - v <= from_half(edge_band[2]);
  }
};
static_assert(sizeof(FacePlane) == 64);

std::array<std::uint16_t, 3> edge_band_of(const Face& face, const RayTolerances& tol) {
  const InflatedTriangle t = inflate(face, tol);
  const std::uint16_t everywhere = half_up(2.0);
  if (!t.exact) return {everywhere, everywhere, everywhere};
  const double area2 = (t.v[1] - t.v[0]).cross(t.v[2] - t.v[0]).norm();
  const auto band = [&](std::size_t a, std::size_t b) {
    return half_up((tol.inflation + tol.edge_band) * (t.v[b] - t.v[a]).norm() / area2);
  };
  return {band(2, 0), band(0, 1), band(1, 2)};
}

RayTolerances tolerances_of(std::span<const Face> faces) {
  Eigen::AlignedBox3d box;
  for (const Face& face : faces)
    for (const Eigen::Vector3d& v : face.v) box.extend(v);
  return faces.empty() ? RayTolerances{} : tolerances_at(0.5 * box.sizes().maxCoeff());
}

/// A face that Embree proposes for a ray.
struct Proposal {
  std::size_t face = 0;
  double range = 0.0;           ///< Embree's, from the true origin; wrong by more than the tie distance on grazing rays
  std::optional<double> exact;  ///< range at which the ray meets the plane; nothing when parallel

  /// Range up to which the proposal says what is there.
  [[nodiscard]] double reach() const { return exact ? std::min(*exact, range) : range; }
};

}  // namespace

struct RayScene::Impl {
  std::vector<Face> faces;
  RayTolerances tol;
  std::vector<FacePlane> planes;
  std::vector<int> face_of_triangle;  ///< -1: without area
  CoplanarTable coplanar_faces;
  EmbreeScene embree;
  MovingBodies bodies;

  Impl(const BuildingMesh& mesh, const RaySceneOptions& options);

  void decide(std::span<const Ray> rays, double range_max_m, const Proposals& proposals, std::span<Hit> hits) const;
  [[nodiscard]] Hit search(const Ray& ray, double range_max_m, Proposals& proposals) const;
  [[nodiscard]] const Face* settle(const Ray& ray, double range_max_m, const Proposal& proposal,
                                   bool in_edge_band) const;
  [[nodiscard]] const Face* settle_ties(const Ray& ray, double range_max_m, const Proposal& proposal) const;
  [[nodiscard]] double exact_range(std::size_t face, const Ray& ray, double range_max_m, double limit) const;
  [[nodiscard]] bool touched_at(std::size_t face, const Eigen::Vector3d& p_W) const;
};

RayScene::Impl::Impl(const BuildingMesh& mesh, const RaySceneOptions& options)
    : faces(make_faces(mesh)), tol(tolerances_of(faces)), coplanar_faces(faces, tol), embree(faces, tol, options) {
  planes.reserve(faces.size());
  face_of_triangle.assign(mesh.triangles.size(), -1);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const Face& face = faces[i];
    face_of_triangle[static_cast<std::size_t>(face.triangle)] = static_cast<int>(i);
    planes.push_back({face.n, face.v[0], face.element, face.triangle, edge_band_of(face, tol),
                      static_cast<std::uint16_t>(coplanar_faces.inside(i).empty() ? 0 : 1)});
  }
}

/// By far most hits lie well inside a face and away from every other; the rest is searched one by one.
void RayScene::Impl::decide(std::span<const Ray> rays, double range_max_m, const Proposals& proposals,
                            std::span<Hit> hits) const {
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (proposals.face[i] != Proposals::none) __builtin_prefetch(&planes[proposals.face[i]]);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (proposals.face[i] == Proposals::none) {
      hits[i] = {};
      continue;
    }
    const FacePlane& plane = planes[proposals.face[i]];
    const Ray& ray = rays[i];
    const double slope = plane.n.dot(ray.direction_W);
    const double range = plane.n.dot(plane.v0 - ray.origin_W) / slope;
    const bool clear =
        slope != 0.0 && range > 0.0 && range <= range_max_m && !plane.in_edge_band(proposals.u[i], proposals.v[i]) &&
        (plane.has_inside == 0 || !touched_at(proposals.face[i], ray.origin_W + range * ray.direction_W));
    if (clear) {
      hits[i] = {range, plane.element, plane.triangle, slope > 0.0 ? Eigen::Vector3d(-plane.n) : plane.n};
    } else {
      Proposals one;
      one.face[0] = proposals.face[i];
      one.u[0] = proposals.u[i];
      one.v[0] = proposals.v[i];
      one.range[0] = proposals.range[i];
      hits[i] = search(ray, range_max_m, one);
    }
  }
}

Hit RayScene::Impl::search(const Ray& ray, double range_max_m, Proposals& proposals) const {
  double tnear = 0.0;
  // In a wide scene Embree may see what lies beyond that distance as nearer.
  const double slack = 4.0 * (tol.inflation - RayTolerances{}.inflation);
  while (proposals.face[0] != Proposals::none) {
    Proposal proposal;
    proposal.face = proposals.face[0];
    proposal.range = static_cast<double>(proposals.range[0]) - EmbreeScene::back_off;
    proposal.exact = faces[proposal.face].plane_range(ray.origin_W, ray.direction_W);
    const bool in_edge_band = planes[proposal.face].in_edge_band(proposals.u[0], proposals.v[0]);
    if (const Face* face = settle(ray, range_max_m, proposal, in_edge_band)) {
      const bool from_behind = face->n.dot(ray.direction_W) > 0.0;
      return {*face->plane_range(ray.origin_W, ray.direction_W), face->element, face->triangle,
              from_behind ? Eigen::Vector3d(-face->n) : face->n};
    }
    // No face is hit there: search behind it. Faces within the tie distance are tested already.
    tnear = std::max(tnear, proposal.reach() + EmbreeScene::back_off - slack) + tol.tie;
    embree.propose_after(ray, range_max_m, static_cast<float>(tnear), proposals);
  }
  return {};
}

/// True when another face is near enough to a point of a face to tie with it. Regions are boxes; the plane of the other
/// face tells more of those that stand askew.
bool RayScene::Impl::touched_at(std::size_t face, const Eigen::Vector3d& p_W) const {
  return coplanar_faces.any_at(face, p_W, [&](int other) {
    const FacePlane& plane = planes[static_cast<std::size_t>(other)];
    return std::abs(plane.n.dot(p_W - plane.v0)) <= 2.0 * tol.coplanar;
  });
}

/// The face a ray hits at or next to a proposed one, or nullptr.
const Face* RayScene::Impl::settle(const Ray& ray, double range_max_m, const Proposal& proposal,
                                   bool in_edge_band) const {
  if (!proposal.exact || in_edge_band) return settle_ties(ray, range_max_m, proposal);
  if (touched_at(proposal.face, ray.origin_W + *proposal.exact * ray.direction_W))
    return settle_ties(ray, range_max_m, proposal);
  return *proposal.exact > 0.0 && *proposal.exact <= range_max_m ? &faces[proposal.face] : nullptr;
}

/// Nearest exact hit on a face and its coplanar neighbours; within the tie distance of it the lowest element, then
/// triangle.
const Face* RayScene::Impl::settle_ties(const Ray& ray, double range_max_m, const Proposal& proposal) const {
  const auto for_each = [&](auto&& visit) {
    for (const int border : coplanar_faces.border(proposal.face)) visit(static_cast<std::size_t>(border));
    const auto visit_inside = [&](int other) {
      visit(static_cast<std::size_t>(other));
      return false;
    };
    if (proposal.exact) {
      (void)coplanar_faces.any_at(proposal.face, ray.origin_W + *proposal.exact * ray.direction_W, visit_inside);
    } else {
      for (const CoplanarFace& neighbour : coplanar_faces.inside(proposal.face)) (void)visit_inside(neighbour.face);
    }
  };
  // Ranges first: few faces are near enough to be worth the test of their borders.
  const double proposed = exact_range(proposal.face, ray, range_max_m, range_max_m);
  double nearest = proposed;
  std::size_t winner = proposal.face;
  for_each([&](std::size_t other) {
    const double range = exact_range(other, ray, range_max_m, nearest);
    if (range < nearest) {
      nearest = range;
      winner = other;
    }
  });
  // A coplanar neighbour hit farther away may have other faces before it.
  const bool certain = nearest <= proposal.reach() + tol.tie || nearest == proposed;
  if (std::isinf(nearest) || !certain) return nullptr;
  const auto challenge = [&](std::size_t other) {
    if (faces[other].precedes(faces[winner]) && exact_range(other, ray, range_max_m, nearest + tol.tie) < infinity)
      winner = other;
  };
  challenge(proposal.face);
  for_each(challenge);
  return &faces[winner];
}

/// Range at which a ray meets a face, or infinity where that is more than `limit` or the ray's end.
double RayScene::Impl::exact_range(std::size_t face, const Ray& ray, double range_max_m, double limit) const {
  const FacePlane& plane = planes[face];
  const double slope = plane.n.dot(ray.direction_W);
  if (slope == 0.0) return infinity;
  const double range = plane.n.dot(plane.v0 - ray.origin_W) / slope;
  const bool near = range > 0.0 && range <= range_max_m && range <= limit;
  return near && faces[face].pierced_by(ray.origin_W, ray.direction_W) ? range : infinity;
}

RayScene::RayScene(const BuildingMesh& mesh, const RaySceneOptions& options)
    : impl_(std::make_unique<Impl>(mesh, options)) {}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

void RayScene::cast(std::span<const Ray> rays, double range_max_m, std::span<Hit> hits) const {
  if (hits.size() != rays.size()) throw InternalError("RayScene::cast: as many hits as rays are needed");
  const std::size_t width = impl_->embree.width();
  Proposals proposals;
  for (std::size_t begin = 0; begin < rays.size(); begin += width) {
    const std::size_t count = std::min(width, rays.size() - begin);
    impl_->embree.propose(rays.subspan(begin, count), range_max_m, proposals);
    impl_->decide(rays.subspan(begin, count), range_max_m, proposals, hits.subspan(begin, count));
    if (!impl_->bodies.empty()) impl_->bodies.cast(rays.subspan(begin, count), range_max_m, hits.subspan(begin, count));
  }
}

Hit RayScene::cast(const Ray& ray, double range_max_m) const {
  Proposals proposals;
  impl_->embree.propose_after(ray, range_max_m, 0.0F, proposals);
  Hit hit = impl_->search(ray, range_max_m, proposals);
  if (!impl_->bodies.empty()) impl_->bodies.cast(std::span(&ray, 1), range_max_m, std::span(&hit, 1));
  return hit;
}

bool RayScene::meets(int triangle, const Ray& ray) const {
  const int face = impl_->face_of_triangle.at(static_cast<std::size_t>(triangle));
  return face >= 0 && impl_->faces[static_cast<std::size_t>(face)].pierced_by(ray.origin_W, ray.direction_W);
}

void RayScene::set_bodies(std::vector<MovingBody> bodies) { impl_->bodies = MovingBodies(std::move(bodies)); }

}  // namespace plumbline::bim
