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
#include "slam/io/second.h"

namespace plumbline::slam {

/// The messages of a bag, counted by topic: what one has wrong is said with its number, as tools for bags count.
class NumberedMessages {
 public:
  NumberedMessages() = default;
  /// `source` must outlive this.
  explicit NumberedMessages(MessageSource& source) : source_(&source) {}

  /// From now on, from the start of the bag, those of these topics.
  void select(const std::vector<std::string>& topics) {
    source_->select(topics);
    numbers_.clear();
  }
  /// Throws InputError where a message was recorded at no possible time.
  [[nodiscard]] bool next(RawMessage& message) {
    if (!source_->next(message)) return false;
    ++numbers_[message.topic];
    if (message.time <= -furthest_stamp || message.time >= furthest_stamp)
      throw InputError({}, place_of(message) + "a time of recording more than 126 years from 1970");
    return true;
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
  [[nodiscard]] std::string place_of(const RawMessage& message) const {
    return "message " + std::to_string(numbers_.at(message.topic)) + " of topic '" +
           source_->topics()[message.topic].name + "': ";
  }

  MessageSource* source_ = nullptr;
  std::map<std::size_t, std::int64_t> numbers_;  ///< of each topic so far
};

}  // namespace plumbline::slam
