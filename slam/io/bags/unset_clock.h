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
/// stay near 0 are those of simulations.
class UnsetClock {
 public:
  /// The stamp of the next cloud, from the first on; false once no other is needed.
  [[nodiscard]] bool add(Nanoseconds stamp) {
    is_set_ = is_set_ || stamp >= year_2000;
    return !is_set_ && ++looked_at_ < most_looked_at;
  }
  /// False of a record that is left out. Throws InputError where the clock was set after records that were taken.
  [[nodiscard]] bool takes(Nanoseconds stamp, const std::string& topic) {
    Count& count = counts_[topic];
    ++count.all;
    if (stamp < 0 || (is_set_ && stamp < year_2000)) {
      ++count.before;
      return false;
    }
    if (!is_set_ && stamp >= year_2000 && count.all - count.before > 1)
      throw InputError({}, "stamps on " + topic + " leap to this century, as the clock was set after " +
                               std::to_string(count.all - 1) + " records; cut these out");
    return true;
  }
  /// What was, a sentence a topic.
  [[nodiscard]] std::vector<std::string> left_out() const {
    std::vector<std::string> said;
    for (const auto& [topic, count] : counts_)
      if (count.before > 0)
        said.push_back(topic + ": " + share_of(count.before, count.all, "records") +
                       " left out: stamped before 2000, when the clock was not set");
    return said;
  }

 private:
  static constexpr Nanoseconds year_2000 = 946'684'800 * second_ns;
  static constexpr int most_looked_at = 300;  // half a minute

  struct Count {
    std::int64_t all = 0, before = 0;
  };

  bool is_set_ = false;
  int looked_at_ = 0;
  std::map<std::string, Count> counts_;
};

}  // namespace plumbline::slam
