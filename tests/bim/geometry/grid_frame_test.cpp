// SPDX-License-Identifier: Apache-2.0
#include "bim/geometry/grid_frame.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(GridFrame, FindsTheCellOfEachCentreAndNoneOutside) {
  const GridFrame grid{{-1.3, 2.7}, 0.1, 17, 5};
  for (std::size_t cell = 0; cell < grid.size(); ++cell) {
    const auto [column, row] = grid.column_and_row(cell);
    EXPECT_EQ(grid.index(column, row), cell);
    EXPECT_TRUE(grid.holds(column, row));
    const Eigen::Vector2d p = grid.center(cell);
    EXPECT_EQ(grid.find(p), cell);
    EXPECT_EQ(grid.column(p.x()), column);
    EXPECT_EQ(grid.row(p.y()), row);
  }
  for (const Eigen::Vector2d& p :
       {Eigen::Vector2d(-1.35, 2.9), {-1.0, 2.65}, {0.45, 2.9}, {-1.0, 3.25}, {1e300, 2.9}, {std::nan(""), 2.9}})
    EXPECT_FALSE(grid.find(p)) << p.transpose();
  EXPECT_EQ(grid.column(-1.35), -1);
  EXPECT_FALSE(GridFrame{}.find({0.0, 0.0}));
}

}  // namespace
}  // namespace plumbline
