// SPDX-License-Identifier: Apache-2.0
#include "scenarios/run/run_pipeline.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "bim/digest/float_mode.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/run/bounded_queue.h"

namespace plumbline::scenarios {

namespace {

using Frame = std::shared_ptr<const sim::WorldFrame>;

/// So many threads may work at a time. With std::counting_semaphore (GCC 12) a run slept for ever.
class Permits {
 public:
  explicit Permits(int count) : free_(count) {}

  void acquire() {
    std::unique_lock lock(mutex_);
    freed_.wait(lock, [&] { return free_ > 0; });
    --free_;
  }
  void release() {
    {
      const std::lock_guard lock(mutex_);
      ++free_;
    }
    freed_.notify_one();
  }

 private:
  std::mutex mutex_;
  std::condition_variable freed_;
  int free_;
};

/// Holds one of the permits to work.
class Working {
 public:
  explicit Working(Permits& permits) : permits_(permits) { permits_.acquire(); }
  ~Working() { permits_.release(); }
  Working(const Working&) = delete;
  Working& operator=(const Working&) = delete;

 private:
  Permits& permits_;
};

/// One participant on a thread of its own.
class MethodThread {
 public:
  MethodThread(std::unique_ptr<Participant> participant, Permits& permits, std::size_t capacity)
      : participant_(std::move(participant)), permits_(permits), queue_(capacity), thread_([this] { work(); }) {}
  ~MethodThread() {
    abandoned_ = true;
    queue_.close();
  }
  MethodThread(const MethodThread&) = delete;
  MethodThread& operator=(const MethodThread&) = delete;

  void push(Frame frame) { queue_.push(std::move(frame)); }
  /// Call once: waits until every frame is done.
  MethodRecord finish() {
    queue_.close();
    thread_.join();
    return std::move(record_);
  }

 private:
  void work() {
    set_float_mode();
    while (const std::optional<Frame> frame = queue_.pop()) {
      if (abandoned_) return;
      const Working working(permits_);
      participant_->on_frame(**frame);
    }
    if (abandoned_) return;
    const Working working(permits_);
    record_ = participant_->finish();
  }

  std::unique_ptr<Participant> participant_;
  Permits& permits_;
  BoundedQueue<Frame> queue_;
  std::atomic<bool> abandoned_ = false;
  MethodRecord record_;
  std::jthread thread_;  ///< last: it uses everything above
};

std::vector<MethodRecord> run_in_turn(const FrameSource& source, const FrameObserver& observe,
                                      const std::vector<std::unique_ptr<Participant>>& participants) {
  sim::WorldFrame frame;
  while (source(frame)) {
    check_interrupt();
    observe(frame);
    for (const auto& participant : participants) participant->on_frame(frame);
  }
  std::vector<MethodRecord> records;
  for (const auto& participant : participants) {
    check_interrupt();
    records.push_back(participant->finish());
  }
  return records;
}

std::vector<MethodRecord> run_side_by_side(const FrameSource& source, const FrameObserver& observe,
                                           std::vector<std::unique_ptr<Participant>> participants,
                                           const PipelineConfig& config) {
  Permits permits(config.threads);
  std::vector<std::unique_ptr<MethodThread>> threads;
  for (auto& participant : participants)
    threads.push_back(std::make_unique<MethodThread>(std::move(participant), permits, config.frames_ahead));
  while (true) {
    check_interrupt();
    auto frame = std::make_shared<sim::WorldFrame>();
    {
      const Working working(permits);
      if (!source(*frame)) break;
      observe(*frame);
    }
    for (const auto& thread : threads) thread->push(frame);
  }
  std::vector<MethodRecord> records;
  for (const auto& thread : threads) records.push_back(thread->finish());
  check_interrupt();
  return records;
}

}  // namespace

std::vector<MethodRecord> run_pipeline(const FrameSource& source, const FrameObserver& observe,
                                       std::vector<std::unique_ptr<Participant>> participants,
                                       const PipelineConfig& config) {
  set_float_mode();
  if (config.threads <= 1) return run_in_turn(source, observe, participants);
  return run_side_by_side(source, observe, std::move(participants), config);
}

}  // namespace plumbline::scenarios
