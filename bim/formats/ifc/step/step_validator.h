// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>

#include "bim/errors.h"
#include "bim/formats/ifc/step/step_text.h"

class BuildingEntity;
class IfcRepresentation;

namespace plumbline::bim {

/// Validates geometry before it is converted, since IFC++ dereferences missing attributes.
class StepValidator {
 public:
  StepValidator(const StepText& text, const std::string& file) : text_(text), file_(file) {}

  /// Throws InputError with the line of an entity under the representation that lacks an attribute which IFC demands,
  /// or has an entity of the wrong kind in its place.
  void check(const IfcRepresentation& representation);

 private:
  void check(const BuildingEntity& entity);
  void check_attributes(const BuildingEntity& entity);
  [[noreturn]] void fail(const BuildingEntity& entity, const std::string& attribute) const;

  const StepText& text_;
  const std::string& file_;
  std::set<int> valid_;               ///< STEP numbers that have been checked
  std::map<int, InputError> faulty_;  ///< ... and found wanting
};

}  // namespace plumbline::bim
