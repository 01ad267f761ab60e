// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace plumbline::bim {

/// Attributes of an entity as STEP text.
namespace step {
inline constexpr const char* none = "$";
inline constexpr const char* inherited = "*";
[[nodiscard]] std::string ref(int number);
[[nodiscard]] std::string integer(std::int64_t value);
[[nodiscard]] std::string boolean(bool value);
/// .NAME.
[[nodiscard]] std::string enumeration(std::string_view name);
[[nodiscard]] std::string list(const std::vector<std::string>& items);
[[nodiscard]] std::string refs(const std::vector<int>& numbers);
/// TYPE(value)
[[nodiscard]] std::string typed(std::string_view type, const std::string& value);
}  // namespace step

/// Entities in the order they are added, numbered from 1.
class StepWriter {
 public:
  /// Returns the number of the new entity.
  int add(std::string_view type, const std::vector<std::string>& attributes);
  /// One line an entity.
  [[nodiscard]] const std::string& lines() const { return lines_; }

 private:
  std::string lines_;
  int count_ = 0;
};

}  // namespace plumbline::bim
