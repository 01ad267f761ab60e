// SPDX-License-Identifier: Apache-2.0
#include "slam/io/ros2/mcap_losses.h"

#include "slam/io/ros2/message_source.h"

namespace plumbline::slam::mcap {

void Losses::add_damaged(std::uint64_t at, std::uint64_t bytes, const InputError& why) {
  if (damaged.empty()) first_damage_ = why;
  damaged[at] = bytes;
}

void Losses::refuse_if_all_is_damaged() const {
  if (first_damage_ && !any_whole) throw InputError(*first_damage_);
}

std::vector<std::string> Losses::lines(std::uint64_t file_bytes) const {
  std::vector<std::string> lines;
  std::uint64_t damaged_bytes = 0;
  for (const auto& [at, bytes] : damaged) damaged_bytes += bytes;
  if (!damaged.empty())
    lines.push_back("damaged chunks are left out: " + std::to_string(damaged.size()) + " of " + std::to_string(chunks) +
                    ", " + std::to_string(damaged_bytes) + " of " + std::to_string(file_bytes) + " bytes");
  if (unclosed && messages_of_cut == 0) lines.push_back(not_closed(rest_bytes, file_bytes));
  if (unclosed && messages_of_cut > 0)
    lines.push_back("the bag was not closed or is cut off; of its last chunk, " + std::to_string(rest_bytes) + " of " +
                    std::to_string(file_bytes) + " bytes, the first " + std::to_string(messages_of_cut) +
                    " messages are read");
  return lines;
}

}  // namespace plumbline::slam::mcap
