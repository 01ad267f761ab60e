// SPDX-License-Identifier: Apache-2.0
#include "slam/io/clouds/cloud_times.h"

#include <charconv>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <utility>

#include "bim/config/input_file.h"
#include "bim/config/utf8.h"
#include "bim/config/words.h"
#include "bim/errors.h"
#include "slam/io/recordings/tum.h"
#include "slam/io/second.h"

namespace plumbline::slam {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t most_times_bytes = std::uint64_t{1} << 28U;

/// The number that a part of the text is.
std::optional<int> whole(std::string_view text, std::size_t at, std::size_t digits) {
  int value = 0;
  const char* end = text.data() + at + digits;
  const auto [stop, error] = std::from_chars(text.data() + at, end, value);
  return error == std::errc() && stop == end && value >= 0 ? std::optional(value) : std::nullopt;
}

/// "2011-09-26 13:02:25.594360375", or with a T in the middle.
std::optional<Nanoseconds> parse_date(std::string_view text) {
  constexpr std::size_t least = 19, seconds_at = 17;
  if (text.size() < least || text[4] != '-' || text[7] != '-' || (text[10] != ' ' && text[10] != 'T') ||
      text[13] != ':' || text[16] != ':')
    return std::nullopt;
  const auto year = whole(text, 0, 4), month = whole(text, 5, 2), day = whole(text, 8, 2);
  const auto hour = whole(text, 11, 2), minute = whole(text, 14, 2);
  Nanoseconds in_minute = 0;
  if (!year || !month || !day || !hour || !minute || !parse_stamp(text.substr(seconds_at), in_minute) ||
      in_minute < 0 || in_minute > 60 * second_ns || *hour > 23 || *minute > 59 || *year < 1970 || *year > 2095)
    return std::nullopt;
  const std::chrono::year_month_day date(std::chrono::year(*year), std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day)));
  if (!date.ok()) return std::nullopt;
  const std::int64_t days = std::chrono::sys_days(date).time_since_epoch().count();
  return ((days * 24 + *hour) * 60 + *minute) * 60 * second_ns + in_minute;
}

/// The digits before the ending: 7 of scan_0007.bin.
std::optional<std::size_t> number_of(std::string_view name) {
  const std::string_view stem = name.substr(0, name.find('.'));
  const std::size_t before = stem.find_last_not_of("0123456789");
  const std::string_view digits = before == std::string_view::npos ? stem : stem.substr(before + 1);
  std::size_t value = 0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return error == std::errc() && !digits.empty() ? std::optional(value) : std::nullopt;
}

/// "1700000000", "1700000000.5", "1700000000_500000000" or the same in ms, us or ns.
std::optional<Nanoseconds> stamp_in(std::string_view name) {
  constexpr std::string_view digits = "0123456789";
  constexpr std::size_t of_seconds = 10, of_nanoseconds = 9;
  const std::string_view whole = name.substr(0, name.find_first_not_of(digits));
  std::string_view rest = name.substr(whole.size());
  Nanoseconds value = 0;
  if (whole.size() < of_seconds || whole.front() == '0' ||
      std::from_chars(whole.data(), whole.data() + whole.size(), value).ec != std::errc())
    return std::nullopt;
  if (whole.size() != of_seconds) {
    Nanoseconds unit = 0;
    for (const auto& [size, ns] : {std::pair<std::size_t, Nanoseconds>{13, 1'000'000}, {16, 1'000}, {19, 1}})
      if (whole.size() == size) unit = ns;
    return unit > 0 && value < furthest_stamp / unit && rest.starts_with('.') ? std::optional(value * unit)
                                                                              : std::nullopt;
  }
  if (value >= furthest_stamp / second_ns) return std::nullopt;
  value *= second_ns;
  if (rest.empty() || (rest.front() != '.' && rest.front() != '_')) return std::nullopt;
  const bool parts = rest.front() == '_';
  rest.remove_prefix(1);
  std::string fraction(rest.substr(0, rest.find_first_not_of(digits)));
  if (!rest.substr(fraction.size()).starts_with('.') && !(fraction.empty() && !parts)) return std::nullopt;
  if (fraction.size() > of_nanoseconds || (parts && fraction.size() != of_nanoseconds)) return std::nullopt;
  fraction.resize(of_nanoseconds, '0');
  return value + std::stoll(fraction);
}

}  // namespace

std::vector<Nanoseconds> stamps_in(const std::vector<std::string>& names) {
  std::vector<Nanoseconds> stamps;
  for (const std::string& name : names) {
    std::optional<Nanoseconds> stamp = stamp_in(name);
    // As nuScenes has it: a name before the stamp.
    if (const std::size_t bar = name.rfind('_'); !stamp && bar != std::string::npos)
      stamp = stamp_in(std::string_view(name).substr(bar + 1));
    if (!stamp || (!stamps.empty() && *stamp <= stamps.back())) return {};
    stamps.push_back(*stamp);
  }
  return stamps.size() < 2 ? std::vector<Nanoseconds>{} : stamps;
}

std::vector<Nanoseconds> read_cloud_times(std::string_view text, const std::string& file) {
  std::vector<Nanoseconds> stamps;
  text = without_byte_order_mark(text);
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = without_blanks(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.empty() || line.front() == '#') continue;
    Nanoseconds stamp = 0;
    if (const auto date = parse_date(line))
      stamp = *date;
    else if (!parse_stamp(line, stamp) || stamp < 0)
      throw InputError({file, number, 1},
                       "no time of a cloud; seconds from 0 on or 2011-09-26 13:02:25.594360375 would be right");
    stamps.push_back(stamp);
  }
  return stamps;
}

std::optional<CloudTimes> find_cloud_times(const std::string& folder) {
  const fs::path here = fs::absolute(folder).lexically_normal();
  const fs::path above = here.has_filename() ? here.parent_path() : here.parent_path().parent_path();
  for (const fs::path& place : {fs::path(folder), above})
    for (const std::string_view name : names_of_times) {
      const std::string file = (place / name).string();
      std::error_code error;
      if (fs::is_regular_file(file, error))
        return CloudTimes{file, read_cloud_times(read_text_file(file, most_times_bytes), file)};
    }
  return std::nullopt;
}

std::vector<Nanoseconds> stamps_of(const std::vector<std::string>& names, const CloudTimes& times) {
  if (names.size() == times.stamps.size()) return times.stamps;
  std::vector<Nanoseconds> stamps;
  for (const std::string& name : names) {
    const std::optional<std::size_t> number = number_of(name);
    if (!number || *number >= times.stamps.size())
      throw InputError({times.file, 0, 0}, "holds " + std::to_string(times.stamps.size()) + " times for " +
                                               std::to_string(names.size()) + " clouds, and none for '" +
                                               name.substr(0, 80) + "'");
    stamps.push_back(times.stamps[*number]);
  }
  return stamps;
}

}  // namespace plumbline::slam
