// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/ros_message.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

#include "bim/errors.h"
#include "slam/io/pose_check.h"
#include "slam/io/second.h"

namespace plumbline::slam::ros {

static_assert(std::endian::native == std::endian::little);

namespace {

constexpr std::size_t cdr_head_bytes = 4;

class Writer {
 public:
  explicit Writer(Encoding encoding) : cdr_(encoding == Encoding::cdr) {
    if (cdr_) bytes = {0, 1, 0, 0};  // little endian
  }

  template <class T>
  void number(T value) {
    static_assert(std::is_arithmetic_v<T>);
    if (cdr_) bytes.resize(cdr_head_bytes + (bytes.size() - cdr_head_bytes + sizeof(T) - 1) / sizeof(T) * sizeof(T));
    const std::size_t at = bytes.size();
    bytes.resize(at + sizeof(T));
    std::memcpy(&bytes[at], &value, sizeof(T));
  }
  void zeros(int count) {
    for (int i = 0; i < count; ++i) number(0.0);
  }
  void text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size() + (cdr_ ? 1 : 0)));
    bytes.insert(bytes.end(), value.begin(), value.end());
    if (cdr_) bytes.push_back(0);
  }
  void time(Nanoseconds stamp) {
    const Nanoseconds t = std::max<Nanoseconds>(stamp, 0);
    number(static_cast<std::uint32_t>(t / second_ns));
    number(static_cast<std::uint32_t>(t % second_ns));
  }
  void header(Nanoseconds stamp, std::string_view frame) {
    if (!cdr_) number(std::uint32_t{0});  // sequence, which nobody reads
    time(stamp);
    text(frame);
  }
  void vector(const Eigen::Vector3d& v) {
    for (const double value : v) number(value);
  }
  void quaternion(const Eigen::Quaterniond& q) {
    for (const double value : {q.x(), q.y(), q.z(), q.w()}) number(value);
  }
  void pose(const Pose& X) {
    vector(X.t);
    quaternion(X.q);
  }
  void matrix(const Matrix6d& m) {
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) number(m(i, j));
  }

  Bytes bytes;

 private:
  bool cdr_;
};

class Reader {
 public:
  Reader(std::span<const std::uint8_t> bytes, Encoding encoding) : rest_(bytes), cdr_(encoding == Encoding::cdr) {
    if (!cdr_) return;
    const auto head = take(cdr_head_bytes);
    if (head[0] != 0 || head[1] != 1)
      throw InputError({}, "a message that is not little-endian CDR (XCDR1), as ROS 2 writes");
    whole_ = rest_.size();
  }

  std::span<const std::uint8_t> take(std::size_t count) {
    if (count > rest_.size()) throw InputError({}, "a message that ends too early");
    const auto taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  template <class T>
  T number() {
    static_assert(std::is_arithmetic_v<T>);
    align(sizeof(T));
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  void skip_numbers(std::size_t count) {
    align(sizeof(double));
    static_cast<void>(take(count * sizeof(double)));
  }
  /// How many entries of at least so many bytes follow.
  std::size_t length(std::size_t least_bytes) {
    const std::size_t count = number<std::uint32_t>();
    if (count * least_bytes > rest_.size()) throw InputError({}, "a message that ends too early");
    return count;
  }
  std::string text() {
    auto bytes = take(length(1));
    if (cdr_ && !bytes.empty() && bytes.back() == 0) bytes = bytes.first(bytes.size() - 1);
    return {bytes.begin(), bytes.end()};
  }
  /// ROS 2 counts from 1970 both ways. Seconds of 32 bits keep differences to other times within 64.
  Nanoseconds time() {
    const std::int64_t s = cdr_ ? std::int64_t{number<std::int32_t>()} : std::int64_t{number<std::uint32_t>()};
    return s * second_ns + number<std::uint32_t>();
  }
  Nanoseconds header(std::string& frame) {
    if (!cdr_) static_cast<void>(number<std::uint32_t>());
    const Nanoseconds stamp = time();
    frame = text();
    return stamp;
  }
  Eigen::Vector3d vector() {
    Eigen::Vector3d v;
    for (double& value : v) value = number<double>();
    if (!v.allFinite()) throw ImpossibleNumber({}, "a vector that is not finite");
    return v;
  }
  Pose pose() {
    Eigen::Vector3d t;
    Eigen::Quaterniond q;
    for (double& value : t) value = number<double>();
    for (double& value : q.coeffs()) value = number<double>();
    if (!t.allFinite()) throw ImpossibleNumber({}, "a vector that is not finite");
    try {
      return checked_pose(t, q, {});
    } catch (const InputError& error) {
      throw ImpossibleNumber({}, error.what());
    }
  }
  Matrix6d matrix() {
    Matrix6d m;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) m(i, j) = number<double>();
    return m;
  }

 private:
  void align(std::size_t size) {
    if (!cdr_) return;
    const std::size_t beyond = (whole_ - rest_.size()) % size;
    if (beyond != 0) static_cast<void>(take(size - beyond));
  }

  std::span<const std::uint8_t> rest_;
  bool cdr_;
  std::size_t whole_ = 0;  ///< bytes after the head
};

}  // namespace

Bytes write_clock(Nanoseconds stamp, Encoding encoding) {
  Writer out(encoding);
  out.time(stamp);
  return out.bytes;
}

Bytes write_cloud(const PointCloud& cloud, std::string_view frame, Encoding encoding) {
  Writer out(encoding);
  out.header(cloud.stamp, frame);
  out.number(cloud.height);
  out.number(cloud.width);
  out.number(static_cast<std::uint32_t>(cloud.fields.size()));
  for (const PointField& field : cloud.fields) {
    out.text(field.name);
    out.number(field.offset);
    out.number(static_cast<std::uint8_t>(field.type));
    out.number(std::uint32_t{1});
  }
  out.number(std::uint8_t{0});  // little endian
  out.number(cloud.point_step);
  out.number(cloud.row_step);
  out.number(static_cast<std::uint32_t>(cloud.data.size()));
  out.bytes.insert(out.bytes.end(), cloud.data.begin(), cloud.data.end());
  out.number(static_cast<std::uint8_t>(cloud.dense ? 1 : 0));
  return out.bytes;
}

Bytes write_odometry(const OdometryMessage& message, Encoding encoding) {
  Writer out(encoding);
  out.header(message.X_OR.stamp, message.X_OR.parent);
  out.text(message.X_OR.child);
  out.pose(message.X_OR.X);
  out.matrix(message.pose_covariance);
  for (const double value : message.twist) out.number(value);
  out.matrix(message.twist_covariance);
  return out.bytes;
}

Bytes write_imu(const Imu& imu, std::string_view frame, Encoding encoding) {
  Writer out(encoding);
  out.header(imu.stamp, frame);
  out.quaternion(Eigen::Quaterniond::Identity());
  out.number(-1.0);  // there is no orientation
  out.zeros(8);
  out.vector(imu.angular_velocity_R);
  out.zeros(9);
  out.vector(imu.linear_acceleration_R);
  out.zeros(9);
  return out.bytes;
}

Bytes write_transforms(std::span<const Transform> transforms, Encoding encoding) {
  Writer out(encoding);
  out.number(static_cast<std::uint32_t>(transforms.size()));
  for (const Transform& transform : transforms) {
    out.header(transform.stamp, transform.parent);
    out.text(transform.child);
    out.pose(transform.X);
  }
  return out.bytes;
}

Bytes write_markers(std::span<const Triangles> all, std::string_view frame, Encoding encoding) {
  constexpr std::int32_t triangle_list = 11, add = 0;
  Writer out(encoding);
  out.number(static_cast<std::uint32_t>(all.size()));
  for (const Triangles& one : all) {
    out.header(0, frame);
    out.text(one.name);
    out.number(std::int32_t{0});
    out.number(triangle_list);
    out.number(add);
    out.pose(Pose());
    out.vector(Eigen::Vector3d::Ones());
    for (const float value : one.colour) out.number(value);
    out.time(Nanoseconds{});      // it stays for ever
    out.number(std::uint8_t{0});  // not bound to the frame's later motion
    out.number(static_cast<std::uint32_t>(one.corners.size()));
    for (const Eigen::Vector3d& corner : one.corners) out.vector(corner);
    out.number(std::uint32_t{0});  // colours of corners
    out.text("");                  // and no texture, words or file of a mesh
    out.header(0, "");
    out.text("");
    out.number(std::uint32_t{0});
    out.number(std::uint32_t{0});
    out.text("");
    out.text("");
    out.text("");
    out.number(std::uint32_t{0});
    out.number(std::uint8_t{0});
  }
  return out.bytes;
}

Bytes write_grid(const Grid& grid, Encoding encoding) {
  Writer out(encoding);
  out.header(grid.stamp, grid.frame);
  out.time(grid.stamp);
  out.number(grid.resolution_m);
  out.number(grid.width);
  out.number(grid.height);
  out.pose({Eigen::Quaterniond::Identity(), grid.origin});
  out.number(static_cast<std::uint32_t>(grid.cells.size()));
  for (const std::int8_t cell : grid.cells) out.number(cell);
  return out.bytes;
}

FramedCloud read_cloud(std::span<const std::uint8_t> bytes, Encoding encoding) {
  Reader in(bytes, encoding);
  FramedCloud out;
  PointCloud& cloud = out.cloud;
  cloud.stamp = in.header(out.frame);
  cloud.height = in.number<std::uint32_t>();
  cloud.width = in.number<std::uint32_t>();
  for (std::size_t left = in.length(13); left > 0; --left) {
    PointField& field = cloud.fields.emplace_back();
    field.name = in.text();
    field.offset = in.number<std::uint32_t>();
    field.type = static_cast<PointType>(in.number<std::uint8_t>());
    static_cast<void>(in.number<std::uint32_t>());
  }
  if (in.number<std::uint8_t>() != 0) throw InputError({}, "a point cloud in big-endian order");
  cloud.point_step = in.number<std::uint32_t>();
  cloud.row_step = in.number<std::uint32_t>();
  const auto data = in.take(in.length(1));
  cloud.data.assign(data.begin(), data.end());
  cloud.dense = in.number<std::uint8_t>() != 0;
  return out;
}

FramedCloud read_livox(std::span<const std::uint8_t> bytes, Encoding encoding) {
  constexpr std::size_t point_bytes = 19;
  Reader in(bytes, encoding);
  FramedCloud out;
  PointCloud& cloud = out.cloud;
  const Nanoseconds stamp = in.header(out.frame);
  const auto base = in.number<std::uint64_t>();
  cloud.stamp = base < static_cast<std::uint64_t>(furthest_stamp) ? static_cast<Nanoseconds>(base) : 0;
  // A time base of 0, or of the LiDAR's own clock, is not that of the other topics.
  if (cloud.stamp == 0 || (stamp != 0 && std::abs(cloud.stamp - stamp) > second_ns)) cloud.stamp = stamp;
  const auto points = in.number<std::uint32_t>();
  static_cast<void>(in.take(4));  // the LiDAR's number, and three that are kept free
  if (in.length(point_bytes) != points) throw InputError({}, "a CustomMsg of another number of points than it says");
  cloud.fields = {{"t", 0, PointType::u32},
                  {"x", 4, PointType::f32},
                  {"y", 8, PointType::f32},
                  {"z", 12, PointType::f32},
                  {"reflectivity", 16, PointType::u8}};
  constexpr std::size_t step = 17;
  cloud.point_step = step;
  cloud.width = points;
  cloud.height = 1;
  cloud.row_step = static_cast<std::uint32_t>(step * points);
  cloud.data.resize(step * points);
  for (std::size_t i = 0; i < points; ++i) {
    std::uint8_t* to = &cloud.data[step * i];
    const auto offset = in.number<std::uint32_t>();
    std::memcpy(to, &offset, sizeof offset);
    for (std::size_t a = 0; a < 3; ++a) {
      const auto value = in.number<float>();
      std::memcpy(to + 4 + 4 * a, &value, sizeof value);
    }
    to[16] = in.number<std::uint8_t>();
    static_cast<void>(in.take(2));  // tag and line
  }
  return out;
}

OdometryMessage read_odometry(std::span<const std::uint8_t> bytes, Encoding encoding) {
  Reader in(bytes, encoding);
  OdometryMessage out;
  out.X_OR.stamp = in.header(out.X_OR.parent);
  out.X_OR.child = in.text();
  out.X_OR.X = in.pose();
  out.pose_covariance = in.matrix();
  for (double& value : out.twist) value = in.number<double>();
  out.twist_covariance = in.matrix();
  return out;
}

bool holds_poses(std::string_view type) {
  return type == "nav_msgs/Odometry" || type == "nav_msgs/Path" || type == "geometry_msgs/PoseStamped" ||
         type == "geometry_msgs/PoseWithCovarianceStamped";
}

std::vector<StampedPose> read_poses(std::string_view type, std::span<const std::uint8_t> bytes, Encoding encoding) {
  Reader in(bytes, encoding);
  std::string frame;
  const auto pose = [&] {
    const Nanoseconds stamp = in.header(frame);
    if (type == "nav_msgs/Odometry") static_cast<void>(in.text());  // frame of the child
    return StampedPose{stamp, in.pose()};
  };
  if (type != "nav_msgs/Path") return {pose()};
  static_cast<void>(in.header(frame));
  std::vector<StampedPose> poses;
  for (std::size_t left = in.length(68); left > 0; --left) poses.push_back(pose());
  return poses;
}

FramedImu read_imu(std::span<const std::uint8_t> bytes, Encoding encoding) {
  Reader in(bytes, encoding);
  FramedImu out;
  out.imu.stamp = in.header(out.frame);
  in.skip_numbers(4 + 9);
  out.imu.angular_velocity_R = in.vector();
  in.skip_numbers(9);
  out.imu.linear_acceleration_R = in.vector();
  return out;
}

std::string impossible_transforms(const std::string& topic, std::size_t count) {
  return topic + ": " + std::to_string(count) + " transforms left out: numbers that are not finite, or no rotation";
}

Transforms read_transforms(std::span<const std::uint8_t> bytes, Encoding encoding) {
  Reader in(bytes, encoding);
  Transforms out;
  for (std::size_t left = in.length(76); left > 0; --left) {
    Transform transform;
    transform.stamp = in.header(transform.parent);
    transform.child = in.text();
    try {
      transform.X = in.pose();
    } catch (const ImpossibleNumber&) {
      ++out.impossible;
      continue;
    }
    out.all.push_back(std::move(transform));
  }
  return out;
}

}  // namespace plumbline::slam::ros
