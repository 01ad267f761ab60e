// SPDX-License-Identifier: Apache-2.0
#include "bim/rays/coplanar_table.h"

#include <CGAL/Box_intersection_d/Box_d.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "bim/errors.h"

namespace plumbline::bim {

namespace {

constexpr std::size_t cells_per_face = 8;
/// Bounds of what is kept: 640 MB where everything touches everything, far more faces where they do not.
constexpr std::size_t most_pairs = 5'000'000;
constexpr std::size_t most_pairs_per_face = 50;

/// A triangle clipped by at most eight half spaces.
class ConvexPolygon {
 public:
  explicit ConvexPolygon(const std::array<Eigen::Vector3d, 3>& v) : size_(3) {
    std::copy(v.begin(), v.end(), p_.begin());
  }

  /// Keeps the part where m.x <= limit.
  void clip(const Eigen::Vector3d& m, double limit) {
    std::array<double, capacity> over;
    bool any = false;
    for (std::size_t i = 0; i < size_; ++i) {
      over[i] = m.dot(p_[i]) - limit;
      any = any || over[i] > 0.0;
    }
    if (!any) return;
    std::array<Eigen::Vector3d, capacity> kept;
    std::size_t count = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const std::size_t j = i + 1 < size_ ? i + 1 : 0;
      if (over[i] <= 0.0) kept[count++] = p_[i];
      if ((over[i] < 0.0 && over[j] > 0.0) || (over[i] > 0.0 && over[j] < 0.0))
        kept[count++] = p_[i] + (p_[j] - p_[i]) * (over[i] / (over[i] - over[j]));
    }
    std::copy_n(kept.begin(), count, p_.begin());
    size_ = count;
  }
  void flatten(const Eigen::Vector3d& n, const Eigen::Vector3d& origin) {
    for (std::size_t i = 0; i < size_; ++i) p_[i] -= n * n.dot(p_[i] - origin);
  }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] Eigen::AlignedBox3d box(double margin) const {
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < size_; ++i) box.extend(p_[i]);
    const Eigen::Vector3d m = Eigen::Vector3d::Constant(margin);
    return {box.min() - m, box.max() + m};
  }

 private:
  static constexpr std::size_t capacity = 16;
  std::array<Eigen::Vector3d, capacity> p_;
  std::size_t size_;
};

void clip_to_sides(ConvexPolygon& polygon, const Face& face, const std::array<Eigen::Vector3d, 3>& outward,
                   double grow) {
  for (std::size_t k = 0; k < 3 && !polygon.empty(); ++k) polygon.clip(outward[k], outward[k].dot(face.v[k]) + grow);
}

/// True when all of `other` lies more than `distance` on one side of the face's plane.
bool beside(const Face& face, const Face& other, double distance) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Eigen::Vector3d& v : other.v) {
    const double height = face.n.dot(v - face.v[0]);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  return low > distance || high < -distance;
}

/// Outward normals of the three sides, in the face's plane.
std::array<Eigen::Vector3d, 3> side_normals(const Face& face) {
  std::array<Eigen::Vector3d, 3> normals;
  for (std::size_t k = 0; k < 3; ++k) normals[k] = (face.v[(k + 1) % 3] - face.v[k]).cross(face.n).normalized();
  return normals;
}

/// True when all of `other` lies more than `distance` beyond one side of the face.
bool beyond_a_side(const Face& face, const std::array<Eigen::Vector3d, 3>& outward, const Face& other,
                   double distance) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double limit = outward[k].dot(face.v[k]) + distance;
    if (outward[k].dot(other.v[0]) > limit && outward[k].dot(other.v[1]) > limit && outward[k].dot(other.v[2]) > limit)
      return true;
  }
  return false;
}

/// Relation of `other` to `face`: inside, at the border (with an empty region), or none.
std::optional<CoplanarFace> coplanar_face_of(const Face& face, const std::array<Eigen::Vector3d, 3>& outward,
                                             const Face& other, int other_index, const RayTolerances& tol) {
  const double clear = 1.01 * tol.coplanar;  // spares most pairs the clipping
  if (beside(face, other, clear) || beyond_a_side(face, outward, other, clear)) return std::nullopt;
  const double offset = face.n.dot(face.v[0]);
  ConvexPolygon near(other.v);
  near.clip(face.n, offset + tol.coplanar);
  if (near.empty()) return std::nullopt;
  near.clip(-face.n, tol.coplanar - offset);
  if (near.empty()) return std::nullopt;
  near.flatten(face.n, face.v[0]);
  clip_to_sides(near, face, outward, tol.coplanar);
  if (near.empty()) return std::nullopt;
  ConvexPolygon inner = near;
  clip_to_sides(inner, face, outward, tol.coplanar - tol.edge_band);
  if (inner.empty()) return CoplanarFace{{}, other_index};
  return CoplanarFace{near.box(tol.coplanar), other_index};
}

/// Box of a face as Embree will see it, grown by the coplanar distance, with the face's index.
class FaceBox : public CGAL::Box_intersection_d::Box_d<double, 3, CGAL::Box_intersection_d::ID_NONE> {
 public:
  FaceBox(const Eigen::AlignedBox3d& box, std::size_t face)
      : Box_d(CGAL::Bbox_3(box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z())),
        face_(face) {}
  [[nodiscard]] std::size_t id() const { return face_; }

 private:
  std::size_t face_;
};

/// For each face those whose boxes meet its own, in ascending order.
class Neighbours {
 public:
  Neighbours(std::span<const Face> faces, const RayTolerances& tolerances) : begin_(faces.size() + 1, 0) {
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(tolerances.coplanar);
    std::vector<FaceBox> boxes;
    boxes.reserve(faces.size());
    for (const Face& face : faces) {
      Eigen::AlignedBox3d box;
      for (const Eigen::Vector3d& v : inflate(face, tolerances).v) box.extend(v);
      boxes.emplace_back(Eigen::AlignedBox3d(box.min() - margin, box.max() + margin), boxes.size());
    }
    std::vector<std::pair<int, int>> pairs;
    const std::size_t most = most_pairs + most_pairs_per_face * faces.size();
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const FaceBox& a, const FaceBox& b) {
      if (pairs.size() >= most)
        throw InputError({},
                         "thousands of triangles lie in one place, such as copies of one element that were never "
                         "moved apart; remove all but one of them");
      pairs.emplace_back(static_cast<int>(a.id()), static_cast<int>(b.id()));
    });
    sort_out(pairs);
  }
  [[nodiscard]] std::span<const int> of(std::size_t face) const {
    return std::span(faces_).subspan(begin_[face], begin_[face + 1] - begin_[face]);
  }

 private:
  void sort_out(const std::vector<std::pair<int, int>>& pairs) {
    for (const auto& [a, b] : pairs) {
      ++begin_[static_cast<std::size_t>(a) + 1];
      ++begin_[static_cast<std::size_t>(b) + 1];
    }
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    faces_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (const auto& [a, b] : pairs) {
      faces_[next[static_cast<std::size_t>(a)]++] = b;
      faces_[next[static_cast<std::size_t>(b)]++] = a;
    }
    for (std::size_t i = 0; i + 1 < begin_.size(); ++i)
      std::sort(faces_.begin() + static_cast<std::ptrdiff_t>(begin_[i]),
                faces_.begin() + static_cast<std::ptrdiff_t>(begin_[i + 1]));
  }

  std::vector<std::size_t> begin_;
  std::vector<int> faces_;
};

}  // namespace

CoplanarGrid::CoplanarGrid(std::span<const CoplanarFace> coplanar_faces, const Eigen::Vector3d& normal) {
  int steepest = 0;
  normal.cwiseAbs().maxCoeff(&steepest);
  axis_[0] = steepest == 0 ? 1 : 0;
  axis_[1] = steepest == 2 ? 1 : 2;
  Eigen::AlignedBox3d box;
  for (const CoplanarFace& neighbour : coplanar_faces) box.extend(neighbour.region_W);
  for (int k = 0; k < 2; ++k) {
    low_[k] = box.min()[axis_[k]];
    size_[k] = box.max()[axis_[k]] - low_[k];
  }
  double side = std::sqrt(size_[0] * size_[1] / static_cast<double>(cells_per_face * coplanar_faces.size()));
  divide(side);
  const auto entries = [&] {
    std::size_t count = 0;
    for (const CoplanarFace& neighbour : coplanar_faces) count += cells_of(neighbour);
    return count;
  };
  while (cells_[0] * cells_[1] > 1 && entries() > 4 * cells_per_face * coplanar_faces.size()) divide(side *= 2.0);

  begin_.assign(static_cast<std::size_t>(cells_[0] * cells_[1]) + 1, 0);
  for (const CoplanarFace& neighbour : coplanar_faces)
    for_each_cell(neighbour, [&](std::size_t c) { ++begin_[c + 1]; });
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  indices_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t i = 0; i < coplanar_faces.size(); ++i)
    for_each_cell(coplanar_faces[i], [&](std::size_t c) { indices_[next[c]++] = i; });
}

void CoplanarGrid::divide(double side) {
  for (int k = 0; k < 2; ++k) {
    cells_[k] = 1 + static_cast<int>(std::min(size_[k] / side, 4e3));
    per_m_[k] = cells_[k] / size_[k];
  }
}

std::size_t CoplanarGrid::cells_of(const CoplanarFace& neighbour) const {
  std::size_t count = 1;
  for (int k = 0; k < 2; ++k) {
    const int axis = axis_[k];
    count *=
        static_cast<std::size_t>(cell(k, neighbour.region_W.max()[axis]) - cell(k, neighbour.region_W.min()[axis]) + 1);
  }
  return count;
}

template <class Visit>
void CoplanarGrid::for_each_cell(const CoplanarFace& neighbour, Visit&& visit) const {
  const Eigen::Vector3d& low = neighbour.region_W.min();
  const Eigen::Vector3d& high = neighbour.region_W.max();
  for (int v = cell(1, low[axis_[1]]); v <= cell(1, high[axis_[1]]); ++v)
    for (int u = cell(0, low[axis_[0]]); u <= cell(0, high[axis_[0]]); ++u)
      visit(static_cast<std::size_t>(v * cells_[0] + u));
}

CoplanarTable::CoplanarTable(std::span<const Face> faces, const RayTolerances& tolerances) {
  inside_begin_.reserve(faces.size() + 1);
  border_begin_.reserve(faces.size() + 1);
  const Neighbours neighbours(faces, tolerances);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    inside_begin_.push_back(inside_.size());
    border_begin_.push_back(border_.size());
    const std::array<Eigen::Vector3d, 3> outward = side_normals(faces[i]);
    for (const int other : neighbours.of(i)) {
      const auto neighbour =
          coplanar_face_of(faces[i], outward, faces[static_cast<std::size_t>(other)], other, tolerances);
      if (!neighbour) continue;
      if (neighbour->region_W.isEmpty()) {
        border_.push_back(other);
      } else {
        inside_.push_back(*neighbour);
      }
    }
  }
  inside_begin_.push_back(inside_.size());
  border_begin_.push_back(border_.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (inside(i).size() > grid_min) {
      grid_.resize(faces.size(), -1);
      grid_[i] = static_cast<int>(grids_.size());
      grids_.emplace_back(inside(i), faces[i].n);
    }
}

}  // namespace plumbline::bim
