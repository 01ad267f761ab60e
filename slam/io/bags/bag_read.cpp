// SPDX-License-Identifier: Apache-2.0
// Apart, for what it includes takes long to compile.
#include <console_bridge/console.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <optional>
#include <vector>

#include "bim/config/input_file.h"
#include "bim/errors.h"
#include "slam/io/bags/bag.h"
#include "slam/io/bags/bag_check.h"
#include "slam/io/bags/frame_tree.h"
#include "slam/io/bags/odometry_motion.h"
#include "slam/io/bags/ros_message.h"

namespace plumbline::slam {

namespace {

constexpr std::string_view magic = "#ROSBAG V2.0";
constexpr std::size_t most_waiting = 20;  ///< scans that wait for slower topics

template <class M>
std::string type_of() {
  return ::ros::message_traits::DataType<M>::value();
}

template <class M>
bool is(const rosbag::MessageInstance& message) {
  return message.getMD5Sum() == ::ros::message_traits::MD5Sum<M>::value();
}

ros::Bytes bytes_of(const rosbag::MessageInstance& message) {
  ros::Bytes bytes(message.size());
  ::ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  message.write(stream);
  return bytes;
}

/// Records of one topic in time order. A record with the stamp of the one before it is left out.
template <class Record>
class Waiting {
 public:
  void add(const Record& record, std::string_view topic) {
    if (last_ && record.stamp < *last_)
      throw InputError({}, "stamps on " + std::string(topic) + " go back by " +
                               std::to_string((*last_ - record.stamp) / 1'000'000) + " ms");
    if (last_ && record.stamp == *last_) return;
    last_ = record.stamp;
    records_.push_back(record);
  }
  [[nodiscard]] bool reaches(Nanoseconds t) const { return last_ && *last_ >= t; }
  [[nodiscard]] const std::deque<Record>& records() const { return records_; }
  void take_until(Nanoseconds t, std::vector<Record>& out) {
    for (; !records_.empty() && records_.front().stamp <= t; records_.pop_front()) out.push_back(records_.front());
  }
  [[nodiscard]] Record take() {
    Record record = std::move(records_.front());
    records_.pop_front();
    return record;
  }

 private:
  std::deque<Record> records_;
  std::optional<Nanoseconds> last_;
};

class BagRecording final : public Recording {
 public:
  BagRecording(const std::string& path, const BagTopics& topics, const RecordingInfo* info) : mark_{path, 0, 0} {
    guarded([&] {
      check_bag(path);
      bag_.open(path, rosbag::bagmode::Read);
      choose_topics(topics);
      std::vector<std::string> names = {topics_.points};
      if (!topics_.odometry.empty()) names.push_back(topics_.odometry);
      if (!topics_.imu.empty()) names.push_back(topics_.imu);
      const std::string lidar = find_frames(names);
      described_ = info != nullptr;
      if (info != nullptr)
        info_ = *info;
      else if (const std::optional<Pose> X_RL = frames_.find(lidar, base_))
        info_.mount = recording_info(0, {*X_RL, info_.mount.height_m}, {}).mount;
      view_.addQuery(bag_, rosbag::TopicQuery(names));
      at_ = view_.begin();
    });
  }

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }
  [[nodiscard]] bool has_odometry() const override { return !topics_.odometry.empty(); }
  [[nodiscard]] Nanoseconds origin() const override { return origin_.value_or(0); }

  [[nodiscard]] bool next(SensorFrame& frame) override {
    bool found = false;
    guarded([&] { found = next_scan(frame); });
    return found;
  }

 private:
  /// What the library throws on a bag that is damaged, with the bag's name.
  template <class F>
  void guarded(const F& function) {
    const std::string where = messages_ == 0 ? "" : "message " + std::to_string(messages_) + ": ";
    try {
      function();
    } catch (const InputError& error) {
      const bool has_mark = std::string_view(error.what()).starts_with(mark_.file);
      if (has_mark) throw;
      throw InputError(mark_, "message " + std::to_string(messages_) + ": " + error.what());
    } catch (const rosbag::BagUnindexedException&) {
      throw InputError(mark_, "a bag that was not closed or is cut off; rosbag reindex may save it");
    } catch (const std::exception& error) {
      throw InputError(mark_, where + "not a valid ROS 1 bag: " + error.what());
    }
  }

  template <class M>
  [[nodiscard]] std::string first_topic() {
    rosbag::View all(bag_);
    for (const rosbag::ConnectionInfo* connection : all.getConnections())
      if (connection->datatype == type_of<M>() && !connection->topic.starts_with("/ground_truth"))
        return connection->topic;
    return {};
  }

  void choose_topics(const BagTopics& topics) {
    topics_ = topics;
    if (topics_.points.empty()) topics_.points = first_topic<sensor_msgs::PointCloud2>();
    if (topics_.odometry.empty()) topics_.odometry = first_topic<nav_msgs::Odometry>();
    if (topics_.imu.empty()) topics_.imu = first_topic<sensor_msgs::Imu>();
    if (topics_.points.empty()) throw InputError(mark_, "a bag without sensor_msgs/PointCloud2");
    check_topic<sensor_msgs::PointCloud2>(topics_.points);
    if (!topics_.odometry.empty()) check_topic<nav_msgs::Odometry>(topics_.odometry);
    if (!topics_.imu.empty()) check_topic<sensor_msgs::Imu>(topics_.imu);
  }

  template <class M>
  void check_topic(const std::string& topic) {
    rosbag::View view(bag_, rosbag::TopicQuery(topic));
    const std::string type = type_of<M>();
    if (view.size() == 0) throw InputError(mark_, "a bag without messages on " + topic);
    for (const rosbag::ConnectionInfo* connection : view.getConnections())
      if (connection->datatype != type)
        throw InputError(mark_, topic + " is of type " + connection->datatype + ", not " + type);
  }

  /// Reads /tf_static and the frame of the odometry, which is R's; returns that of the clouds.
  [[nodiscard]] std::string find_frames(const std::vector<std::string>& names) {
    for (const rosbag::MessageInstance& message : rosbag::View(bag_, rosbag::TopicQuery("/tf_static")))
      if (is<tf2_msgs::TFMessage>(message))
        for (const ros::Transform& t : ros::read_transforms(bytes_of(message))) frames_.add(t);
    std::string lidar;
    for (const rosbag::MessageInstance& message : rosbag::View(bag_, rosbag::TopicQuery(names))) {
      if (is<nav_msgs::Odometry>(message)) base_ = plain_frame(ros::read_odometry(bytes_of(message)).X_OR.child);
      if (is<sensor_msgs::PointCloud2>(message)) lidar = plain_frame(ros::read_cloud(bytes_of(message)).frame);
      if (!lidar.empty() && (!base_.empty() || topics_.odometry.empty())) break;
    }
    return lidar;
  }

  [[nodiscard]] Imu imu_of(const ros::FramedImu& said) const {
    if (const std::optional<Imu> imu = in_robot(said, frames_, base_)) return *imu;
    if (described_) return said.imu;
    throw InputError({}, topics_.imu + " is in frame '" + said.frame + "', which /tf_static does not join to '" +
                             base_ + "'; name another topic, or describe the recording: then the two are one");
  }

  bool next_scan(SensorFrame& frame) {
    for (fill(); !scans_.records().empty(); fill()) {
      SensorFrame out;
      out.scan = scans_.take();
      if (!first_scan_) first_scan_ = out.scan.stamp + least_offset(out.scan);
      imu_.take_until(out.scan.stamp, out.imu);
      odometry_.take_until(out.scan.stamp, out.odometry);
      covariances_.take_until(out.scan.stamp, out.covariances);
      started_ = started_ || !has_odometry() || !out.odometry.empty();
      if (!started_) continue;
      frame = std::move(out);
      return true;
    }
    check_clocks();
    return false;
  }

  /// Reads on until a scan is ready.
  void fill() {
    while (!ready() && at_ != view_.end()) {
      ++messages_;
      read(*at_);
      ++at_;
    }
  }

  static Nanoseconds least_offset(const Scan& scan) {
    const auto least = std::min_element(scan.offset_ns.begin(), scan.offset_ns.end());
    return least == scan.offset_ns.end() ? 0 : *least;
  }

  /// At the end of the bag.
  void check_clocks() const {
    if (!has_odometry()) return;
    if (!started_) throw InputError(mark_, topics_.odometry + ": " + std::string(no_odometry));
    if (odometry_stamp_ && first_scan_ && *odometry_stamp_ < *first_scan_)
      throw InputError(mark_, topics_.odometry + ": " + std::string(odometry_over));
  }

  /// True when nothing that belongs before the first waiting scan can still come.
  [[nodiscard]] bool ready() const {
    if (scans_.records().empty()) return false;
    if (scans_.records().size() > most_waiting) return true;
    const Nanoseconds t = scans_.records().front().stamp;
    return (topics_.odometry.empty() || odometry_.reaches(t)) && (topics_.imu.empty() || imu_.reaches(t));
  }

  /// Moves a stamp to the recording's clock, which starts with the first record where the bag's is that of the day.
  Nanoseconds shifted(Nanoseconds stamp) {
    constexpr Nanoseconds day = 86'400'000'000'000;
    if (!origin_) origin_ = stamp > day ? stamp : 0;
    return stamp - *origin_;
  }

  void read(const rosbag::MessageInstance& message) {
    if (is<sensor_msgs::PointCloud2>(message)) {
      Scan scan = scan_of(ros::read_cloud(bytes_of(message)).cloud);
      scan.stamp = shifted(scan.stamp);
      scans_.add(scan, topics_.points);
    } else if (is<nav_msgs::Odometry>(message)) {
      const ros::OdometryMessage said = ros::read_odometry(bytes_of(message));
      if (!X_OB_) X_OB_ = start_of(said.X_OR.X);
      const Nanoseconds stamp = shifted(said.X_OR.stamp);
      odometry_.add({stamp, *X_OB_ * said.X_OR.X}, topics_.odometry);
      const Nanoseconds dt = odometry_stamp_ ? stamp - *odometry_stamp_ : 0;
      if (const auto covariance = increment_covariance(said, dt))
        covariances_.add({stamp, *covariance}, topics_.odometry);
      odometry_stamp_ = stamp;
    } else if (is<sensor_msgs::Imu>(message)) {
      Imu record = imu_of(ros::read_imu(bytes_of(message)));
      record.stamp = shifted(record.stamp);
      imu_.add(record, topics_.imu);
    }
  }

  /// The bag's odometry frame B in O, which starts at the robot's first position and heading.
  static Pose start_of(const Pose& X_BR) {
    const double yaw = X_BR.yaw();
    const bool at_start = X_BR.t.norm() < 1e-9 && std::abs(yaw) < 1e-9;
    return at_start ? Pose{} : Pose::from_xyz_yaw(X_BR.t, yaw).inverse();
  }

  Mark mark_;
  rosbag::Bag bag_;
  rosbag::View view_;
  rosbag::View::iterator at_;
  BagTopics topics_;
  RecordingInfo info_;
  bool described_ = false;  ///< by its owner
  FrameTree frames_;
  std::string base_;  ///< R; empty without odometry
  Waiting<Scan> scans_;
  Waiting<Odometry> odometry_;
  Waiting<OdometryCovariance> covariances_;
  Waiting<Imu> imu_;
  std::optional<Nanoseconds> origin_;
  std::optional<Nanoseconds> odometry_stamp_;  ///< of the last message
  std::optional<Nanoseconds> first_scan_;      ///< when it began
  std::optional<Pose> X_OB_;
  std::int64_t messages_ = 0;
  bool started_ = false;
};

}  // namespace

bool is_bag(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  const InputFile file = open_input_file(path);
  std::array<char, magic.size()> start{};
  const std::size_t read = std::fread(start.data(), 1, start.size(), file.stream.get());
  return std::string_view(start.data(), read) == magic;
}

std::unique_ptr<Recording> open_bag(const std::string& path, const BagTopics& topics, const RecordingInfo* info) {
  console_bridge::noOutputHandler();  // the library prints what it also throws
  return std::make_unique<BagRecording>(path, topics, info);
}

}  // namespace plumbline::slam
