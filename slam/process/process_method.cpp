// SPDX-License-Identifier: Apache-2.0
#include "slam/process/process_method.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <span>
#include <utility>

#include "bim/config/utf8.h"
#include "slam/process/answers.h"
#include "slam/process/child.h"
#include "slam/process/client/plumbline_messages.h"
#include "slam/process/greeting.h"
#include "slam/process/shared_memory.h"
#include "slam/process/shortened.h"

namespace plumbline::slam {

namespace {

using Bytes = std::vector<std::byte>;

wire::Pose wire_of(const Pose& X) { return {{X.t.x(), X.t.y(), X.t.z()}, {X.q.x(), X.q.y(), X.q.z(), X.q.w()}}; }

std::string text_of(const Bytes& bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

struct Message {
  wire::Type type = wire::Type::fail;
  Bytes payload;
};

/// What stands in either half of the shared memory; most scans take 1.2 MB, the largest 10.
constexpr std::size_t half_bytes = 32U << 20U;

/// Characters of a reason to give up that are passed on: results, reports and terminals show it.
constexpr std::size_t longest_reason = 2000;

/// Bytes that a strict conversation takes beside an answer, printed or as lines for the log.
constexpr std::size_t most_beside = 16U << 20U;

/// One process and what is said to it.
class Conversation {
 public:
  Conversation(const ProcessCommand& command, const MethodInput& input)
      : command_(command),
        memory_(2 * half_bytes),
        child_(command.command, command.folder, environment_of(input), command.printed, memory_.descriptor(),
               command.go_on) {
    if (command.strict) child_.limit_printing(most_beside);
    child_.set_deadline(command.start_s);
    const std::string hello = greeting(command, input, memory_.bytes().size());
    send({wire::magic, static_cast<std::uint16_t>(wire::Type::hello), 0, hello.size()}, hello.data());
    shares_ = read_greeting(text_of(receive(wire::Type::hello_ok))).shared_memory && !memory_.bytes().empty();
  }

  /// The answer to a scan, whose message `write` writes.
  template <class Write>
  [[nodiscard]] Bytes ask_step(std::size_t size, const Write& write) {
    child_.set_deadline(command_.scan_s);
    wire::Head head{wire::magic, static_cast<std::uint16_t>(wire::Type::step), 0, size};
    if (shares_ && size <= half_bytes) {
      half_ = 1 - half_;
      write(memory_.bytes().subspan(half_ * half_bytes, size));
      head.memory = static_cast<std::uint16_t>(half_ + 1);
      child_.send(&head, sizeof head);
    } else {
      step_.resize(size);
      write(std::span(step_));
      send(head, step_.data());
    }
    return receive(wire::Type::output);
  }
  [[nodiscard]] Bytes ask_finish() {
    child_.set_deadline(command_.finish_s);
    send({wire::magic, static_cast<std::uint16_t>(wire::Type::finish), 0, 0}, nullptr);
    return receive(wire::Type::estimate);
  }
  [[nodiscard]] double cpu_ms() const { return child_.cpu_ms(); }
  void end() {
    constexpr double strict_s = 5.0;
    child_.set_deadline(command_.strict ? strict_s : command_.finish_s);
    const bool well = child_.close_and_wait(command_.strict);
    if (!command_.strict) return;
    if (child_.sent_more()) throw ProcessFailure("sends more after its estimate, which nobody reads");
    if (well) return;
    if (child_.ended()) throw ProcessFailure(child_.how_it_ended() + " after its last answer, where 0 is due");
    throw ProcessFailure(
        "did not end within 5 s of its last answer, or what it started did not; end when the connection is closed");
  }

 private:
  void send(const wire::Head& head, const void* payload) {
    child_.send(&head, sizeof head);
    child_.send(payload, head.size);
  }

  /// Lines for the log are passed over, as long as there is time.
  [[nodiscard]] Bytes receive(wire::Type wanted) {
    for (std::size_t logged = 0;;) {
      Message message = receive_one();
      if (message.type == wire::Type::log) {
        child_.check_time();
        logged += sizeof(wire::Head) + message.payload.size();
        if (command_.strict && logged > most_beside)
          throw ProcessFailure("sent more than " + std::to_string(most_beside >> 20U) +
                               " MiB of lines for the log in place of an answer");
        continue;
      }
      if (message.type == wire::Type::fail)
        throw ProcessFailure("gave up: " + shortened(utf8_of_bytes(text_of(message.payload)), longest_reason));
      if (message.type == wanted) return std::move(message.payload);
      throw ProcessFailure("answered with a message of type " + std::to_string(static_cast<int>(message.type)) +
                           " where " + std::to_string(static_cast<int>(wanted)) + " is due");
    }
  }

  [[nodiscard]] Message receive_one() {
    wire::Head head;
    child_.receive(&head, sizeof head);
    if (head.magic != wire::magic)
      throw ProcessFailure("sent what is no message: it begins with other bytes than PLB1");
    if (head.size > wire::max_payload)
      throw ProcessFailure("announces a message of " + std::to_string(head.size) + " bytes; at most 256 MiB are taken");
    Message message{static_cast<wire::Type>(head.type), {}};
    // Grown as it comes: a length alone allocates little.
    constexpr std::uint64_t chunk = 1U << 20U;
    while (message.payload.size() < head.size) {
      const std::size_t before = message.payload.size();
      message.payload.resize(before + std::min(chunk, head.size - before));
      child_.receive(message.payload.data() + before, message.payload.size() - before);
    }
    return message;
  }

  ProcessCommand command_;
  SharedMemory memory_;
  Child child_;
  bool shares_ = false;
  std::size_t half_ = 1;  ///< that was written last
  Bytes step_;            ///< of the last scan; its memory is used again
};

class ProcessMethod final : public Method {
 public:
  ProcessMethod(const ProcessCommand& command, const MethodInput& input) : command_(command) {
    with_context("at the start", [&] { first_.emplace(command, input); });
    if (command.repeat) with_context("at the second start", [&] { second_.emplace(command, input); });
  }

  void on_imu(const Imu& imu) override {
    const Eigen::Vector3d &w = imu.angular_velocity_R, &a = imu.linear_acceleration_R;
    imus_.push_back({imu.stamp, {w.x(), w.y(), w.z()}, {a.x(), a.y(), a.z()}});
  }
  void on_odometry(const Odometry& odometry) override {
    odometries_.push_back({odometry.stamp, wire_of(odometry.X_OR)});
  }

  [[nodiscard]] Output on_scan(const Scan& scan) override {
    ++scans_;
    Output output;
    char when[64];
    std::snprintf(when, sizeof when, "at scan %d (%.1f s)", scans_, seconds(scan.stamp));
    with_context(when, [&] {
      const double before_ms = first_->cpu_ms();
      const Bytes answer = ask_step(*first_, scan);
      if (command_.answered) command_.answered(answer);
      output = read_output(answer, scan.stamp, command_.needs_plan);
      output.times.push_back({"process", std::max(0.0, first_->cpu_ms() - before_ms)});
      if (second_ && ask_step(*second_, scan) != answer)
        throw ProcessFailure("does not repeat: a second process answers the same records otherwise");
    });
    imus_.clear();
    odometries_.clear();
    return output;
  }

  [[nodiscard]] Estimate finish() override {
    Estimate estimate;
    with_context("at the end", [&] {
      const Bytes answer = first_->ask_finish();
      if (command_.answered) command_.answered(answer);
      estimate = read_estimate(answer, command_.needs_plan, command_.strict);
      if (second_ && second_->ask_finish() != answer)
        throw ProcessFailure("does not repeat: a second process gives another estimate");
      first_->end();
      if (second_) second_->end();
    });
    return estimate;
  }

 private:
  template <class Work>
  void with_context(const std::string& when, const Work& work) const {
    try {
      work();
    } catch (const ProcessFailure& failure) {
      throw ProcessFailure("'" + command_.command.front() + "' " + when + ": " + failure.what());
    }
  }

  [[nodiscard]] Bytes ask_step(Conversation& conversation, const Scan& scan) const {
    const wire::Step step{scan.stamp,
                          static_cast<std::uint32_t>(imus_.size()),
                          static_cast<std::uint32_t>(odometries_.size()),
                          static_cast<std::uint32_t>(scan.size()),
                          static_cast<std::uint16_t>(scan.rings),
                          static_cast<std::uint16_t>(std::min(scan.columns, 65535)),
                          0};
    static_assert(sizeof(wire::Point) == sizeof(Eigen::Vector3d));
    const std::array<std::span<const std::byte>, 7> parts = {
        std::as_bytes(std::span(&step, 1)),      std::as_bytes(std::span(imus_)),
        std::as_bytes(std::span(odometries_)),   std::as_bytes(std::span(scan.range_m)),
        std::as_bytes(std::span(scan.point_L)),  std::as_bytes(std::span(scan.reflectivity)),
        std::as_bytes(std::span(scan.offset_ns))};
    std::size_t size = 0;
    for (const auto& part : parts) size += part.size();
    return conversation.ask_step(size, [&](std::span<std::byte> to) {
      for (const auto& part : parts) {
        std::copy(part.begin(), part.end(), to.begin());
        to = to.subspan(part.size());
      }
    });
  }

  ProcessCommand command_;
  std::optional<Conversation> first_, second_;
  std::vector<wire::Imu> imus_;  ///< since the scan before, as the next one
  std::vector<wire::Odometry> odometries_;
  int scans_ = 0;
};

}  // namespace

std::unique_ptr<Method> make_process_method(const ProcessCommand& command, const MethodInput& input) {
  return std::make_unique<ProcessMethod>(command, input);
}

}  // namespace plumbline::slam
