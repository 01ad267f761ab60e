// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_entities.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

#include "bim/formats/ifc/step/step_string.h"

namespace plumbline::bim {
namespace {

using Kind = StepValue::Kind;

/// Takes "(...)" apart. Nesting is bounded by check_step_text().
class ValueReader {
 public:
  ValueReader(std::string_view text, Mark mark) : text_(text), mark_(std::move(mark)) {}

  StepValue read() {
    skip_blanks();
    if (at_ >= text_.size()) fail();
    StepValue value;
    value.mark = mark_;
    const char c = text_[at_];
    if (c == '(') {
      value.kind = Kind::list;
      read_items(value.items);
    } else if (c == '\'') {
      value.kind = Kind::text;
      value.text = read_string();
    } else if (c == '$' || c == '*') {
      ++at_;
    } else if (c == '.') {
      value.kind = Kind::enumeration;
      const std::size_t end = text_.find('.', at_ + 1);
      if (end == std::string_view::npos) fail();
      value.text = text_.substr(at_ + 1, end - at_ - 1);
      at_ = end + 1;
    } else if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      read_typed(value);
    } else {
      read_number(value);
    }
    skip_blanks();
    return value;
  }

 private:
  [[noreturn]] void fail() const { throw InputError(mark_, "the attributes of this entity are malformed"); }

  void skip_blanks() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }

  bool take(char c) {
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  void read_items(std::vector<StepValue>& items) {
    ++at_;
    skip_blanks();
    if (take(')')) return;
    do items.push_back(read());
    while (take(','));
    if (!take(')')) fail();
  }

  std::string read_string() {
    const std::size_t begin = ++at_;
    for (;; ++at_) {
      at_ = text_.find('\'', at_);
      if (at_ == std::string_view::npos) fail();
      if (at_ + 1 >= text_.size() || text_[at_ + 1] != '\'') break;
      ++at_;
    }
    return text_of_step(text_.substr(begin, at_++ - begin));
  }

  void read_typed(StepValue& value) {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_'))
      ++at_;
    value.kind = Kind::typed;
    value.text = text_.substr(begin, at_ - begin);
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != '(') fail();
    read_items(value.items);
    if (value.items.size() != 1) fail();
  }

  void read_number(StepValue& value) {
    value.kind = take('#') ? Kind::reference : Kind::number;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value.number);
    if (error != std::errc() || !std::isfinite(value.number)) fail();
    at_ = static_cast<std::size_t>(end - text_.data());
  }

  std::string_view text_;
  Mark mark_;
  std::size_t at_ = 0;
};

[[noreturn]] void fail_kind(const StepValue& value, const char* expected) {
  throw InputError(value.mark, std::string("an attribute of this entity should be ") + expected);
}

}  // namespace

double StepValue::as_number() const {
  if (kind != Kind::number) fail_kind(*this, "a number");
  return number;
}

int StepValue::as_integer() const {
  const double v = as_number();
  if (v != std::floor(v) || std::abs(v) > std::numeric_limits<int>::max()) fail_kind(*this, "a whole number");
  return static_cast<int>(v);
}

std::int64_t StepValue::as_reference() const {
  if (kind != Kind::reference || !(number > 0.0 && number <= std::numeric_limits<int>::max()))
    fail_kind(*this, "a reference");
  return static_cast<std::int64_t>(number);
}

const std::string& StepValue::as_text() const {
  if (kind != Kind::text && kind != Kind::enumeration) fail_kind(*this, "text");
  return text;
}

bool StepValue::as_flag() const {
  if (kind != Kind::enumeration || (text != "T" && text != "F")) fail_kind(*this, ".T. or .F.");
  return text == "T";
}

const std::vector<StepValue>& StepValue::as_list() const& {
  if (kind != Kind::list) fail_kind(*this, "a list");
  return items;
}

std::vector<StepValue> StepValue::as_list() && {
  if (kind != Kind::list) fail_kind(*this, "a list");
  return std::move(items);
}

const StepValue& StepValue::as_typed() const {
  if (kind != Kind::typed) fail_kind(*this, "a value with its type");
  return items.front();
}

const StepValue& StepValue::at(std::size_t index) const& {
  if (index >= as_list().size()) fail_kind(*this, "there, and is not");
  return items[index];
}

StepValue StepValue::at(std::size_t index) && {
  const StepValue& self = *this;
  if (index >= self.as_list().size()) fail_kind(self, "there, and is not");
  return std::move(items[index]);
}

StepEntities::StepEntities(std::string_view text, const std::string& file) : file_(file) {
  // Entities begin at a '#' outside of strings and brackets and end with a semicolon there.
  int line = 1, depth = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '\n') ++line;
    if (c == '\'') at = std::min(text.find('\'', at + 1), text.size() - 1);
    if (c == '(') ++depth;
    if (c == ')') --depth;
    if (c != '#' || depth != 0) continue;
    Entity entity;
    entity.line = line;
    const auto [end, error] = std::from_chars(text.data() + at + 1, text.data() + text.size(), entity.number);
    const std::size_t equals = text.find('=', at), bracket = text.find('(', at);
    if (error != std::errc() || equals == std::string_view::npos || bracket == std::string_view::npos) continue;
    std::size_t first = equals + 1, last = bracket;
    while (first < last && std::isspace(static_cast<unsigned char>(text[first])) != 0) ++first;
    while (last > first && std::isspace(static_cast<unsigned char>(text[last - 1])) != 0) --last;
    entity.type = text.substr(first, last - first);
    entity.attributes = text.substr(bracket);
    entities_.push_back(entity);
    at = bracket - 1;
  }
  std::stable_sort(entities_.begin(), entities_.end(),
                   [](const Entity& a, const Entity& b) { return a.number < b.number; });
}

const StepEntities::Entity& StepEntities::entity(std::int64_t number) const {
  const auto found = std::lower_bound(entities_.begin(), entities_.end(), number,
                                      [](const Entity& e, std::int64_t value) { return e.number < value; });
  if (found == entities_.end() || found->number != number)
    throw InputError({file_, 0, 0}, "#" + std::to_string(number) + " is not in the file");
  return *found;
}

StepValue StepEntities::attributes(const Entity& entity) const {
  return ValueReader(entity.attributes, {file_, entity.line, 0}).read();
}

StepValue StepEntities::attributes(const StepValue& reference, std::string_view type) const {
  const Entity& found = entity(reference.as_reference());
  if (found.type != type)
    throw InputError({file_, found.line, 0},
                     "this should be " + std::string(type) + ", not " + std::string(found.type));
  return attributes(found);
}

}  // namespace plumbline::bim
