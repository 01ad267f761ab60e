// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "slam/io/packets/point_cloud.h"
#include "tests/slam/io/packets/packets.h"

namespace plumbline::slam {

inline Scan some_scan() { return decode_message(turning_packets(76)); }

/// A cloud of f32 fields with these names, one value a field and point.
inline PointCloud cloud_with(const std::vector<std::string>& names, const std::vector<std::vector<float>>& points) {
  PointCloud cloud;
  for (const std::string& name : names)
    cloud.fields.push_back({name, static_cast<std::uint32_t>(4 * cloud.fields.size()), PointType::f32});
  cloud.point_step = static_cast<std::uint32_t>(4 * names.size());
  cloud.width = static_cast<std::uint32_t>(points.size());
  cloud.height = 1;
  cloud.row_step = cloud.width * cloud.point_step;
  for (const std::vector<float>& point : points)
    for (const float value : point) {
      cloud.data.resize(cloud.data.size() + 4);
      std::memcpy(&cloud.data[cloud.data.size() - 4], &value, 4);
    }
  return cloud;
}

inline void expect_near(const Scan& a, const Scan& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a.range_m[i] > 0.0, b.range_m[i] > 0.0) << i;
    // A float keeps 24 bits of up to 20 m: 1 um.
    ASSERT_LT((a.point_L[i] - b.point_L[i]).norm(), 3e-6) << i;
    ASSERT_EQ(a.reflectivity[i], b.reflectivity[i]) << i;
  }
}

}  // namespace plumbline::slam
