// SPDX-License-Identifier: Apache-2.0
#include "bim/rays/contacts.h"

#include <CGAL/Box_intersection_d/Box_d.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace plumbline::bim {

namespace {

/// A triangle clipped by at most eight half spaces.
class ConvexPolygon {
 public:
  explicit ConvexPolygon(const std::array<Eigen::Vector3d, 3>& v) : size_(3) {
    std::copy(v.begin(), v.end(), p_.begin());
  }

  /// Keeps the part where m.x <= limit.
  void clip(const Eigen::Vector3d& m, double limit) {
    std::array<Eigen::Vector3d, capacity> kept;
    std::size_t count = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const Eigen::Vector3d& a = p_[i];
      const Eigen::Vector3d& b = p_[(i + 1) % size_];
      const double da = m.dot(a) - limit;
      const double db = m.dot(b) - limit;
      if (da <= 0.0) kept[count++] = a;
      if ((da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0)) kept[count++] = a + (b - a) * (da / (da - db));
    }
    p_ = kept;
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

void clip_to_sides(ConvexPolygon& polygon, const Face& face, double grow) {
  for (std::size_t k = 0; k < 3 && !polygon.empty(); ++k) {
    const Eigen::Vector3d outward = (face.v[(k + 1) % 3] - face.v[k]).cross(face.n).normalized();
    polygon.clip(outward, outward.dot(face.v[k]) + grow);
  }
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

/// What `other` means to `face`: a contact inside, one at the border (with an empty region), or nothing.
std::optional<Contact> contact_of(const Face& face, const Face& other, int other_index, const RayTolerances& tol) {
  if (beside(face, other, 1.01 * tol.contact)) return std::nullopt;  // spares most pairs the clipping
  const double offset = face.n.dot(face.v[0]);
  ConvexPolygon near(other.v);
  near.clip(face.n, offset + tol.contact);
  if (near.empty()) return std::nullopt;
  near.clip(-face.n, tol.contact - offset);
  if (near.empty()) return std::nullopt;
  near.flatten(face.n, face.v[0]);
  clip_to_sides(near, face, tol.contact);
  if (near.empty()) return std::nullopt;
  ConvexPolygon inner = near;
  clip_to_sides(inner, face, tol.contact - tol.edge_band);
  if (inner.empty()) return Contact{{}, other_index};
  return Contact{near.box(tol.contact), other_index};
}

/// Box of a face as Embree will see it, grown by the contact distance, with the face's index.
class FaceBox : public CGAL::Box_intersection_d::Box_d<double, 3, CGAL::Box_intersection_d::ID_NONE> {
 public:
  FaceBox(const Eigen::AlignedBox3d& box, std::size_t face)
      : Box_d(CGAL::Bbox_3(box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z())),
        face_(face) {}
  [[nodiscard]] std::size_t id() const { return face_; }

 private:
  std::size_t face_;
};

/// Pairs (a, b) and (b, a) of faces whose boxes meet, in ascending order.
std::vector<std::pair<int, int>> pairs_of(std::span<const Face> faces, const RayTolerances& tolerances) {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(tolerances.contact);
  std::vector<FaceBox> boxes;
  boxes.reserve(faces.size());
  for (const Face& face : faces) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& v : inflate(face, tolerances).v) box.extend(v);
    boxes.emplace_back(Eigen::AlignedBox3d(box.min() - margin, box.max() + margin), boxes.size());
  }
  std::vector<std::pair<int, int>> pairs;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const FaceBox& a, const FaceBox& b) {
    const auto i = static_cast<int>(a.id());
    const auto j = static_cast<int>(b.id());
    pairs.emplace_back(i, j);
    pairs.emplace_back(j, i);
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

ContactGrid::ContactGrid(std::span<const Contact> contacts, const Eigen::Vector3d& normal) {
  int steepest = 0;
  normal.cwiseAbs().maxCoeff(&steepest);
  axis_[0] = steepest == 0 ? 1 : 0;
  axis_[1] = steepest == 2 ? 1 : 2;
  Eigen::AlignedBox3d box;
  for (const Contact& contact : contacts) box.extend(contact.region_W);
  for (int k = 0; k < 2; ++k) {
    low_[k] = box.min()[axis_[k]];
    size_[k] = box.max()[axis_[k]] - low_[k];
  }
  double side = std::sqrt(size_[0] * size_[1] / static_cast<double>(contacts.size()));
  divide(side);
  const auto entries = [&] {
    std::size_t count = 0;
    for (const Contact& contact : contacts) for_each_cell(contact, [&](std::size_t) { ++count; });
    return count;
  };
  while (cells_[0] * cells_[1] > 1 && entries() > 16 * contacts.size()) divide(side *= 2.0);

  begin_.assign(static_cast<std::size_t>(cells_[0] * cells_[1]) + 1, 0);
  for (const Contact& contact : contacts) for_each_cell(contact, [&](std::size_t c) { ++begin_[c + 1]; });
  for (std::size_t c = 1; c < begin_.size(); ++c) begin_[c] += begin_[c - 1];
  contacts_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t i = 0; i < contacts.size(); ++i)
    for_each_cell(contacts[i], [&](std::size_t c) { contacts_[next[c]++] = i; });
}

void ContactGrid::divide(double side) {
  for (int k = 0; k < 2; ++k) {
    cells_[k] = 1 + static_cast<int>(std::min(size_[k] / side, 4e3));
    per_m_[k] = cells_[k] / size_[k];
  }
}

template <class Visit>
void ContactGrid::for_each_cell(const Contact& contact, Visit&& visit) const {
  const Eigen::Vector3d& low = contact.region_W.min();
  const Eigen::Vector3d& high = contact.region_W.max();
  for (int v = cell(1, low[axis_[1]]); v <= cell(1, high[axis_[1]]); ++v)
    for (int u = cell(0, low[axis_[0]]); u <= cell(0, high[axis_[0]]); ++u)
      visit(static_cast<std::size_t>(v * cells_[0] + u));
}

ContactTable::ContactTable(std::span<const Face> faces, const RayTolerances& tolerances) {
  inside_begin_.reserve(faces.size() + 1);
  border_begin_.reserve(faces.size() + 1);
  const std::vector<std::pair<int, int>> pairs = pairs_of(faces, tolerances);
  std::size_t next = 0;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    inside_begin_.push_back(inside_.size());
    border_begin_.push_back(border_.size());
    for (; next < pairs.size() && pairs[next].first == static_cast<int>(i); ++next) {
      const int other = pairs[next].second;
      const auto contact = contact_of(faces[i], faces[static_cast<std::size_t>(other)], other, tolerances);
      if (!contact) continue;
      if (contact->region_W.isEmpty()) {
        border_.push_back(other);
      } else {
        inside_.push_back(*contact);
      }
    }
  }
  inside_begin_.push_back(inside_.size());
  border_begin_.push_back(border_.size());
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (inside(i).size() > grid_min) {
      gridded_.push_back(i);
      grids_.emplace_back(inside(i), faces[i].n);
    }
}

const ContactGrid& ContactTable::grid_of(std::size_t face) const {
  const auto at = std::lower_bound(gridded_.begin(), gridded_.end(), face);
  return grids_[static_cast<std::size_t>(at - gridded_.begin())];
}

}  // namespace plumbline::bim
