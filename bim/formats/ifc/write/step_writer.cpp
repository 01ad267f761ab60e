// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/write/step_writer.h"

namespace plumbline::bim {

namespace step {

std::string ref(int number) { return "#" + std::to_string(number); }
std::string integer(std::int64_t value) { return std::to_string(value); }
std::string boolean(bool value) { return value ? ".T." : ".F."; }
std::string enumeration(std::string_view name) { return "." + std::string(name) + "."; }

std::string list(const std::vector<std::string>& items) {
  std::string text = "(";
  for (const std::string& item : items) text += (text.size() > 1 ? "," : "") + item;
  return text + ")";
}

std::string refs(const std::vector<int>& numbers) {
  std::vector<std::string> items;
  for (const int number : numbers) items.push_back(ref(number));
  return list(items);
}

std::string typed(std::string_view type, const std::string& value) { return std::string(type) + "(" + value + ")"; }

}  // namespace step

int StepWriter::add(std::string_view type, const std::vector<std::string>& attributes) {
  lines_ += step::ref(++count_) + "=" + std::string(type) + step::list(attributes) + ";\n";
  return count_;
}

}  // namespace plumbline::bim
