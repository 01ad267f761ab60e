// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "bim/formats/ifc/step/shape.h"

class BuildingModel;
class IfcRepresentation;

namespace plumbline::bim {

/// IFC++'s geometry converter behind one function: its headers cost 50 s of compile time.
class StepGeometry {
 public:
  explicit StepGeometry(const std::shared_ptr<BuildingModel>& model);
  ~StepGeometry();

  /// Uncut items of a representation in its product's frame, m. Adds the converter's messages to `diagnostics`.
  [[nodiscard]] std::vector<Shape> shapes(const std::shared_ptr<IfcRepresentation>& representation,
                                          std::vector<std::string>& diagnostics);
  /// Points of the curves of an Axis representation in its product's frame, m.
  [[nodiscard]] std::vector<Eigen::Vector3d> curve(const std::shared_ptr<IfcRepresentation>& representation,
                                                   std::vector<std::string>& diagnostics);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline::bim
