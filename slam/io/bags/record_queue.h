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
#include "slam/io/clock_set_back.h"
#include "slam/io/records.h"

namespace plumbline::slam {

/// "2 of 7 scans"
[[nodiscard]] inline std::string share_of(std::int64_t some, std::int64_t all, std::string_view what) {
  return std::to_string(some) + " of " + std::to_string(all) + " " + std::string(what);
}

/// Records of one topic in time order. A record with the stamp of the one before it is left out, and so is one that
/// comes later than newer ones; where a clock was set back, what follows belongs to another recording. So is one that
/// leaps ahead, where the record after it goes on from the one before it.
template <class Record>
class RecordQueue {
 public:
  /// False where the record is left out.
  bool add(const Record& record, std::string_view topic) {
    if (goes_on_before_last(record.stamp)) leave_out_last(record.stamp);
    const Nanoseconds back = last_.value_or(record.stamp) - record.stamp;
    check_not_set_back(back, {}, "stamps on " + std::string(topic));
    ++read_;
    if (last_ && back == 0) ++repeated_;
    if (back > 0) {
      ++late_;
      most_late_ = std::max(most_late_, back);
    }
    if (last_ && record.stamp <= *last_) return false;
    before_last_ = last_;
    last_ = record.stamp;
    records_.push_back(record);
    return true;
  }
  /// Counts a record that cannot be used.
  void leave_out() {
    ++read_;
    ++impossible_;
  }
  /// Takes back the records from t on, as if they had not come.
  void take_back_from(Nanoseconds t) {
    for (; !records_.empty() && records_.back().stamp >= t; records_.pop_back()) last_ = before_last_ = std::nullopt;
  }
  /// What was, nothing where all could be used. what: records of this kind.
  [[nodiscard]] std::vector<std::string> left_out(std::string_view topic, std::string_view what) const {
    std::vector<std::string> said;
    const auto records = [&](std::int64_t count) {
      return std::string(topic) + ": " + std::to_string(count) + (count == 1 ? " record" : " records") + " left out, ";
    };
    if (late_ > 0) said.push_back(records(late_) + "as stamps go back by up to " + words_of(most_late_));
    if (ahead_ > 0)
      said.push_back(records(ahead_) + "with stamps up to " + words_of(most_ahead_) + " ahead of those that follow");
    if (impossible_ > 0)
      said.push_back(std::string(topic) + ": " + share_of(impossible_, read_, what) +
                     " left out: numbers that are not finite, or no rotation");
    if (repeated_ > 0)
      said.push_back(std::string(topic) + ": " + share_of(repeated_, read_, what) +
                     " left out: same stamp as the one before");
    return said;
  }
  [[nodiscard]] std::int64_t read() const { return read_; }
  [[nodiscard]] std::int64_t lost() const { return late_ + repeated_ + ahead_ + impossible_; }
  [[nodiscard]] std::int64_t impossible() const { return impossible_; }
  /// More than so many records, and all of one stamp.
  [[nodiscard]] bool stands_still(std::int64_t more_than) const {
    return read_ > more_than && repeated_ == read_ - impossible_ - 1;
  }
  [[nodiscard]] bool reaches(Nanoseconds t) const {
    const std::optional<Nanoseconds>& sure = is_last_doubtful() ? before_last_ : last_;
    return sure && *sure >= t;
  }
  /// The last record leaps ahead, and whether those after it do is not known.
  [[nodiscard]] bool is_last_doubtful() const {
    return !records_.empty() && before_last_ && *last_ - *before_last_ > least_leap;
  }
  [[nodiscard]] const std::optional<Nanoseconds>& last() const { return last_; }  ///< stamp
  [[nodiscard]] const std::optional<Nanoseconds>& before_last() const { return before_last_; }
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
  static constexpr Nanoseconds least_leap = 500'000'000;

  [[nodiscard]] static std::string words_of(Nanoseconds t) {
    std::array<char, 32> text{};
    const double ms = 1e-6 * static_cast<double>(t);
    std::snprintf(text.data(), text.size(), ms < 1000.0 ? "%.3g ms" : "%.3g s", ms < 1000.0 ? ms : 1e-3 * ms);
    return text.data();
  }
  /// Much nearer to the record before the last one than to that one; two that were swapped are not.
  [[nodiscard]] bool goes_on_before_last(Nanoseconds t) const {
    return is_last_doubtful() && t > *before_last_ && 2 * (t - *before_last_) < *last_ - t;
  }
  void leave_out_last(Nanoseconds t) {
    ++ahead_;
    most_ahead_ = std::max(most_ahead_, *last_ - t);
    records_.pop_back();
    last_ = std::exchange(before_last_, std::nullopt);
  }

  std::deque<Record> records_;
  std::optional<Nanoseconds> last_, before_last_;  ///< stamps
  std::int64_t read_ = 0, repeated_ = 0, late_ = 0, ahead_ = 0, impossible_ = 0;
  Nanoseconds most_late_ = 0, most_ahead_ = 0;
};

}  // namespace plumbline::slam
