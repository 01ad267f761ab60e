// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_edits.h"

#include <algorithm>
#include <cmath>

#include "bim/config/tree.h"

namespace plumbline::bim {
namespace {

constexpr std::int64_t most_number = 2'000'000'000;

std::size_t line_breaks(std::string_view text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

StepEdits::StepEdits(const std::string& text, const StepEntities& entities) : text_(text) {
  if (!entities.all().empty()) next_ = entities.all().back().number + 1;
}

std::string_view StepEdits::whole(const StepEntities::Entity& entity) {
  const char* const begin = entity.type.data();
  const std::string_view rest(begin,
                              static_cast<std::size_t>(entity.attributes.data() - begin) + entity.attributes.size());
  int depth = 0;
  for (std::size_t at = entity.type.size(); at < rest.size(); ++at) {
    if (rest[at] == '\'') at = rest.find('\'', at + 1);
    if (at >= rest.size()) break;
    if (rest[at] == '(') ++depth;
    if (rest[at] == ')' && --depth == 0) return rest.substr(0, at + 1);
  }
  return rest;
}

void StepEdits::replace(const StepEntities::Entity& entity, const std::string& by) {
  const std::string_view old = whole(entity);
  const auto begin = static_cast<std::size_t>(old.data() - text_.data());
  const std::size_t breaks = line_breaks(old), kept = line_breaks(by);
  replaced_[begin] = {begin + old.size(), by + std::string(breaks - std::min(kept, breaks), '\n')};
}

std::string StepEdits::add(const std::string& entity) {
  const std::string name = "#" + std::to_string(next_++);
  added_ += name + "=" + entity + ";\n";
  return name;
}

bool StepEdits::has_room(std::size_t entities) const {
  return next_ + static_cast<std::int64_t>(entities) <= most_number;
}

std::string StepEdits::done() const {
  std::string result;
  std::size_t at = 0;
  for (const auto& [begin, edit] : replaced_) {
    result.append(text_, at, begin - at).append(edit.second);
    at = edit.first;
  }
  result.append(text_, at, std::string::npos);
  const std::size_t end = added_.empty() ? std::string::npos : result.rfind("ENDSEC");
  return end == std::string::npos ? result : result.insert(end, added_);
}

std::string StepEdits::real(double v) {
  if (!std::isfinite(v)) throw InputError({}, "a number that is not finite; smaller numbers would be right");
  std::string text = format_number(v);
  std::replace(text.begin(), text.end(), 'e', 'E');
  const std::size_t exponent = std::min(text.find('E'), text.size());
  if (text.find('.') == std::string::npos) text.insert(exponent, ".");
  return text;
}

std::string step_argument(const StepValue& value) {
  switch (value.kind) {
    case StepValue::Kind::reference:
      return "#" + std::to_string(value.as_reference());
    case StepValue::Kind::number:
      return StepEdits::real(value.number);
    case StepValue::Kind::enumeration:
      return "." + value.text + ".";
    default:
      return "$";
  }
}

}  // namespace plumbline::bim
