// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bim/errors.h"
#include "slam/io/bags/record_queue.h"
#include "slam/io/records.h"
#include "slam/io/second.h"

namespace plumbline::slam {

/// Tells records from before a clock was set: a computer starts in 1970, and leaps when it learns the time. Clocks that
/// stay near 0 are those of simulations, or of sensors that count from their start. One late stamp alone is no leap.
class UnsetClock {
 public:
  /// The stamp of the next cloud, from the first on; false once no other is needed.
  [[nodiscard]] bool add(Nanoseconds stamp) {
    late_in_a_row_ = stamp >= year_2000 ? late_in_a_row_ + 1 : 0;
    return ++looked_at_ < most_looked_at && late_in_a_row_ < least_late;
  }
  /// Whether a record of this stamp is from before the clock was set.
  [[nodiscard]] bool leaves_out(Nanoseconds stamp) const { return stamp < 0 || (is_set() && stamp < year_2000); }
  /// False of a record that is left out. Throws InputError where the clock was set after records of the topic that were
  /// taken.
  [[nodiscard]] bool takes(Nanoseconds stamp, const std::string& topic) {
    Count& count = counts_[topic];
    ++count.all;
    if (leaves_out(stamp)) {
      ++count.left_out;
      return false;
    }
    if (stamp < year_2000) {
      ++count.early;
      count.late_in_a_row = 0;
    } else if (++count.late_in_a_row >= least_late && count.early > 0) {
      throw InputError({}, "stamps on " + topic + " leap to this century, as the clock was set after " +
                               std::to_string(count.early) + " records; cut these out");
    }
    return true;
  }
  /// What was, a sentence a topic.
  [[nodiscard]] std::vector<std::string> left_out() const {
    std::vector<std::string> said;
    for (const auto& [topic, count] : counts_)
      if (count.left_out > 0)
        said.push_back(topic + ": " + share_of(count.left_out, count.all, "records") +
                       " left out: stamped before 2000, when the clock was not set");
    return said;
  }

 private:
  static constexpr Nanoseconds year_2000 = 946'684'800 * second_ns;
  static constexpr int most_looked_at = 300;  // half a minute
  static constexpr std::int64_t least_late = 2;

  struct Count {
    std::int64_t all = 0, left_out = 0;
    std::int64_t early = 0;  ///< taken, though before 2000
    std::int64_t late_in_a_row = 0;
  };

  /// Two clouds in a row are late, or the only one is.
  [[nodiscard]] bool is_set() const {
    return late_in_a_row_ >= least_late || (late_in_a_row_ > 0 && late_in_a_row_ == looked_at_);
  }

  std::int64_t late_in_a_row_ = 0, looked_at_ = 0;  ///< clouds
  std::map<std::string, Count> counts_;
};

}  // namespace plumbline::slam
