// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "bim/errors.h"
#include "slam/io/bags/bag.h"
#include "slam/io/bags/bag_source.h"
#include "slam/io/bags/bag_topics.h"
#include "slam/io/bags/first_clouds.h"
#include "slam/io/bags/frame_tree.h"
#include "slam/io/bags/numbered_messages.h"
#include "slam/io/bags/odometry_motion.h"
#include "slam/io/bags/record_queue.h"
#include "slam/io/bags/ros_message.h"
#include "slam/io/bags/topic_clocks.h"
#include "slam/io/bags/transform_odometry.h"
#include "slam/io/bags/unset_clock.h"
#include "slam/io/packets/point_units.h"

namespace plumbline::slam {

namespace {

constexpr std::size_t most_waiting = 20;    ///< scans that wait for slower topics
constexpr std::int64_t many_records = 100;  ///< by which a clock that stands still is told from a slow start

class BagRecording final : public Recording {
 public:
  BagRecording(const std::string& path, const BagTopics& topics, const RecordingInfo* info) : mark_{path, 0, 0} {
    guarded([&] {
      source_ = open_source(path);
      if (topics.odometry.empty()) source_ = with_odometry_of_transforms(std::move(source_));
      messages_ = NumberedMessages(*source_);
      topics_ = choose_topics(*source_, topics, mark_);
      lidar_ = find_frames(names());
      described_ = info != nullptr;
      if (info != nullptr) {
        info_ = *info;
        mount_ = MountSource::description;
      } else {
        find_mount();
      }
      find_times();
      messages_.select(names());
    });
  }

  [[nodiscard]] const RecordingInfo& info() const override { return info_; }
  [[nodiscard]] bool has_odometry() const override { return !topics_.odometry.empty(); }
  [[nodiscard]] Nanoseconds origin() const override { return origin_.value_or(0); }

  [[nodiscard]] std::vector<std::string> left_out() const override {
    std::vector<std::string> all;
    for (const std::vector<std::string>& said :
         {source_->left_out(), messages_.left_out(), clock_.left_out(), scans_.left_out(topics_.points, "scans"),
          odometry_.left_out(topics_.odometry, "records"), imu_.left_out(topics_.imu, "records"),
          frames_.left_out("/tf_static")})
      all.insert(all.end(), said.begin(), said.end());
    if (scan_frame_.others() > 0)
      all.push_back(topics_.points + " left out: " + scan_frame_.others_of(scans_.read(), "scans"));
    if (odometry_frame_.others() > 0)
      all.push_back(topics_.odometry + " left out: " + odometry_frame_.others_of(odometry_.read(), "records"));
    if (unjoined_imu_)
      all.push_back(topics_.imu + " left out: in frame '" + *unjoined_imu_ + "', which /tf_static does not join to '" +
                    base_ + "'; name another topic, or describe the recording: then the two are one");
    if (const std::string tf = moving_transforms(*source_); topics_.odometry.empty() && !tf.empty())
      all.push_back("no odometry: no nav_msgs/Odometry, and on " + tf +
                    " no moving odom -> base_link to which the LiDAR is joined");
    const auto scans = [&](std::int64_t n) { return topics_.points + ": " + share_of(n, scans_.read(), "scans"); };
    for (const std::string& apart :
         {clocks_.difference(topics_.points, topics_.odometry), clocks_.imu_difference(topics_.points, topics_.imu)})
      if (!apart.empty()) all.push_back(apart + "; both must be on one clock");
    if (early_ > 0) all.push_back(scans(early_) + " left out: before the first odometry");
    if (without_rings_ > 0) all.push_back(scans(without_rings_) + " read " + std::string(no_ring_numbers));
    return all;
  }
  [[nodiscard]] std::vector<std::string> assumed() const override {
    std::vector<std::string> all = units_.said();
    if (!times_.said.empty()) all.push_back(times_.said);
    if (unstamped_) all.push_back("the stamps of clouds are 0; the times of recording are taken for them");
    for (std::string& said : all) said = topics_.points + ": " + said;
    return all;
  }
  [[nodiscard]] Taken taken() const override {
    const std::string imu = unjoined_imu_ ? std::string() : topics_.imu;
    return {topics_.points, topics_.odometry, imu, other_clouds(*source_, topics_.points), lidar_, mount_, base_};
  }

  [[nodiscard]] bool next(SensorFrame& frame) override {
    bool found = false;
    guarded([&] { found = next_scan(frame); });
    return found;
  }

 private:
  /// What messages themselves have wrong is said with the bag's name.
  template <class F>
  void guarded(const F& function) {
    try {
      function();
    } catch (const InputError& error) {
      if (std::string_view(error.what()).starts_with(mark_.file)) throw;
      throw InputError(mark_, error.what());
    }
  }

  /// Of the topics that are read.
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all = {topics_.points};
    for (const std::string* name : {&topics_.odometry, &topics_.imu})
      if (!name->empty()) all.push_back(*name);
    return all;
  }

  [[nodiscard]] const BagTopic& topic_of(const RawMessage& message) const { return source_->topics()[message.topic]; }

  [[nodiscard]] std::optional<ros::OdometryMessage> odometry_of(const RawMessage& message) const {
    return messages_.possible(message, [&] { return ros::read_odometry(message.bytes, topic_of(message).encoding); });
  }

  [[nodiscard]] ros::FramedCloud cloud_of(const RawMessage& message) const {
    const BagTopic& topic = topic_of(message);
    ros::FramedCloud said = messages_.named(message, [&] {
      return is_livox(topic.type) ? ros::read_livox(message.bytes, topic.encoding)
                                  : ros::read_cloud(message.bytes, topic.encoding);
    });
    if (unstamped_ && said.cloud.stamp == 0) said.cloud.stamp = message.time - times_.times.end_ns;  // after its sweep
    return said;
  }

  /// Returns how many hold numbers that are no pose.
  template <class F>
  std::size_t show_transforms(const std::string& topic, const F& add) {
    messages_.select({topic});
    std::size_t impossible = 0;
    for (RawMessage message; messages_.next_of_any_time(message);) {
      if (!is_transforms(topic_of(message).type)) continue;
      const ros::Transforms transforms = ros::read_transforms(message.bytes, topic_of(message).encoding);
      impossible += transforms.impossible;
      for (const ros::Transform& t : transforms.all) add(t);
    }
    return impossible;
  }

  /// Reads the static transforms and the frame of the odometry, which is R's; returns that of the clouds.
  [[nodiscard]] std::string find_frames(const std::vector<std::string>& names) {
    const std::string fixed = static_transforms(*source_, topics_.points);
    frames_.add_impossible(show_transforms(fixed, [&](const ros::Transform& t) { frames_.add(t); }));
    RawMessage message;
    std::string lidar;
    messages_.select(names);
    bool any_cloud = false;
    while (messages_.next(message)) {
      const BagTopic& topic = topic_of(message);
      if (is_odometry(topic.type))
        if (const auto odometry = odometry_of(message); odometry && base_.empty())
          base_ = plain_frame(odometry->X_OR.child);
      if (is_cloud(topic.type) && lidar.empty()) lidar = plain_frame(cloud_of(message).frame);
      any_cloud = any_cloud || is_cloud(topic.type);
      if (!lidar.empty() && (!base_.empty() || topics_.odometry.empty())) break;
    }
    if (!any_cloud) throw InputError(mark_, "a bag without messages on " + topics_.points);
    if (topics_.odometry.empty()) base_ = robot_above(lidar, frames_);
    return lidar;
  }

  /// Without odometry and base_link R is the LiDAR's frame, unless the owner says otherwise.
  void find_mount() {
    std::optional<Pose> X_RL = frames_.find(lidar_, base_);
    if (X_RL && lidar_ != base_) mount_ = MountSource::tf_static;
    if (X_RL && lidar_ == base_ && !base_.empty()) mount_ = MountSource::same_frame;
    if (!X_RL && !lidar_.empty() && !base_.empty()) {
      StillJoints joints;
      static_cast<void>(show_transforms("/tf", [&](const ros::Transform& t) { joints.add(t); }));
      FrameTree all = frames_;
      for (const ros::Transform& t : joints.found()) all.add(t);
      X_RL = all.find(lidar_, base_);
      if (X_RL) {
        frames_ = all;
        mount_ = MountSource::tf;
      }
    }
    if (X_RL) {
      info_.mount = recording_info(0, {*X_RL, 0.0}, {}).mount;
      info_.mount.height_m.reset();                   // no transform tells it
    } else if (is_of_transforms(topics_.odometry)) {  // the LiDAR alone is enough
      topics_.odometry.clear();
      base_.clear();
    } else if (!frames_.empty() && !lidar_.empty() && !base_.empty()) {
      throw InputError(mark_, topics_.points + " is in frame '" + lidar_ + "', which /tf_static does not join to '" +
                                  base_ +
                                  "'; give the mount with --description, or name another topic with --points-topic" +
                                  in_brackets(other_clouds(*source_, topics_.points)));
    }
  }

  void show_clouds(const std::function<bool(const PointCloud&)>& add) {
    messages_.select({topics_.points});
    OneFrame frame;
    for (RawMessage message; messages_.next(message);) {
      const ros::FramedCloud said = cloud_of(message);
      if (!frame.takes(said.frame)) continue;
      if (!messages_.named(message, [&] { return add(said.cloud); })) return;
    }
  }

  void find_times() {
    const ShowClouds show = [this](const std::function<bool(const PointCloud&)>& add) { show_clouds(add); };
    unstamped_ = are_unstamped(show);
    clock_ = clock_of_clouds(show);
    times_ = times_of_clouds(show, clock_);
    if (!topics_.point_times && !times_.readable)
      times_ = {{TimeBase::unknown, 0.0, 0, true}, "point times cannot be read and are left out", false};
  }

  /// Nothing where it is not known how the IMU's axes lie.
  [[nodiscard]] std::optional<Imu> imu_of(const ros::FramedImu& said) const {
    const std::optional<Imu> imu = in_robot(said, frames_, base_);
    return imu || !described_ ? imu : std::optional(said.imu);
  }

  bool next_scan(SensorFrame& frame) {
    SensorFrame out;
    for (fill(); !scans_.records().empty(); fill()) {
      out.scan = scans_.take();
      if (!first_scan_) first_scan_ = out.scan.stamp + least_offset(out.scan);
      imu_.take_until(out.scan.stamp, out.imu);
      odometry_.take_until(out.scan.stamp, out.odometry);
      covariances_.take_until(out.scan.stamp, out.covariances);
      started_ = started_ || !has_odometry() || tells_motion(out.odometry, out.scan.stamp);
      early_ += started_ ? 0 : 1;
      if (!started_) continue;
      frame = std::move(out);
      return true;
    }
    check_clocks();
    return false;
  }

  /// Reads on until a scan is ready.
  void fill() {
    RawMessage message;
    while (!ready() && messages_.next(message)) read(message);
  }

  static Nanoseconds least_offset(const Scan& scan) {
    const auto least = std::min_element(scan.offset_ns.begin(), scan.offset_ns.end());
    return least == scan.offset_ns.end() ? 0 : *least;
  }

  /// At the end of the bag.
  void check_clocks() const {
    if (2 * scans_.lost() > scans_.read())
      throw InputError(mark_, topics_.points + ": " + share_of(scans_.lost(), scans_.read(), "scans") +
                                  " have a stamp that is no later than that of one before; at most half are left out");
    if (scan_frame_.others() > scans_.read())
      throw InputError(
          mark_, topics_.points + ": " + scan_frame_.others_of(scans_.read(), "scans") + "; at most half are left out");
    if (!has_odometry()) return;
    if (odometry_frame_.others() > odometry_.read())
      throw InputError(mark_, topics_.odometry + ": " + odometry_frame_.others_of(odometry_.read(), "records") +
                                  "; at most half are left out");
    if (2 * odometry_.lost() > odometry_.read() && odometry_.impossible() > 0)
      throw InputError(mark_, topics_.odometry + ": " + share_of(odometry_.lost(), odometry_.read(), "records") +
                                  " hold numbers that are no pose, or come late; at most half are left out");
    check_odometry(1);
    const std::string apart = clocks_.difference(topics_.points, topics_.odometry);
    const auto fail = [&](std::string_view why) {
      throw InputError(mark_, topics_.odometry + ": " + std::string(why) + (apart.empty() ? "" : " " + apart));
    };
    if (!started_) fail(no_odometry);
    if (odometry_.last() && first_scan_ && *odometry_.last() < *first_scan_) fail(odometry_over);
  }

  void check_odometry(std::int64_t more_than) const {
    if (odometry_.stands_still(more_than))
      throw InputError(mark_, topics_.odometry + ": all records have one stamp; each needs that of its measurement");
  }

  /// True when nothing that belongs before the first waiting scan can still come.
  [[nodiscard]] bool ready() const {
    if (scans_.records().empty()) return false;
    if (scans_.records().size() > most_waiting) return true;
    if (scans_.records().size() == 1 && scans_.is_last_doubtful()) return false;
    const Nanoseconds t = scans_.records().front().stamp;
    return (topics_.odometry.empty() || odometry_.reaches(t)) &&
           (topics_.imu.empty() || unjoined_imu_ || imu_.reaches(t));
  }

  /// Moves a stamp to the recording's clock, which starts with the first record where the bag's is that of the day.
  Nanoseconds shifted(Nanoseconds stamp) {
    constexpr Nanoseconds day = 86'400'000'000'000;
    if (!origin_) origin_ = stamp > day ? stamp : 0;
    return stamp - *origin_;
  }

  void read(const RawMessage& message) {
    const BagTopic& topic = topic_of(message);
    if (is_cloud(topic.type)) {
      const ros::FramedCloud said = cloud_of(message);
      if (!scan_frame_.takes(said.frame) || !clock_.takes(said.cloud.stamp, topics_.points)) return;
      CloudScan read = messages_.named(message, [&] { return read_scan(said.cloud, times_.times); });
      without_rings_ += read.rings_left_out ? 1 : 0;
      units_.add(read);
      clocks_.add_scan(read.scan.stamp, message.time);
      read.scan.stamp = shifted(read.scan.stamp);
      scans_.add(read.scan, topics_.points);
    } else if (is_odometry(topic.type)) {
      if (const auto said = odometry_of(message)) {
        if (!clock_.takes(said->X_OR.stamp, topics_.odometry)) return;
        clocks_.add_odometry(said->X_OR.stamp, message.time);
        take(*said);
      } else {
        odometry_.leave_out();
      }
    } else if (is_imu(topic.type)) {
      if (const auto said = messages_.possible(message, [&] { return ros::read_imu(message.bytes, topic.encoding); }))
        take(*said, message.time);
      else
        imu_.leave_out();
    }
  }

  void take(const ros::OdometryMessage& said) {
    if (!odometry_frame_.takes(said.X_OR.child)) return;
    if (!X_OB_) X_OB_ = start_of_odometry(said.X_OR.X);
    const Nanoseconds stamp = shifted(said.X_OR.stamp);
    const bool taken = odometry_.add({stamp, *X_OB_ * said.X_OR.X}, topics_.odometry);
    check_odometry(many_records);
    if (!taken) return;
    covariances_.take_back_from(stamp);
    const Nanoseconds dt = stamp - odometry_.before_last().value_or(stamp);
    if (const auto covariance = increment_covariance(said, dt))
      covariances_.add({stamp, *covariance}, topics_.odometry);
  }

  void take(const ros::FramedImu& said, Nanoseconds recorded) {
    std::optional<Imu> record = imu_of(said);
    if (!record) unjoined_imu_ = said.frame;
    if (!record || !clock_.takes(record->stamp, topics_.imu)) return;
    clocks_.add_imu(record->stamp, recorded);
    record->stamp = shifted(record->stamp);
    if (!gravity_) gravity_ = gravity_in(*record);
    record->linear_acceleration_R *= *gravity_;
    imu_.add(*record, topics_.imu);
  }

  Mark mark_;
  std::unique_ptr<MessageSource> source_;
  NumberedMessages messages_;
  BagTopics topics_;
  RecordingInfo info_;
  bool described_ = false;  ///< by its owner
  FrameTree frames_;
  std::string base_;   ///< R; empty where it is not known
  std::string lidar_;  ///< L
  MountSource mount_ = MountSource::unknown;
  AssumedTimes times_;
  PointUnits units_;
  TopicClocks clocks_;
  UnsetClock clock_;
  bool unstamped_ = false;  ///< the clouds
  OneFrame scan_frame_, odometry_frame_;
  RecordQueue<Scan> scans_;
  RecordQueue<Odometry> odometry_;
  RecordQueue<OdometryCovariance> covariances_;
  RecordQueue<Imu> imu_;
  std::optional<Nanoseconds> origin_;
  std::optional<std::string> unjoined_imu_;  ///< frame that /tf_static does not join to R
  std::optional<Nanoseconds> first_scan_;    ///< when it began
  std::optional<Pose> X_OB_;
  std::optional<double> gravity_;               ///< m/s^2 of the unit that the IMU's accelerations are in
  std::int64_t early_ = 0, without_rings_ = 0;  ///< scans before the odometry; scans
  bool started_ = false;
};

}  // namespace

std::unique_ptr<Recording> open_bag(const std::string& path, const BagTopics& topics, const RecordingInfo* info) {
  return std::make_unique<BagRecording>(path, topics, info);
}

}  // namespace plumbline::slam
