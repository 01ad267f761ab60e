// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "bim/formats/ifc/step/step_model.h"
#include "bim/mesh/solid.h"
#include "tests/bim/formats/ifc/sketch.h"

namespace plumbline::bim {

inline StepModel read_model(const std::string& text) {
  return read_step_model(text, check_step_text(text, "s.ifc"), "s.ifc");
}

/// What is read of a product with one representation item.
struct StepBody {
  std::vector<Solid> solids;
  std::vector<std::string> problems;

  [[nodiscard]] double volume_m3() const {
    double sum = 0.0;
    for (const Solid& solid : solids) sum += volume(solid);
    return sum;
  }
  [[nodiscard]] bool closed() const { return !solids.empty() && std::all_of(solids.begin(), solids.end(), is_closed); }
  [[nodiscard]] Eigen::AlignedBox3d box() const {
    Eigen::AlignedBox3d box;
    for (const Solid& solid : solids)
      for (const Eigen::Vector3d& p : solid.vertices) box.extend(p);
    return box;
  }
  [[nodiscard]] Eigen::Vector3d middle() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double whole = 0.0;
    for (const Solid& solid : solids) {
      for (const Eigen::Vector3i& t : solid.triangles) {
        const auto p = [&](int k) { return solid.vertices[static_cast<std::size_t>(t[k])]; };
        const double part = p(0).dot(p(1).cross(p(2))) / 6.0;
        sum += part * (p(0) + p(1) + p(2)) / 4.0;
        whole += part;
      }
    }
    return sum / whole;
  }
};

inline StepBody body_in(const std::string& text, const std::string& type = "IfcColumn") {
  StepBody body;
  for (const StepProduct& product : read_model(text).products) {
    if (product.type != type) continue;
    body.problems = product.diagnostics;
    for (const Shape& shape : product.body) body.solids.push_back(solid_of(shape, body.problems));
  }
  return body;
}

/// The body of a column whose only item is given.
inline StepBody body_of(Sketch& sketch, const std::string& item) {
  sketch.element("IFCCOLUMN", sketch.shape(item), "$,$");
  return body_in(sketch.text());
}

inline bool says(const StepBody& body, const std::string& part) {
  return std::any_of(body.problems.begin(), body.problems.end(),
                     [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

}  // namespace plumbline::bim
