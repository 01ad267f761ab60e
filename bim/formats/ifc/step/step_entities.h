// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bim/errors.h"

namespace plumbline::bim {

/// An attribute of a STEP entity.
struct StepValue {
  enum class Kind { none, reference, number, text, enumeration, list, typed };
  Kind kind = Kind::none;
  double number = 0.0;           ///< number, or entity number of a reference
  std::string text;              ///< text, enumeration without dots, name of a type
  std::vector<StepValue> items;  ///< of a list; the one value of a typed one
  Mark mark;                     ///< of the entity

  /// Each throws InputError at the entity's line where the value is of another kind.
  [[nodiscard]] double as_number() const;
  [[nodiscard]] int as_integer() const;
  [[nodiscard]] std::int64_t as_reference() const;
  [[nodiscard]] const std::string& as_text() const;  ///< of text and enumerations
  [[nodiscard]] bool as_flag() const;
  [[nodiscard]] const std::vector<StepValue>& as_list() const&;
  [[nodiscard]] std::vector<StepValue> as_list() &&;
  /// The value in TYPE(value).
  [[nodiscard]] const StepValue& as_typed() const;
  [[nodiscard]] const StepValue& at(std::size_t index) const&;  ///< of a list
  [[nodiscard]] StepValue at(std::size_t index) &&;
};

/// The entities of a STEP file, kept as text and taken apart one at a time.
class StepEntities {
 public:
  struct Entity {
    std::int64_t number = 0;
    std::string_view type, attributes;  ///< attributes with their brackets
    int line = 0;
  };
  /// The text must outlive the entities and have passed check_step_text().
  StepEntities(std::string_view text, const std::string& file);

  /// In ascending order of their numbers.
  [[nodiscard]] const std::vector<Entity>& all() const { return entities_; }
  [[nodiscard]] const Entity& entity(std::int64_t number) const;
  /// Attributes as a list. Throws InputError where the text is none.
  [[nodiscard]] StepValue attributes(const Entity& entity) const;
  [[nodiscard]] StepValue attributes(std::int64_t number) const { return attributes(entity(number)); }
  /// Attributes of a reference that must be of a type.
  [[nodiscard]] StepValue attributes(const StepValue& reference, std::string_view type) const;

 private:
  std::string file_;
  std::vector<Entity> entities_;
};

}  // namespace plumbline::bim
