// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/mesh/ply_check.h"

#include <charconv>
#include <cstdint>
#include <vector>

#include "bim/config/words.h"
#include "bim/errors.h"
#include "bim/ply_types.h"

namespace plumbline::bim {

namespace {

struct Element {
  Mark mark;
  std::string name;
  std::uint64_t count = 0;
  std::uint64_t least_bytes = 0;  ///< of one; of a list the length alone
};

using Words = std::vector<std::string_view>;

class Header {
 public:
  Header(std::string_view bytes, const std::string& path) : rest_(bytes), mark_{path, 0, 0} {
    if (next_line() != Words{"ply"}) fail("a .ply file begins with 'ply'");
    read_format(next_line());
    for (Words words = next_line(); words != Words{"end_header"}; words = next_line()) read(words);
  }

  /// Each element's least size against what is left of the file.
  void check_sizes() const {
    std::uint64_t left = rest_.size();
    if (!binary_ && !rest_.empty()) ++left;  // the last number may end with the file
    for (const Element& element : elements_) {
      if (element.count > 0 && element.least_bytes == 0)
        throw InputError(element.mark, "element '" + element.name + "' has no property");
      if (element.count > 0 && element.count > left / element.least_bytes)
        throw InputError(element.mark, std::to_string(element.count) + " elements '" + element.name + "' take " +
                                           std::to_string(element.least_bytes) +
                                           " bytes each at least, and the file has " + std::to_string(left) +
                                           " bytes for them");
      left -= element.count * element.least_bytes;
    }
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(mark_, what); }

  /// Words of the next line that is no comment.
  Words next_line() {
    constexpr std::size_t longest = std::size_t{1} << 16U;
    constexpr int most_lines = 10'000;
    while (true) {
      const std::size_t end = rest_.substr(0, longest).find('\n');
      ++mark_.line;
      if (end == std::string_view::npos || mark_.line > most_lines)
        fail("the header does not end; its last line must be 'end_header'");
      const Words words = split_words(rest_.substr(0, end));
      rest_.remove_prefix(end + 1);
      if (!words.empty() && words.front() != "comment" && words.front() != "obj_info") return words;
    }
  }

  void read_format(const Words& words) {
    const bool known = words.size() == 3 && words[0] == "format" &&
                       (words[1] == "ascii" || words[1] == "binary_little_endian" || words[1] == "binary_big_endian");
    if (!known)
      fail(
          "the format must be 'format ascii 1.0', 'format binary_little_endian 1.0' or 'format binary_big_endian 1.0'");
    binary_ = words[1] != "ascii";
  }

  void read(const Words& words) {
    if (words.front() == "element" && words.size() == 3) {
      elements_.push_back({mark_, std::string(words[1].substr(0, 40)), number(words[2]), 0});
      return;
    }
    const bool list = words.size() == 5 && words[1] == "list";
    if (words.front() != "property" || (words.size() != 3 && !list))
      fail(
          "a line of the header must be 'element NAME COUNT', 'property TYPE NAME', 'property list TYPE TYPE NAME' or "
          "'end_header'");
    if (elements_.empty()) fail("a property before the first element");
    const std::uint64_t bytes = size_of(words[list ? 2 : 1]);
    if (list) (void)size_of(words[3]);
    elements_.back().least_bytes += binary_ ? bytes : 2;  // a digit and what parts it from the next
  }

  [[nodiscard]] std::uint64_t number(std::string_view text) const {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      fail("'" + std::string(text.substr(0, 40)) + "' is no number of elements");
    return value;
  }

  [[nodiscard]] std::uint64_t size_of(std::string_view name) const {
    if (const std::uint32_t bytes = ply_type_bytes(name); bytes > 0) return bytes;
    fail("'" + std::string(name.substr(0, 40)) + "' is no type of a .ply file; float would be right");
  }

  std::string_view rest_;
  Mark mark_;
  bool binary_ = false;
  std::vector<Element> elements_;
};

}  // namespace

void check_ply(std::string_view bytes, const std::string& path) { Header(bytes, path).check_sizes(); }

}  // namespace plumbline::bim
