// SPDX-License-Identifier: Apache-2.0
#include "slam/process/process_method.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <optional>
#include <span>
#include <utility>

#include "slam/process/answers.h"
#include "slam/process/child.h"
#include "slam/process/client/plumbline_messages.h"
#include "slam/process/greeting.h"

namespace plumbline::slam {

namespace {

using Bytes = std::vector<std::byte>;

template <class T>
void append(Bytes& bytes, const T& value) {
  const auto* from = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), from, from + sizeof(T));
}

wire::Pose wire_of(const Pose& X) { return {{X.t.x(), X.t.y(), X.t.z()}, {X.q.x(), X.q.y(), X.q.z(), X.q.w()}}; }

std::string text_of(const Bytes& bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

struct Message {
  wire::Type type = wire::Type::fail;
  Bytes payload;
};

/// One process and what is said to it.
class Conversation {
 public:
  Conversation(const ProcessCommand& command, const MethodInput& input)
      : command_(command), child_(command.command, command.folder, environment_of(input), command.printed) {
    child_.set_deadline(command.start_s);
    const std::string hello = greeting(command, input);
    Bytes payload(hello.size());
    std::memcpy(payload.data(), hello.data(), hello.size());
    send(wire::Type::hello, payload);
    check_greeting(text_of(receive(wire::Type::hello_ok)));
  }

  /// The answer's payload.
  [[nodiscard]] Bytes ask(wire::Type question, const Bytes& payload, wire::Type answer, double seconds) {
    child_.set_deadline(seconds);
    send(question, payload);
    return receive(answer);
  }
  [[nodiscard]] double cpu_ms() const { return child_.cpu_ms(); }
  void end() {
    child_.set_deadline(command_.finish_s);
    static_cast<void>(child_.close_and_wait());
  }

 private:
  void send(wire::Type type, const Bytes& payload) {
    const wire::Head head{wire::magic, static_cast<std::uint16_t>(type), 0, payload.size()};
    child_.send(&head, sizeof head);
    child_.send(payload.data(), payload.size());
  }

  /// Lines for the log are passed over.
  [[nodiscard]] Bytes receive(wire::Type wanted) {
    for (;;) {
      Message message = receive_one();
      if (message.type == wire::Type::log) continue;
      if (message.type == wire::Type::fail) throw ProcessFailure("gave up: " + text_of(message.payload));
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
  Child child_;
};

class ProcessMethod final : public Method {
 public:
  ProcessMethod(const ProcessCommand& command, const MethodInput& input) : command_(command) {
    with_context("at the start", [&] { first_.emplace(command, input); });
    if (command.repeat) with_context("at the second start", [&] { second_.emplace(command, input); });
  }

  void on_imu(const Imu& imu) override {
    const Eigen::Vector3d &w = imu.angular_velocity_R, &a = imu.linear_acceleration_R;
    append(imus_, wire::Imu{imu.stamp, {w.x(), w.y(), w.z()}, {a.x(), a.y(), a.z()}});
  }
  void on_odometry(const Odometry& odometry) override {
    append(odometries_, wire::Odometry{odometry.stamp, wire_of(odometry.X_OR)});
  }

  [[nodiscard]] Output on_scan(const Scan& scan) override {
    ++scans_;
    const Bytes step = step_of(scan);
    imus_.clear();
    odometries_.clear();
    Output output;
    char when[64];
    std::snprintf(when, sizeof when, "at scan %d (%.1f s)", scans_, seconds(scan.stamp));
    with_context(when, [&] {
      const double before_ms = first_->cpu_ms();
      const Bytes answer = first_->ask(wire::Type::step, step, wire::Type::output, command_.scan_s);
      output = read_output(answer, scan.stamp, command_.needs_plan);
      output.times.push_back({"process", std::max(0.0, first_->cpu_ms() - before_ms)});
      if (second_ && second_->ask(wire::Type::step, step, wire::Type::output, command_.scan_s) != answer)
        throw ProcessFailure("does not repeat: a second process answers the same records otherwise");
    });
    return output;
  }

  [[nodiscard]] Estimate finish() override {
    Estimate estimate;
    with_context("at the end", [&] {
      const Bytes answer = first_->ask(wire::Type::finish, {}, wire::Type::estimate, command_.finish_s);
      estimate = read_estimate(answer, command_.needs_plan);
      if (second_ && second_->ask(wire::Type::finish, {}, wire::Type::estimate, command_.finish_s) != answer)
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

  [[nodiscard]] Bytes step_of(const Scan& scan) const {
    Bytes bytes;
    bytes.reserve(sizeof(wire::Step) + imus_.size() + odometries_.size() + scan.size() * sizeof(wire::Return));
    append(bytes, wire::Step{scan.stamp, static_cast<std::uint32_t>(imus_.size() / sizeof(wire::Imu)),
                             static_cast<std::uint32_t>(odometries_.size() / sizeof(wire::Odometry)),
                             static_cast<std::uint32_t>(scan.size()), static_cast<std::uint16_t>(scan.rings),
                             static_cast<std::uint16_t>(scan.columns), 0});
    bytes.insert(bytes.end(), imus_.begin(), imus_.end());
    bytes.insert(bytes.end(), odometries_.begin(), odometries_.end());
    std::size_t at = bytes.size();
    bytes.resize(at + scan.size() * sizeof(wire::Return));
    for (std::size_t i = 0; i < scan.size(); ++i, at += sizeof(wire::Return)) {
      const Eigen::Vector3d& p = scan.point_L[i];
      const wire::Return one{{p.x(), p.y(), p.z()}, scan.range_m[i], scan.offset_ns[i], scan.reflectivity[i]};
      std::memcpy(&bytes[at], &one, sizeof one);
    }
    return bytes;
  }

  ProcessCommand command_;
  std::optional<Conversation> first_, second_;
  Bytes imus_, odometries_;  ///< since the scan before
  int scans_ = 0;
};

}  // namespace

std::unique_ptr<Method> make_process_method(const ProcessCommand& command, const MethodInput& input) {
  return std::make_unique<ProcessMethod>(command, input);
}

}  // namespace plumbline::slam
