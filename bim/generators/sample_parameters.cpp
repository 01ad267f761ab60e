// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "bim/generators/build.h"
#include "bim/random/stream.h"

namespace plumbline::bim {

namespace {

/// Random numbers in the order of the calls; sizes in whole centimetres.
class Dice {
 public:
  explicit Dice(const Stream& stream) : stream_(stream) {}
  double size(double low, double high) {
    return std::round(100.0 * (low + (high - low) * stream_.uniform(draw_++))) / 100.0;
  }
  int count(int low, int high) { return low + static_cast<int>((high - low + 1) * stream_.uniform(draw_++)); }

 private:
  const Stream& stream_;
  std::uint64_t draw_ = 0;
};

void draw_walls(GeneratorOptions& options, Dice& dice) {
  options.height_m = dice.size(2.5, 3.6);
  options.facade_m = dice.size(0.2, 0.4);
  options.partition_m = dice.size(0.08, 0.2);
  options.door_m = dice.size(0.95, 1.1);
}

}  // namespace

void sample_parameters(CorridorOptions& options, const Stream& stream) {
  Dice dice(stream);
  draw_walls(options, dice);
  options.rooms = dice.count(3, 7);
  options.sides = dice.count(0, 1) == 0 ? Sides::one : Sides::both;
  options.room_width_m = dice.size(3.2, 5.5);
  options.room_depth_m = dice.size(3.5, 6.0);
  options.corridor_width_m = dice.size(1.8, 3.0);
  options.door_offset_m = dice.size(0.2, 0.6);
}

void sample_parameters(UnitOptions& options, const Stream& stream) {
  Dice dice(stream);
  draw_walls(options, dice);
  options.unit_width_m = dice.size(7.5, 11.0);
  options.unit_depth_m = dice.size(9.5, 13.0);
  options.hall_width_m = dice.size(1.7, 2.3);
}

void sample_parameters(Rot90Options& options, const Stream& stream) {
  Dice dice(stream);
  draw_walls(options, dice);
  options.core_m = dice.size(5.5, 9.0);
  options.arm_m = dice.size(3.0, 5.0);
}

void sample_parameters(GridOptions& options, const Stream& stream) {
  Dice dice(stream);
  draw_walls(options, dice);
  options.rows = dice.count(2, 4);
  options.columns = dice.count(2, 5);
  options.room_width_m = dice.size(3.2, 5.5);
  options.room_depth_m = dice.size(3.2, 5.5);
}

void sample_parameters(RingOptions& options, const Stream& stream) {
  Dice dice(stream);
  draw_walls(options, dice);
  options.rooms = dice.count(2, 3);
  options.core_m = dice.size(6.0, 10.0);
  options.corridor_width_m = dice.size(1.8, 2.8);
  options.room_depth_m = dice.size(3.0, 5.0);
  options.door_offset_m = dice.size(0.1, 0.5);
}

void sample_parameters(HallOptions& options, const Stream& stream) {
  Dice dice(stream);
  draw_walls(options, dice);
  options.width_m = dice.size(14.0, 24.0);
  options.depth_m = dice.size(9.0, 14.0);
  options.side_room_m = dice.size(3.2, 5.0);
  options.pillar_m = dice.size(0.25, 0.6);
  options.pillars_x = dice.count(2, 4);
  options.pillars_y = dice.count(1, 3);
}

void sample_parameters(ShapeOptions& options, const Stream& stream) {
  Dice dice(stream);
  draw_walls(options, dice);
  options.shape = static_cast<RoomShape>(dice.count(0, 2));
  options.width_m = dice.size(9.0, 14.0);
  options.depth_m = dice.size(6.0, 10.0);
  options.step_m = dice.size(1.3, 2.5);
}

void sample_parameters(LongOptions& options, const Stream& stream) {
  Dice dice(stream);
  draw_walls(options, dice);
  options.length_m = dice.size(20.0, 60.0);
  options.width_m = dice.size(1.8, 3.0);
  options.end_room_m = dice.size(3.2, 5.0);
}

}  // namespace plumbline::bim
