// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bim/errors.h"
#include "slam/io/bags/ros_message.h"
#include "slam/io/ros2/message_source.h"

namespace plumbline::slam {

/// The messages of a bag, counted by topic: what one has wrong is said with its number, as tools for bags count. One
/// that was recorded at no possible time stands at a wrong place among the others, so it is left out.
class NumberedMessages {
 public:
  NumberedMessages() = default;
  /// `source` must outlive this.
  explicit NumberedMessages(MessageSource& source) : source_(&source) {}

  /// From now on, from the start of the bag, those of these topics.
  void select(const std::vector<std::string>& topics) {
    source_->select(topics);
    numbers_.clear();
    untimed_.clear();
  }
  /// Throws InputError at the end where more than half of a topic's messages were recorded at no possible time.
  [[nodiscard]] bool next(RawMessage& message) {
    while (next_of_any_time(message)) {
      if (is_possible_time(message.time)) return true;
      ++untimed_[message.topic];
    }
    for (const auto& [topic, count] : untimed_)
      if (2 * count > numbers_.at(topic)) throw InputError({}, said_of(topic, count) + "; at most half are left out");
    return false;
  }
  /// Of topics whose order means nothing.
  [[nodiscard]] bool next_of_any_time(RawMessage& message) {
    const bool found = source_->next(message);
    if (found) ++numbers_[message.topic];
    return found;
  }
  /// Since select(): what next() left out, a sentence a topic.
  [[nodiscard]] std::vector<std::string> left_out() const {
    std::vector<std::string> said;
    for (const auto& [topic, count] : untimed_) said.push_back(said_of(topic, count) + " and left out");
    return said;
  }

  /// What `function` throws about the message that came last, with the place of that, counted from 1.
  template <class F>
  [[nodiscard]] auto named(const RawMessage& message, const F& function) const {
    try {
      return function();
    } catch (const ros::ImpossibleNumber& error) {
      throw ros::ImpossibleNumber({}, place_of(message) + error.what());
    } catch (const InputError& error) {
      throw InputError({}, place_of(message) + error.what());
    }
  }

  /// Nothing where the message holds numbers that cannot be.
  template <class F>
  [[nodiscard]] auto possible(const RawMessage& message, const F& function) const
      -> std::optional<decltype(function())> {
    try {
      return named(message, function);
    } catch (const ros::ImpossibleNumber&) {
      return std::nullopt;
    }
  }

 private:
  [[nodiscard]] std::string said_of(std::size_t topic, std::int64_t count) const {
    return source_->topics()[topic].name + ": " + untimed_messages(count, numbers_.at(topic));
  }
  [[nodiscard]] std::string place_of(const RawMessage& message) const {
    return "message " + std::to_string(numbers_.at(message.topic)) + " of topic '" +
           source_->topics()[message.topic].name + "': ";
  }

  MessageSource* source_ = nullptr;
  std::map<std::size_t, std::int64_t> numbers_;  ///< of each topic so far
  std::map<std::size_t, std::int64_t> untimed_;  ///< of these, recorded at no possible time
};

}  // namespace plumbline::slam
