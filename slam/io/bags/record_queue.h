// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bim/errors.h"
#include "slam/io/records.h"

namespace plumbline::slam {

/// "2 of 7 scans"
[[nodiscard]] inline std::string share_of(std::int64_t some, std::int64_t all, std::string_view what) {
  return std::to_string(some) + " of " + std::to_string(all) + " " + std::string(what);
}

/// Records of one topic in time order. A record with the stamp of the one before it is left out, and so is one that
/// comes later than newer ones; where a clock was set back, what follows belongs to another recording.
template <class Record>
class RecordQueue {
 public:
  /// False where the record is left out.
  bool add(const Record& record, std::string_view topic) {
    const Nanoseconds back = last_.value_or(record.stamp) - record.stamp;
    if (back > most_back)
      throw InputError({}, "stamps on " + std::string(topic) + " go back by " + std::to_string(back / 1'000'000) +
                               " ms; records that come late by at most " + std::to_string(most_back / 1'000'000) +
                               " ms would be left out");
    ++read_;
    if (last_ && back == 0) ++repeated_;
    if (back > 0) {
      ++late_;
      most_late_ = std::max(most_late_, back);
    }
    if (last_ && record.stamp <= *last_) return false;
    last_ = record.stamp;
    records_.push_back(record);
    return true;
  }
  /// What was, nothing where all could be used. what: records of this kind.
  [[nodiscard]] std::vector<std::string> left_out(std::string_view topic, std::string_view what) const {
    std::vector<std::string> said;
    if (late_ > 0) {
      std::array<char, 32> ms{};
      std::snprintf(ms.data(), ms.size(), "%.3g", 1e-6 * static_cast<double>(most_late_));
      said.push_back(std::string(topic) + ": " + std::to_string(late_) + (late_ == 1 ? " record" : " records") +
                     " left out, as stamps go back by up to " + ms.data() + " ms");
    }
    if (repeated_ > 0)
      said.push_back(std::string(topic) + ": " + share_of(repeated_, read_, what) +
                     " left out: same stamp as the one before");
    return said;
  }
  [[nodiscard]] std::int64_t read() const { return read_; }
  [[nodiscard]] std::int64_t lost() const { return late_ + repeated_; }
  /// More than so many records, and all of one stamp.
  [[nodiscard]] bool stands_still(std::int64_t more_than) const { return read_ > more_than && repeated_ == read_ - 1; }
  [[nodiscard]] bool reaches(Nanoseconds t) const { return last_ && *last_ >= t; }
  [[nodiscard]] const std::deque<Record>& records() const { return records_; }
  void take_until(Nanoseconds t, std::vector<Record>& out) {
    for (; !records_.empty() && records_.front().stamp <= t; records_.pop_front()) out.push_back(records_.front());
  }
  [[nodiscard]] Record take() {
    Record record = std::move(records_.front());
    records_.pop_front();
    return record;
  }

 private:
  static constexpr Nanoseconds most_back = 1'000'000'000;

  std::deque<Record> records_;
  std::optional<Nanoseconds> last_;
  std::int64_t read_ = 0, repeated_ = 0, late_ = 0;
  Nanoseconds most_late_ = 0;
};

}  // namespace plumbline::slam
