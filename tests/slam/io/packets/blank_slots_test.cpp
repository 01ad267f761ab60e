// SPDX-License-Identifier: Apache-2.0
// What drivers write where no return came back.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "bim/errors.h"
#include "slam/io/packets/point_cloud.h"
#include "tests/input_error.h"
#include "tests/slam/io/packets/made_cloud.h"

namespace plumbline::slam {
namespace {

/// 200 columns of one ring over 0.1 s, the last 30 ms before the stamp; each fifth without a return. Times are
/// absolute, or from the stamp; of what is no return they are `blank`, where that is given.
PointCloud late_stamped(bool absolute, std::optional<double> blank) {
  constexpr std::size_t columns = 200, step = 24;
  constexpr double stamp_s = 1'700'000'000.0, late_s = 0.03, turn_s = 0.1;
  PointCloud cloud =
      cloud_with({"x", "y", "z", "ring", "low", "high"}, std::vector<std::vector<float>>(columns, {5, 0, 0, 0, 0, 0}));
  cloud.fields.resize(4);
  cloud.fields.push_back({"timestamp", 16, PointType::f64});
  cloud.stamp = 1'700'000'000'000'000'000;
  for (std::size_t i = 0; i < columns; ++i) {
    const bool hit = i % 5 != 4;
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / columns;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::array<float, 2> p = {hit ? static_cast<float>(5.0 * std::cos(angle)) : nan,
                                    hit ? static_cast<float>(5.0 * std::sin(angle)) : nan};
    const double t = (absolute ? stamp_s : 0.0) - late_s - turn_s * (1.0 - static_cast<double>(i) / columns);
    const double said = hit ? t : blank.value_or(t);
    std::memcpy(&cloud.data[step * i], p.data(), sizeof p);
    std::memcpy(&cloud.data[step * i + 16], &said, sizeof said);
  }
  return cloud;
}

TEST(PointCloud, SlotsWithoutReturnsDoNotMoveItsEnd) {
  for (const bool absolute : {true, false}) {
    const Scan real = scan_of(late_stamped(absolute, {}));
    for (const double blank : {0.0, std::numeric_limits<double>::quiet_NaN()}) {
      if (!absolute && blank == 0.0) continue;  // may be the time of that slot
      const Scan scan = scan_of(late_stamped(absolute, blank));
      ASSERT_EQ(scan.size(), real.size());
      // A double keeps 0.24 us of the time of the day; the last column is one without a return, 0.5 ms after the last
      // that has one.
      EXPECT_NEAR(static_cast<double>(scan.stamp), static_cast<double>(real.stamp - 500'000), 1e3);
      for (std::size_t i = 0; i < scan.size(); ++i) {
        const auto later = static_cast<double>(scan.stamp + scan.offset_ns[i] - real.stamp - real.offset_ns[i]);
        EXPECT_LE(later, 1e3) << i;
        EXPECT_GE(later, scan.range_m[i] > 0.0 ? -1e3 : -5e5 - 1e3) << i;
      }
    }
  }
}

TEST(PointCloud, AReturnWithoutATimeIsNone) {
  PointCloud cloud = late_stamped(true, {});
  const Scan real = scan_of(cloud);
  for (const double wrong : {0.0, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
    std::memcpy(&cloud.data[24 * 50 + 16], &wrong, sizeof wrong);
    const Scan scan = scan_of(cloud);
    EXPECT_EQ(scan.stamp, real.stamp);
    EXPECT_EQ(std::count_if(scan.range_m.begin(), scan.range_m.end(), [](double r) { return r > 0.0; }), 159);
  }
  for (const std::size_t column : {50U, 60U, 70U}) {
    const double wrong = 0.0;
    std::memcpy(&cloud.data[24 * column + 16], &wrong, sizeof wrong);
  }
  EXPECT_THROW((void)scan_of(cloud), InputError) << "3 of 160";
}

TEST(PointCloud, TimesOnAnotherClockAreToldApart) {
  for (const auto& [later_s, said] :
       {std::pair(-37.0, "are 36.9 s ahead of"), std::pair(500.0, "are 500.1 s behind")}) {
    PointCloud cloud = late_stamped(true, {});
    cloud.stamp += std::llround(1e9 * later_s);
    const std::string why = input_error([&] { (void)scan_of(cloud); });
    EXPECT_NE(why.find("times of field 'timestamp' " + std::string(said) + " the cloud's stamp"), std::string::npos)
        << why;
  }
}

TEST(PointCloud, FieldsThatMayBeTimesAreNamedWhereNoneIsRead) {
  PointCloud cloud =
      cloud_with({"x", "y", "z", "timeSecond", "timeNanosecond"}, std::vector<std::vector<float>>(10, {5, 0, 0, 1, 2}));
  SweepLengthSearch search(TimeBase::unknown);
  EXPECT_FALSE(search.add(cloud));
  EXPECT_EQ(search.found().said, "fields timeSecond, timeNanosecond: not read as times of points");
}

}  // namespace
}  // namespace plumbline::slam
