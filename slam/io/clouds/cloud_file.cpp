// SPDX-License-Identifier: Apache-2.0
// Apart, for what it includes takes long to compile.
#include "slam/io/clouds/cloud_file.h"

#include <fcntl.h>
#include <pcl/PCLPointCloud2.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

#include "bim/config/tree.h"
#include "slam/io/clouds/quiet_pcl.h"
#include "slam/io/packets/cloud_fields.h"

namespace plumbline::slam {

namespace {

int read_pcd(const std::string& bytes, const CloudHeader& header, pcl::PCLPointCloud2& cloud) {
  pcl::PCDReader reader;
  std::istringstream stream(bytes);
  Eigen::Vector4f origin;
  Eigen::Quaternionf orientation;
  int version = 0, type = 0;
  unsigned int body = 0;
  if (const int failed = reader.readHeader(stream, cloud, origin, orientation, version, type, body); failed < 0)
    return failed;
  if (cloud.point_step != header.step || cloud.data.size() != header.points() * header.step) return -1;
  if (header.data == CloudData::ascii) {
    stream.clear();
    stream.seekg(static_cast<std::istringstream::off_type>(header.size));
    return reader.readBodyASCII(stream, cloud, version);
  }
  return reader.readBodyBinary(reinterpret_cast<const unsigned char*>(bytes.data()), cloud, version,
                               header.data == CloudData::compressed, static_cast<unsigned int>(header.size));
}

/// Types have ROS's numbers in PCL, too.
PointCloud from_pcl(pcl::PCLPointCloud2&& from) {
  PointCloud cloud;
  cloud.width = from.width;
  cloud.height = from.height;
  cloud.point_step = from.point_step;
  cloud.row_step = from.width * from.point_step;
  cloud.dense = from.is_dense != 0;
  for (const pcl::PCLPointField& field : from.fields)
    if (field.count <= 1 && field.name != "_" && field.datatype >= 1 && field.datatype <= 8)
      cloud.fields.push_back({field.name, field.offset, static_cast<PointType>(field.datatype)});
  cloud.data = std::move(from.data);
  return cloud;
}

pcl::PCLPointCloud2 to_pcl(const PointCloud& from) {
  pcl::PCLPointCloud2 cloud;
  cloud.width = from.width;
  cloud.height = from.height;
  cloud.point_step = from.point_step;
  cloud.row_step = from.row_step;
  cloud.is_dense = from.dense ? 1 : 0;
  for (const PointField& field : from.fields) {
    pcl::PCLPointField to;
    to.name = field.name;
    to.offset = field.offset;
    to.datatype = static_cast<std::uint8_t>(field.type);
    to.count = 1;
    cloud.fields.push_back(std::move(to));
  }
  cloud.data = from.data;
  return cloud;
}

int write_binary(const std::string& file, CloudFormat format, const pcl::PCLPointCloud2& cloud) {
  const Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  const Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
  const bool ply = format == CloudFormat::ply;
  if (ply && !cloud.data.empty()) return pcl::PLYWriter().writeBinary(file, cloud, origin, orientation, false);
  const std::string header = ply ? pcl::PLYWriter().generateHeaderBinary(cloud, origin, orientation, 0, false)
                                 : pcl::PCDWriter().generateHeaderBinary(cloud, origin, orientation) + "DATA binary\n";
  if (cloud.data.empty()) {  // PCL refuses to write no points
    std::ofstream stream(file, std::ios::binary);
    return stream << header << std::flush ? 0 : -1;
  }
  const int failed = pcl::PCDWriter().writeBinary(file, cloud, origin, orientation);
  if (failed >= 0) std::filesystem::resize_file(file, header.size() + cloud.data.size());  // it is a page longer
  return failed;
}

/// Onto the disk, and then in the place of what has this name.
bool publish(const std::string& temporary, const std::string& file) {
  const int handle = ::open(temporary.c_str(), O_RDONLY | O_CLOEXEC);
  if (handle < 0) return false;
  const bool synced = ::fsync(handle) == 0 || errno == EINVAL;
  ::close(handle);
  return synced && std::rename(temporary.c_str(), file.c_str()) == 0;
}

}  // namespace

PointCloud read_cloud_file(const std::string& file) {
  const CloudFormat format = cloud_format_of(file);
  const std::string bytes = read_text_file(file);
  const CloudHeader header = read_cloud_header(bytes, format, file);
  pcl::PCLPointCloud2 cloud;
  if (header.points() == 0) return {};
  quiet_pcl();
  int failed = 0;
  try {
    failed = format == CloudFormat::pcd ? read_pcd(bytes, header, cloud) : pcl::PLYReader().read(file, cloud);
  } catch (const std::exception& error) {
    throw InputError({file, 0, 0}, std::string("PCL cannot read it: ") + error.what());
  }
  const std::uint64_t points = std::uint64_t{cloud.width} * cloud.height;
  if (failed < 0 || points != header.points() || cloud.data.size() != points * cloud.point_step)
    throw InputError({file, 0, 0}, "PCL cannot read it: its points are damaged");
  return from_pcl(std::move(cloud));
}

void write_cloud_file(const std::string& file, const PointCloud& cloud) {
  quiet_pcl();
  const CloudFormat format = cloud_format_of(file);
  const std::string temporary = file + ".tmp";
  int failed = 0;
  try {
    pcl::PCLPointCloud2 points = to_pcl(cloud);
    if (format == CloudFormat::ply) {  // which has no rows
      points.width *= points.height;
      points.height = 1;
      points.row_step = points.width * points.point_step;
    }
    failed = write_binary(temporary, format, points);
  } catch (const std::exception& error) {
    std::remove(temporary.c_str());
    throw EnvironmentError("cannot write " + file + ": " + error.what());
  }
  if (failed >= 0 && publish(temporary, file)) return;
  std::remove(temporary.c_str());
  throw EnvironmentError("cannot write " + file);
}

PointCloud cloud_of(const std::vector<Eigen::Vector3f>& points) {
  PointCloud cloud;
  cloud.width = static_cast<std::uint32_t>(points.size());
  cloud.height = 1;
  cloud.point_step = 3 * sizeof(float);
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.dense = true;
  cloud.fields = {{"x", 0, PointType::f32}, {"y", 4, PointType::f32}, {"z", 8, PointType::f32}};
  cloud.data.resize(points.size() * cloud.point_step);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) throw InternalError("a map point is not a finite number");
    std::memcpy(&cloud.data[i * cloud.point_step], points[i].data(), cloud.point_step);
  }
  return cloud;
}

std::vector<Eigen::Vector3f> points_of(const PointCloud& cloud, const Mark& mark) {
  std::vector<Eigen::Vector3f> points;
  if (cloud.data.empty()) return points;
  std::array<const PointField*, 3> fields{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto is_axis = [&](const PointField& f) { return f.name == std::string_view("xyz").substr(axis, 1); };
    const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(), is_axis);
    if (field == cloud.fields.end() || (field->type != PointType::f32 && field->type != PointType::f64))
      throw InputError(mark, "a cloud of x, y, z as float or double is expected");
    fields[axis] = &*field;
  }
  for (std::size_t at = 0; at + cloud.point_step <= cloud.data.size(); at += cloud.point_step) {
    Eigen::Vector3f p;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const PointField& field = *fields[static_cast<std::size_t>(axis)];
      p[axis] = static_cast<float>(number_at(&cloud.data[at + field.offset], field.type));
    }
    if (p.allFinite()) points.push_back(p);
  }
  return points;
}

std::vector<Eigen::Vector3f> read_cloud_points(const std::string& file) {
  return points_of(read_cloud_file(file), {file, 0, 0});
}

}  // namespace plumbline::slam
