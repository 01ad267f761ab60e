// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

namespace plumbline::bim {

/// Writes boxes and sheets as obj.
class BoxObj {
 public:
  void box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    for (int i = 0; i < 8; ++i)
      vertex({i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z()});
    for (const char* face : {"1342", "5687", "1265", "3784", "1573", "2486"}) {
      text_ += "f";
      for (const char* k = face; *k != '\0'; ++k) text_ += " " + std::to_string(corners_ - 8 + (*k - '0'));
      text_ += "\n";
    }
  }
  /// Faces up over a rectangle from the origin, in nx x ny pairs of triangles.
  void sheet(double x, double y, int nx, int ny, const std::function<double(int, int)>& height) {
    const int first = corners_ + 1;
    for (int i = 0; i <= nx; ++i)
      for (int j = 0; j <= ny; ++j) vertex({x * i / nx, y * j / ny, height(i, j)});
    const auto at = [&](int i, int j) { return " " + std::to_string(first + i * (ny + 1) + j); };
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j) {
        text_ += "f" + at(i, j) + at(i + 1, j) + at(i + 1, j + 1) + "\n";
        text_ += "f" + at(i, j) + at(i + 1, j + 1) + at(i, j + 1) + "\n";
      }
  }
  /// Four walls within a rectangle from the origin.
  void walls(double x, double y, double z0, double z1, double thickness) {
    box({0, 0, z0}, {x, thickness, z1});
    box({0, y - thickness, z0}, {x, y, z1});
    box({0, thickness, z0}, {thickness, y - thickness, z1});
    box({x - thickness, thickness, z0}, {x, y - thickness, z1});
  }

  [[nodiscard]] const std::string& text() const { return text_; }
  /// With y up: p is at (x, z, -y).
  bool y_up = false;
  /// Units of the file in a metre.
  double per_m = 1.0;

 private:
  void vertex(const Eigen::Vector3d& p) {
    const Eigen::Vector3d q = per_m * (y_up ? Eigen::Vector3d(p.x(), p.z(), -p.y()) : p);
    text_ += "v " + std::to_string(q.x()) + " " + std::to_string(q.y()) + " " + std::to_string(q.z()) + "\n";
    ++corners_;
  }

  std::string text_;
  int corners_ = 0;
};

}  // namespace plumbline::bim
