// SPDX-License-Identifier: Apache-2.0
#include "slam/io/recordings/recording.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <optional>

#include "bim/config/tree.h"
#include "bim/median.h"
#include "slam/io/packets/pcap.h"
#include "slam/io/recordings/record_file.h"

namespace plumbline::slam {

namespace fs = std::filesystem;

namespace {

constexpr Nanoseconds longest_message = 2'000'000'000;  ///< offsets within a scan are 32-bit nanoseconds
constexpr Nanoseconds least_leap = 1'000'000'000;       ///< between two packets of two sweeps
constexpr std::size_t looked_at = 20;                   ///< packets from which a capture's speed is read

/// What most of a capture's first packets agree on: its motor may have been starting.
int usual_packets_per_turn(const std::deque<Vlp16Packet>& first) {
  std::vector<int> said;
  for (const Vlp16Packet& packet : first) said.push_back(packets_per_turn(packet));
  return upper_median(std::move(said));
}

/// Records of one kind, the next of them read ahead.
template <class Reader, class Record>
class Stream {
 public:
  explicit Stream(const std::string& path) : reader_(path) { advance(); }
  [[nodiscard]] const std::optional<Record>& front() const { return front_; }
  /// Appends the records up to and including time t, counted from `origin` on as t is.
  void take_until(Nanoseconds t, Nanoseconds origin, std::vector<Record>& out) {
    for (; front_ && front_->stamp - origin <= t; advance()) {
      out.push_back(*front_);
      out.back().stamp -= origin;
    }
  }

 private:
  void advance() {
    Record record;
    front_.reset();
    if (reader_.next(record)) front_ = record;
  }

  Reader reader_;
  std::optional<Record> front_;
};

/// LiDAR packets, with odometry and IMU beside them where there are any.
class PacketRecording final : public Recording {
 public:
  PacketRecording(const std::string& pcap, RecordingInfo info, bool described)
      : mark_{pcap, 0, 0}, info_(std::move(info)), pcap_(pcap) {
    if (described) taken_of_.mount = MountSource::description;
  }
  void add_odometry(const std::string& path) {
    odometry_mark_ = {path, 0, 0};
    odometry_.emplace(path);
  }
  void add_covariances(const std::string& path) { covariances_.emplace(path); }
  void add_imu(const std::string& path) { imu_.emplace(path); }

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }
  [[nodiscard]] bool has_odometry() const override { return odometry_.has_value(); }
  [[nodiscard]] Nanoseconds origin() const override { return pcap_.origin(); }
  [[nodiscard]] Taken taken() const override { return taken_of_; }
  [[nodiscard]] std::vector<std::string> left_out() const override {
    std::vector<std::string> said = pcap_.left_out();
    if (early_ > 0)
      said.push_back(std::to_string(early_) + " of " + std::to_string(messages_) +
                     " scans left out: before the first odometry");
    return said;
  }

  [[nodiscard]] std::vector<std::string> assumed() const override { return pcap_.assumed(); }

  [[nodiscard]] bool next(SensorFrame& frame) override {
    SensorFrame out;
    do {
      if (!read_message(out.packets)) {
        if (odometry_ && !started_) throw InputError(odometry_mark_, std::string(no_odometry));
        return false;
      }
      out.scan = decode(out.packets);
      if (!odometry_ || odometry_started(out.scan.stamp)) break;
      ++early_;
    } while (true);
    if (imu_) imu_->take_until(out.scan.stamp, origin(), out.imu);
    if (odometry_) take_odometry(out);
    if (covariances_) covariances_->take_until(out.scan.stamp, origin(), out.covariances);
    frame = std::move(out);
    return true;
  }

 private:
  /// A message that a leap of the clock cuts short is left out, as one that the end does.
  bool read_message(std::vector<Vlp16Packet>& packets) {
    if (!info_.lidar.packets_per_message) find_turn();
    const auto needed = static_cast<std::size_t>(std::max(1, info_.lidar.packets_per_message.value_or(1)));
    packets.clear();
    Vlp16Packet packet;
    while (packets.size() < needed) {
      if (!next_packet(packet)) {
        if (messages_ == 0) fail_short(needed);
        return false;
      }
      const bool too_long = !packets.empty() && packet.stamp - packets.front().stamp > longest_message;
      if (too_long && packet.stamp - packets.back().stamp < least_leap)
        throw InputError(mark_, "message " + std::to_string(messages_) + " lasts more than 2 s; packets are missing");
      if (too_long) packets.clear();
      packets.push_back(packet);
    }
    ++messages_;
    return true;
  }

  void find_turn() {
    Vlp16Packet packet;
    while (ahead_.size() < looked_at && pcap_.next(packet)) ahead_.push_back(packet);
    named([&] { info_.lidar.packets_per_message = usual_packets_per_turn(ahead_); });
  }

  bool next_packet(Vlp16Packet& packet) {
    if (ahead_.empty() && !pcap_.next(packet)) {
      // The digest of a simulated walk is that of the whole.
      if (info_.walk && pcap_.is_cut_off()) throw InputError(mark_, "damaged capture: truncated");
      return false;
    }
    if (!ahead_.empty()) {
      packet = ahead_.front();
      ahead_.pop_front();
    }
    ++packets_;
    return true;
  }

  [[noreturn]] void fail_short(std::size_t needed) const {
    throw InputError(mark_, "holds " + std::to_string(packets_) + " data packets; one scan needs " +
                                std::to_string(needed) + " without a gap");
  }

  /// Throws where the odometry ends before the first scan begins.
  void take_odometry(SensorFrame& frame) {
    odometry_->take_until(frame.scan.stamp, origin(), frame.odometry);
    const bool first = !taken_;
    taken_ = true;
    if (first && !odometry_->front() && frame.odometry.back().stamp < frame.packets.front().stamp)
      throw InputError(odometry_mark_, std::string(odometry_over));
  }

  /// Adds the position in the file to what is wrong with a packet.
  template <class F>
  void named(const F& function) const {
    try {
      function();
    } catch (const InputError& error) {
      throw InputError(mark_, "message " + std::to_string(messages_) + ": " + error.what());
    }
  }

  [[nodiscard]] Scan decode(const std::vector<Vlp16Packet>& packets) const {
    Scan scan;
    named([&] { scan = decode_message(packets, info_.lidar.vertical_offsets); });
    return scan;
  }

  [[nodiscard]] bool odometry_started(Nanoseconds stamp) {
    if (!started_) started_ = odometry_->front() && odometry_->front()->stamp - origin() <= stamp;
    return started_;
  }

  Mark mark_, odometry_mark_;
  RecordingInfo info_;
  PcapReader pcap_;
  std::deque<Vlp16Packet> ahead_;  ///< read, but not yet of a message
  std::optional<Stream<OdometryReader, Odometry>> odometry_;
  std::optional<Stream<CovarianceReader, OdometryCovariance>> covariances_;
  std::optional<Stream<ImuReader, Imu>> imu_;
  Taken taken_of_;
  std::int64_t packets_ = 0, messages_ = 0;
  std::int64_t early_ = 0;  ///< scans before the odometry
  bool started_ = false;    ///< odometry has, for the first scan given
  bool taken_ = false;      ///< and that scan has its records
};

std::unique_ptr<Recording> open_directory(const std::string& dir, const RecordingInfo* given) {
  const auto path = [&](std::string_view name) { return dir + "/" + std::string(name); };
  const std::string pcap = path(recording_files::lidar);
  if (!fs::exists(pcap)) throw InputError({dir, 0, 0}, "holds no lidar.pcap; it is no recording");
  RecordingInfo info;
  if (const std::string file = path(recording_files::info); given != nullptr)
    info = *given;
  else if (fs::exists(file))
    info = read_recording_info(read_text_file(file), file);
  const bool described = given != nullptr || fs::exists(path(recording_files::info));
  auto recording = std::make_unique<PacketRecording>(pcap, info, described);
  if (const std::string file = path(recording_files::odometry); fs::exists(file)) recording->add_odometry(file);
  if (const std::string file = path(recording_files::covariance); fs::exists(file)) recording->add_covariances(file);
  if (const std::string file = path(recording_files::imu); fs::exists(file)) recording->add_imu(file);
  return recording;
}

}  // namespace

int packets_per_turn(const Vlp16Packet& packet) {
  constexpr int blocks_apart = 10;  // even, so that the two blocks of a dual return count once
  const auto azimuth = [&](std::size_t block) {
    return packet.payload[100 * block + 2] | (packet.payload[100 * block + 3] << 8);
  };
  const PacketKind kind = packet_kind(packet);
  const int returns = kind.mode == ReturnMode::dual ? 2 : 1;
  const int turn_cdeg = ((azimuth(blocks_apart) - azimuth(0)) % 36000 + 36000) % 36000;
  const int firings = blocks_apart * kind.model->firings_per_packet / 12 / returns;
  const double turns_per_s = turn_cdeg / 36000.0 / (1e-9 * static_cast<double>(firings * kind.model->firing_period_ns));
  const double rounded = std::clamp(std::round(turns_per_s), 5.0, 20.0);
  const auto messages = firings_per_message(*kind.model, 60.0 * rounded) / kind.model->firings_per_packet;
  return static_cast<int>(messages) * returns;
}

std::unique_ptr<Recording> open_recording(const std::string& path, const RecordingInfo* info) {
  if (fs::is_directory(path)) return open_directory(path, info);
  if (!fs::exists(path))
    throw InputError({path, 0, 0}, "no such file; a recording directory or a capture (.pcap) would be right");
  return std::make_unique<PacketRecording>(path, info != nullptr ? *info : RecordingInfo{}, info != nullptr);
}

}  // namespace plumbline::slam
