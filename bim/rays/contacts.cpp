// SPDX-License-Identifier: Apache-2.0
#include "bim/rays/contacts.h"

#include <algorithm>
#include <array>
#include <numeric>

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

/// Adds to `contacts` of `face` what `other` means to it, if anything.
void add_contact(const Face& face, const Face& other, int other_index, const RayTolerances& tol,
                 FaceContacts& contacts) {
  const double offset = face.n.dot(face.v[0]);
  ConvexPolygon near(other.v);
  near.clip(face.n, offset + tol.contact);
  if (near.empty()) return;
  near.clip(-face.n, tol.contact - offset);
  if (near.empty()) return;
  near.flatten(face.n, face.v[0]);
  clip_to_sides(near, face, tol.contact);
  if (near.empty()) return;
  ConvexPolygon inner = near;
  clip_to_sides(inner, face, tol.contact - tol.edge_band);
  if (inner.empty()) {
    contacts.border.push_back(other_index);
  } else {
    contacts.inside.push_back({near.box(tol.contact), other_index});
  }
}

/// Boxes of the faces as Embree will see them, grown by the contact distance.
std::vector<Eigen::AlignedBox3d> boxes_of(std::span<const Face> faces, const RayTolerances& tolerances) {
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(tolerances.contact);
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(faces.size());
  for (const Face& face : faces) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& v : inflate(face, tolerances).v) box.extend(v);
    boxes.emplace_back(box.min() - margin, box.max() + margin);
  }
  return boxes;
}

}  // namespace

std::vector<FaceContacts> find_contacts(std::span<const Face> faces, const RayTolerances& tolerances) {
  const std::vector<Eigen::AlignedBox3d> boxes = boxes_of(faces, tolerances);
  std::vector<std::size_t> by_x(faces.size());
  std::iota(by_x.begin(), by_x.end(), std::size_t{0});
  std::stable_sort(by_x.begin(), by_x.end(),
                   [&](std::size_t a, std::size_t b) { return boxes[a].min().x() < boxes[b].min().x(); });

  std::vector<FaceContacts> contacts(faces.size());
  for (std::size_t i = 0; i < by_x.size(); ++i) {
    const std::size_t a = by_x[i];
    for (std::size_t j = i + 1; j < by_x.size() && boxes[by_x[j]].min().x() <= boxes[a].max().x(); ++j) {
      const std::size_t b = by_x[j];
      if (!boxes[a].intersects(boxes[b])) continue;
      add_contact(faces[a], faces[b], static_cast<int>(b), tolerances, contacts[a]);
      add_contact(faces[b], faces[a], static_cast<int>(a), tolerances, contacts[b]);
    }
  }
  for (FaceContacts& c : contacts) {
    std::sort(c.inside.begin(), c.inside.end(), [](const Contact& a, const Contact& b) { return a.face < b.face; });
    std::sort(c.border.begin(), c.border.end());
  }
  return contacts;
}

}  // namespace plumbline::bim
