// SPDX-License-Identifier: Apache-2.0
#include "slam/io/clouds/cloud_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <optional>
#include <vector>

#include "bim/config/file_ending.h"
#include "bim/config/words.h"
#include "bim/errors.h"
#include "bim/ply_types.h"

namespace plumbline::slam {

namespace {

constexpr std::uint64_t most_points = 4'000'000;
constexpr std::uint64_t most_bytes = std::uint64_t{1} << 30U;  ///< of all points
constexpr std::size_t most_fields = 64;
constexpr std::uint32_t most_numbers = 4096;  ///< of a point
constexpr std::size_t longest_line = 4095;
constexpr int most_lines = 256;

struct Line {
  std::vector<std::string_view> words;
  int number = 0;
};

/// Lines of a header, in words.
class HeaderLines {
 public:
  HeaderLines(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  [[nodiscard]] Line next() {
    const std::size_t end = bytes_.substr(at_, longest_line + 1).find('\n');
    if (end == std::string_view::npos || ++number_ > most_lines) fail("the header does not end");
    const std::string_view text = bytes_.substr(at_, end);
    at_ += end + 1;
    return {split_words(text), number_};
  }

  [[nodiscard]] std::size_t read() const { return at_; }
  [[noreturn]] void fail(const std::string& what) const { throw InputError({file_, std::max(number_, 1), 0}, what); }

  [[nodiscard]] std::uint32_t number(const Line& line, std::size_t word) const {
    std::uint32_t value = 0;
    const std::string_view text = word < line.words.size() ? line.words[word] : std::string_view();
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      fail("'" + std::string(text) + "' is no whole number from 0 on");
    return value;
  }

 private:
  std::string_view bytes_;
  const std::string& file_;
  std::size_t at_ = 0;
  int number_ = 0;
};

std::string quoted(std::string_view text) { return "'" + std::string(text.substr(0, 40)) + "'"; }

struct PcdField {
  std::string name;
  std::uint32_t size = 4;
  std::string type = "F";
  std::uint32_t count = 1;
};

/// Whether PCL has a type of this size.
bool is_number(const PcdField& field) {
  if (field.type == "F") return field.size == 4 || field.size == 8;
  return (field.type == "I" || field.type == "U") && (field.size == 1 || field.size == 2 || field.size == 4);
}

template <class Names>
void need_xyz(const Names& has, const HeaderLines& lines) {
  for (const char* name : {"x", "y", "z"})
    if (!has(name)) lines.fail("the points have no field '" + std::string(name) + "'");
}

class PcdHeader {
 public:
  explicit PcdHeader(HeaderLines& lines) : lines_(lines) {}

  [[nodiscard]] CloudHeader read() {
    for (Line line = lines_.next(); !take(line); line = lines_.next()) {
    }
    if (fields_.empty()) lines_.fail("no line FIELDS");
    if (!points_) lines_.fail("no line POINTS");
    header_.height = height_ ? *height_ : 1;
    header_.width = width_ ? *width_ : *points_;
    if (header_.points() != *points_) lines_.fail("POINTS is not WIDTH times HEIGHT");
    for (const PcdField& field : fields_) add(field);
    need_xyz(
        [&](const char* name) {
          return std::any_of(fields_.begin(), fields_.end(), [&](const PcdField& f) { return f.name == name; });
        },
        lines_);
    return header_;
  }

 private:
  /// True at the last line.
  bool take(const Line& line) {
    if (line.words.empty() || line.words[0].front() == '#') return false;
    const std::string_view key = line.words[0];
    if (key == "FIELDS" || key == "COLUMNS") {
      name_fields(line);
    } else if (key == "SIZE") {
      for (std::size_t k = 0; k < values(line); ++k) fields_[k].size = lines_.number(line, k + 1);
    } else if (key == "TYPE") {
      for (std::size_t k = 0; k < values(line); ++k) fields_[k].type = line.words[k + 1];
    } else if (key == "COUNT") {
      for (std::size_t k = 0; k < values(line); ++k) fields_[k].count = lines_.number(line, k + 1);
    } else if (key == "WIDTH") {
      width_ = lines_.number(line, 1);
    } else if (key == "HEIGHT") {
      height_ = lines_.number(line, 1);
    } else if (key == "POINTS") {
      points_ = lines_.number(line, 1);
    } else if (key == "DATA") {
      const std::string_view data = line.words.size() > 1 ? line.words[1] : std::string_view();
      if (data != "ascii" && data != "binary" && data != "binary_compressed")
        lines_.fail("DATA " + quoted(data) + "; ascii, binary or binary_compressed would be right");
      header_.data = data == "ascii" ? CloudData::ascii : data == "binary" ? CloudData::binary : CloudData::compressed;
      return true;
    } else if (key != "VERSION" && key != "VIEWPOINT") {
      lines_.fail("unknown line " + quoted(key));
    }
    return false;
  }

  void name_fields(const Line& line) {
    if (!fields_.empty()) lines_.fail("a second line FIELDS");
    if (line.words.size() > most_fields) lines_.fail("more than 63 fields");
    for (std::size_t k = 1; k < line.words.size(); ++k) fields_.push_back({std::string(line.words[k])});
  }

  /// How many values a line of one a field has.
  [[nodiscard]] std::size_t values(const Line& line) const {
    if (fields_.empty() || line.words.size() != fields_.size() + 1) lines_.fail("not one value a field");
    return fields_.size();
  }

  void add(const PcdField& field) {
    if (!is_number(field)) lines_.fail("field " + quoted(field.name) + " of no known type");
    if (field.count < 1 || field.count > most_numbers)
      lines_.fail("field " + quoted(field.name) + " of no known count");
    header_.numbers += field.count;
    header_.step += field.count * field.size;
    if (header_.numbers > most_numbers) lines_.fail("more than 4,096 numbers a point");
  }

  HeaderLines& lines_;
  CloudHeader header_;
  std::vector<PcdField> fields_;
  std::optional<std::uint32_t> width_, height_, points_;
};

class PlyHeader {
 public:
  explicit PlyHeader(HeaderLines& lines) : lines_(lines) {}

  [[nodiscard]] CloudHeader read() {
    if (const Line first = lines_.next(); first.words != words_of("ply")) lines_.fail("no PLY file");
    header_.format = CloudFormat::ply;
    header_.height = 1;
    for (Line line = lines_.next(); line.words != words_of("end_header"); line = lines_.next()) take(line);
    if (!formatted_ || element_ == Element::none) lines_.fail("no format, or no element vertex");
    // PCL would take them for the cloud's.
    if ((columns_ || rows_) && std::uint64_t{columns_.value_or(0)} * rows_.value_or(0) != header_.width)
      lines_.fail("obj_info num_cols times num_rows is not the number of vertices");
    need_xyz([&](const char* name) { return has(name); }, lines_);
    return header_;
  }

 private:
  enum class Element { none, vertex, other };

  static std::vector<std::string_view> words_of(std::string_view word) { return {word}; }
  [[nodiscard]] bool has(std::string_view name) const {
    return std::find(names_.begin(), names_.end(), name) != names_.end();
  }

  void take(const Line& line) {
    if (line.words.empty()) lines_.fail("an empty line in the header");
    const std::string_view key = line.words[0];
    const std::string_view first = line.words.size() > 1 ? line.words[1] : std::string_view();
    if (key == "format") {
      if (formatted_) lines_.fail("a second format");
      formatted_ = true;
      if (first != "ascii" && first != "binary_little_endian")
        lines_.fail("format " + quoted(first) + "; ascii or binary_little_endian would be right");
      header_.data = first == "ascii" ? CloudData::ascii : CloudData::binary;
    } else if (key == "obj_info") {
      if (first != "num_cols" && first != "num_rows") return;
      if (element_ != Element::none) lines_.fail("obj_info behind the vertices");
      (first == "num_cols" ? columns_ : rows_) = lines_.number(line, 2);
    } else if (key == "element") {
      begin_element(first, lines_.number(line, 2));
    } else if (key == "property") {
      add_property(line);
    } else if (key != "comment") {
      lines_.fail("unknown line " + quoted(key));
    }
  }

  /// The vertices come first. Behind them PCL writes a camera, and elements of which there are none.
  void begin_element(std::string_view name, std::uint32_t count) {
    if (element_ == Element::none && name == "vertex") {
      element_ = Element::vertex;
      header_.width = count;
    } else if (element_ != Element::none && name != "vertex" && (count == 0 || (count == 1 && name == "camera"))) {
      element_ = Element::other;
    } else {
      lines_.fail("element " + quoted(name) + "; only one, vertex, is read");
    }
  }

  void add_property(const Line& line) {
    if (element_ == Element::other) return;
    const std::uint32_t size = line.words.size() == 3 ? bim::ply_type_bytes(line.words[1]) : 0;
    if (element_ == Element::none || size == 0) lines_.fail("a property that is no plain number of vertices");
    const std::string_view name = line.words[2];
    if (names_.size() + 1 >= most_fields) lines_.fail("more than 63 properties");
    if (has(name)) lines_.fail("a second property " + quoted(name));
    if ((name == "green" || name == "blue" || name == "alpha") && !has("red")) lines_.fail("a colour without red");
    names_.push_back(name);
    header_.step += size;
    ++header_.numbers;
  }

  HeaderLines& lines_;
  CloudHeader header_;
  bool formatted_ = false;
  Element element_ = Element::none;
  std::vector<std::string_view> names_;
  std::optional<std::uint32_t> columns_, rows_;
};

/// Words of the text, counted up to a number.
std::uint64_t count_words(std::string_view text, std::uint64_t enough) {
  std::uint64_t words = 0;
  bool inside = false;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\t' || c == '\r' || c == '\n';
    if (!blank && !inside && ++words >= enough) break;
    inside = !blank;
  }
  return words;
}

/// Refuses a file that is too short for what it promises.
void check_size(const CloudHeader& header, std::string_view body, const HeaderLines& lines) {
  if (header.points() > most_points)
    lines.fail("promises " + std::to_string(header.points()) + " points; at most 4 million");
  const auto too_short = [&] {
    lines.fail("holds " + std::to_string(body.size()) + " bytes for " + std::to_string(header.points()) + " points");
  };
  const std::uint64_t bytes = header.points() * header.step;
  if (bytes > most_bytes) lines.fail("promises " + std::to_string(bytes) + " bytes of points; at most 1 GiB");
  switch (header.data) {
    case CloudData::binary:
      if (body.size() < bytes) too_short();
      break;
    case CloudData::ascii: {
      const std::uint64_t words = count_words(body, header.points() * header.numbers);
      if (words < header.points() * header.numbers)
        lines.fail("holds " + std::to_string(words) + " numbers for " + std::to_string(header.points()) +
                   " points of " + std::to_string(header.numbers));
      break;
    }
    case CloudData::compressed: {
      std::array<std::uint32_t, 2> sizes{};  // compressed and not
      if (header.points() == 0) break;
      if (body.size() < sizeof sizes) too_short();
      std::memcpy(sizes.data(), body.data(), sizeof sizes);
      if (sizes[0] > body.size() - sizeof sizes) too_short();
      if (sizes[1] != bytes)
        lines.fail("unpacks to " + std::to_string(sizes[1]) + " bytes instead of " + std::to_string(bytes));
      // LZF makes at most 264 bytes of 3.
      if (bytes > 100 * std::uint64_t{sizes[0]}) too_short();
      break;
    }
  }
}

}  // namespace

CloudHeader read_cloud_header(std::string_view bytes, CloudFormat format, const std::string& file) {
  HeaderLines lines(bytes, file);
  CloudHeader header = format == CloudFormat::ply ? PlyHeader(lines).read() : PcdHeader(lines).read();
  header.size = lines.read();
  check_size(header, bytes.substr(header.size), lines);
  return header;
}

bool is_cloud_file(std::string_view file) { return has_ending(file, ".pcd") || has_ending(file, ".ply"); }

CloudFormat cloud_format_of(const std::string& file) {
  if (!is_cloud_file(file)) throw InputError({file, 0, 0}, "no point cloud; a .pcd or .ply would be right");
  return has_ending(file, ".ply") ? CloudFormat::ply : CloudFormat::pcd;
}

}  // namespace plumbline::slam
