// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "bim/errors.h"
#include "bim/formats/ifc/step/step_entities.h"

namespace plumbline::bim {

/// Entities of a STEP file said otherwise, and new ones behind all others. Lines stay where they are.
class StepEdits {
 public:
  /// Both must outlive the edits.
  StepEdits(const std::string& text, const StepEntities& entities);

  /// `by`, such as IFCWALL($,#1), takes the place of what the entity is.
  void replace(const StepEntities::Entity& entity, const std::string& by);
  /// A new entity, as "#number".
  std::string add(const std::string& entity);
  /// False where numbers would grow beyond the 32 bits of IFC++.
  [[nodiscard]] bool has_room(std::size_t entities) const;
  /// The text with all of it.
  [[nodiscard]] std::string done() const;

  /// A number as STEP writes it. Throws InputError where it is not finite.
  [[nodiscard]] static std::string real(double v);
  /// An entity with its attributes, up to the closing bracket.
  [[nodiscard]] static std::string_view whole(const StepEntities::Entity& entity);

 private:
  const std::string& text_;
  std::int64_t next_ = 1;
  std::map<std::size_t, std::pair<std::size_t, std::string>> replaced_;  ///< end and new text by begin
  std::string added_;
};

/// Calls take(entity) for all of them. What makes no sense is left to the reader, which says so of the element.
template <class Take>
void take_each(const StepEntities& entities, Take&& take) {
  for (const StepEntities::Entity& entity : entities.all()) {
    try {
      take(entity);
    } catch (const InputError&) {
      continue;
    }
  }
}

/// A value as a file has it: a reference, a number or an enumeration; "$" for others.
[[nodiscard]] std::string step_argument(const StepValue& value);

}  // namespace plumbline::bim
