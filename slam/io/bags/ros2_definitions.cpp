// SPDX-License-Identifier: Apache-2.0
#include "slam/io/bags/ros2_definitions.h"

#include <array>
#include <string_view>
#include <vector>

#include "bim/errors.h"

namespace plumbline::slam {

namespace {

/// Fields of a type, a line each.
struct Definition {
  std::string_view name;
  std::string_view fields;
};

constexpr std::array<Definition, 26> definitions = {{
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
    {"geometry_msgs/Pose", "Point position\nQuaternion orientation\n"},
    {"geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance\n"},
    {"geometry_msgs/Twist", "Vector3 linear\nVector3 angular\n"},
    {"geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance\n"},
    {"geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation\n"},
    {"geometry_msgs/TransformStamped", "std_msgs/Header header\nstring child_frame_id\nTransform transform\n"},
    {"sensor_msgs/PointField",
     "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\nuint8 FLOAT32=7\n"
     "uint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    {"rosgraph_msgs/Clock", "builtin_interfaces/Time clock\n"},
    {"sensor_msgs/PointCloud2",
     "std_msgs/Header header\nuint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\nuint32 point_step\n"
     "uint32 row_step\nuint8[] data\nbool is_dense\n"},
    {"sensor_msgs/Imu",
     "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
     "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
     "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
     "geometry_msgs/TwistWithCovariance twist\n"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"},
    {"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"},
    {"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"},
    {"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"},
    {"visualization_msgs/Marker",
     "int32 TRIANGLE_LIST=11\nint32 ADD=0\nstd_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\n"
     "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\n"
     "builtin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\n"
     "std_msgs/ColorRGBA[] colors\nstring texture_resource\nsensor_msgs/CompressedImage texture\n"
     "UVCoordinate[] uv_coordinates\nstring text\nstring mesh_resource\nMeshFile mesh_file\n"
     "bool mesh_use_embedded_materials\n"},
    {"visualization_msgs/MarkerArray", "Marker[] markers\n"},
    {"nav_msgs/MapMetaData",
     "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\n"
     "geometry_msgs/Pose origin\n"},
    {"nav_msgs/OccupancyGrid", "std_msgs/Header header\nMapMetaData info\nint8[] data\n"},
}};

std::string_view definition_fields(std::string_view name) {
  for (const Definition& definition : definitions)
    if (definition.name == name) return definition.fields;
  throw InternalError("no definition of " + std::string(name));
}

/// The type first, then each that it needs, once, before those of the next.
std::vector<std::string_view> types_of(MessageType type) {
  constexpr std::string_view header = "std_msgs/Header", time = "builtin_interfaces/Time";
  switch (type) {
    case MessageType::clock:
      return {"rosgraph_msgs/Clock", time};
    case MessageType::cloud:
      return {"sensor_msgs/PointCloud2", header, time, "sensor_msgs/PointField"};
    case MessageType::odometry:
      return {"nav_msgs/Odometry",
              header,
              time,
              "geometry_msgs/PoseWithCovariance",
              "geometry_msgs/Pose",
              "geometry_msgs/Point",
              "geometry_msgs/Quaternion",
              "geometry_msgs/TwistWithCovariance",
              "geometry_msgs/Twist",
              "geometry_msgs/Vector3"};
    case MessageType::imu:
      return {"sensor_msgs/Imu", header, time, "geometry_msgs/Quaternion", "geometry_msgs/Vector3"};
    case MessageType::transforms:
      return {"tf2_msgs/TFMessage",    "geometry_msgs/TransformStamped", header, time, "geometry_msgs/Transform",
              "geometry_msgs/Vector3", "geometry_msgs/Quaternion"};
    case MessageType::markers:
      return {"visualization_msgs/MarkerArray",
              "visualization_msgs/Marker",
              header,
              time,
              "geometry_msgs/Pose",
              "geometry_msgs/Point",
              "geometry_msgs/Quaternion",
              "geometry_msgs/Vector3",
              "std_msgs/ColorRGBA",
              "builtin_interfaces/Duration",
              "sensor_msgs/CompressedImage",
              "visualization_msgs/UVCoordinate",
              "visualization_msgs/MeshFile"};
    case MessageType::grid:
      return {
          "nav_msgs/OccupancyGrid",  header, time, "nav_msgs/MapMetaData", "geometry_msgs/Pose", "geometry_msgs/Point",
          "geometry_msgs/Quaternion"};
  }
  throw InternalError("unknown type of message");
}

}  // namespace

std::string ros2_type(MessageType type) {
  std::string name(types_of(type).front());
  return name.insert(name.find('/'), "/msg");
}

std::string ros2_definition(MessageType type) {
  std::string text;
  for (const std::string_view name : types_of(type)) {
    if (!text.empty()) text += std::string(80, '=') + "\nMSG: " + std::string(name) + "\n";
    text += definition_fields(name);
  }
  return text;
}

std::string ros2_qos(bool latched) {
  const std::string forever = "    sec: 9223372036\n    nsec: 854775807\n";
  return "- history: 1\n  depth: " + std::string(latched ? "1" : "10") +
         "\n  reliability: 1\n  durability: " + (latched ? "1" : "2") + "\n  deadline:\n" + forever + "  lifespan:\n" +
         forever + "  liveliness: 1\n  liveliness_lease_duration:\n" + forever +
         "  avoid_ros_namespace_conventions: false";
}

}  // namespace plumbline::slam
