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

using Frame = std::shared_ptr<const slam::SensorFrame>;

/// How many threads may work at one time. std::counting_semaphore of GCC 12 loses wake-ups: a run slept for ever.
class Semaphore {
 public:
  explicit Semaphore(int count) : free_(count) {}

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

/// Holds one permit of a semaphore.
class ScopedPermit {
 public:
  explicit ScopedPermit(Semaphore& permits) : permits_(permits) { permits_.acquire(); }
  ~ScopedPermit() { permits_.release(); }
  ScopedPermit(const ScopedPermit&) = delete;
  ScopedPermit& operator=(const ScopedPermit&) = delete;

 private:
  Semaphore& permits_;
};

/// One method on a thread of its own.
class MethodThread {
 public:
  MethodThread(std::unique_ptr<MethodRunner> method, Semaphore& permits, std::size_t capacity)
      : method_(std::move(method)), permits_(permits), queue_(capacity), thread_([this] { work(); }) {}
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
  /// The method goes before its thread: a process dies with that, and what it started could not be found then.
  void work() {
    set_float_mode();
    go_through();
    method_.reset();
  }

  void go_through() {
    while (const std::optional<Frame> frame = queue_.pop()) {
      if (abandoned_) return;
      const ScopedPermit permit(permits_);
      method_->on_frame(**frame);
    }
    if (abandoned_) return;
    const ScopedPermit permit(permits_);
    record_ = method_->finish();
  }

  std::unique_ptr<MethodRunner> method_;
  Semaphore& permits_;
  BoundedQueue<Frame> queue_;
  std::atomic<bool> abandoned_ = false;
  MethodRecord record_;
  std::jthread thread_;  ///< last: it uses everything above
};

std::vector<MethodRecord> run_in_turn(const SensorSource& source,
                                      const std::vector<std::unique_ptr<MethodRunner>>& methods) {
  slam::SensorFrame frame;
  while (source(frame)) {
    check_interrupt();
    for (const auto& method : methods) method->on_frame(frame);
  }
  std::vector<MethodRecord> records;
  for (const auto& method : methods) {
    check_interrupt();
    records.push_back(method->finish());
  }
  check_interrupt();  // it ends a process, which then counts as crashed
  return records;
}

std::vector<MethodRecord> run_side_by_side(const SensorSource& source,
                                           std::vector<std::unique_ptr<MethodRunner>> methods,
                                           const PipelineConfig& config) {
  Semaphore permits(config.threads);
  std::vector<std::unique_ptr<MethodThread>> threads;
  for (auto& method : methods)
    threads.push_back(std::make_unique<MethodThread>(std::move(method), permits, config.frames_ahead));
  while (true) {
    check_interrupt();
    auto frame = std::make_shared<slam::SensorFrame>();
    {
      const ScopedPermit permit(permits);
      if (!source(*frame)) break;
    }
    for (const auto& thread : threads) thread->push(frame);
  }
  std::vector<MethodRecord> records;
  for (const auto& thread : threads) records.push_back(thread->finish());
  check_interrupt();
  return records;
}

}  // namespace

std::vector<MethodRecord> run_pipeline(const SensorSource& source, std::vector<std::unique_ptr<MethodRunner>> methods,
                                       const PipelineConfig& config) {
  set_float_mode();
  if (config.threads <= 1) return run_in_turn(source, methods);
  return run_side_by_side(source, std::move(methods), config);
}

}  // namespace plumbline::scenarios
