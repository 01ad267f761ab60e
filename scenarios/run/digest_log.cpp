// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/digest_log.h"

#include <algorithm>
#include <charconv>

#include "bim/digest/digest.h"
#include "bim/errors.h"

namespace plumbline::scenarios {

namespace {

constexpr std::string_view header = "tick_ns,stage,digest";

DigestEntry parse_entry(std::string_view line, const Mark& mark) {
  const std::size_t first = line.find(',');
  const std::size_t second = line.rfind(',');
  DigestEntry entry;
  bool good = first != std::string_view::npos && second > first;
  if (good) {
    const std::string_view tick = line.substr(0, first);
    const std::string_view digest = line.substr(second + 1);
    const auto [tick_end, tick_error] = std::from_chars(tick.data(), tick.data() + tick.size(), entry.tick);
    const auto [end, error] = std::from_chars(digest.data(), digest.data() + digest.size(), entry.digest, 16);
    good = tick_error == std::errc() && tick_end == tick.data() + tick.size() && error == std::errc() &&
           end == digest.data() + digest.size();
    entry.stage = line.substr(first + 1, second - first - 1);
  }
  if (!good) throw InputError(mark, "a line 'tick_ns,stage,digest' is expected");
  return entry;
}

}  // namespace

DigestLog merge_logs(const std::vector<DigestLog>& logs) {
  DigestLog merged;
  for (const DigestLog& log : logs) merged.insert(merged.end(), log.begin(), log.end());
  std::stable_sort(merged.begin(), merged.end(),
                   [](const DigestEntry& a, const DigestEntry& b) { return a.tick < b.tick; });
  return merged;
}

std::uint64_t digest_of(const DigestLog& log) {
  Digest digest;
  for (const DigestEntry& entry : log) digest.add(entry.tick).add(std::string_view(entry.stage)).add(entry.digest);
  return digest.value();
}

std::map<std::string, std::uint64_t> digests_by_part(const DigestLog& log) {
  std::map<std::string, DigestLog> parts;
  for (const DigestEntry& entry : log) {
    const std::size_t slash = entry.stage.find('/');
    parts[slash == std::string::npos ? std::string(sensor_part) : entry.stage.substr(0, slash)].push_back(entry);
  }
  std::map<std::string, std::uint64_t> digests;
  for (const auto& [part, entries] : parts) digests[part] = digest_of(entries);
  return digests;
}

std::string write_digests(const DigestLog& log) {
  std::string text = std::string(header) + "\n";
  for (const DigestEntry& entry : log)
    text += std::to_string(entry.tick) + "," + entry.stage + "," + hex64(entry.digest) + "\n";
  return text;
}

DigestLog read_digests(std::string_view text, const std::string& file) {
  DigestLog log;
  int line_number = 0;
  while (!text.empty()) {
    const Mark mark{file, ++line_number, 1};
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) throw InputError(mark, "the file ends in the middle of a line");
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    if (line_number == 1) {
      if (line != header) throw InputError(mark, "the first line must be '" + std::string(header) + "'");
      continue;
    }
    log.push_back(parse_entry(line, mark));
  }
  return log;
}

std::optional<Difference> first_difference(const DigestLog& a, const DigestLog& b) {
  const std::size_t shared = std::min(a.size(), b.size());
  for (std::size_t i = 0; i < shared; ++i) {
    if (a[i].tick != b[i].tick) {
      const DigestEntry& entry = a[i].tick < b[i].tick ? a[i] : b[i];
      return Difference{entry.tick, entry.stage, a[i].tick < b[i].tick ? "only in the first" : "only in the second"};
    }
    if (a[i].stage != b[i].stage)
      return Difference{a[i].tick, a[i].stage, "stands in the first where the second has " + b[i].stage};
    if (a[i].digest != b[i].digest)
      return Difference{a[i].tick, a[i].stage,
                        hex64(a[i].digest) + " in the first, " + hex64(b[i].digest) + " in the second"};
  }
  if (a.size() == b.size()) return std::nullopt;
  const DigestEntry& entry = a.size() > shared ? a[shared] : b[shared];
  return Difference{entry.tick, entry.stage, std::string("only in the ") + (a.size() > shared ? "first" : "second")};
}

}  // namespace plumbline::scenarios
