// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/generators/floor_template.h"

namespace plumbline {
class Stream;
}

namespace plumbline::bim {

// One pair a family: sizes at random, always buildable, and the floor they give. A design that cannot be built with
// the sizes asked for is an InputError at `mark`.

void draw_sizes(CorridorOptions& options, const Stream& stream);
void draw_sizes(UnitOptions& options, const Stream& stream);
void draw_sizes(Rot90Options& options, const Stream& stream);
void draw_sizes(GridOptions& options, const Stream& stream);
void draw_sizes(RingOptions& options, const Stream& stream);
void draw_sizes(HallOptions& options, const Stream& stream);
void draw_sizes(ShapeOptions& options, const Stream& stream);
void draw_sizes(LongOptions& options, const Stream& stream);

[[nodiscard]] Design corridor(const CorridorOptions& options, const Mark& mark);
[[nodiscard]] Design rot180(const UnitOptions& options, const Mark& mark);
[[nodiscard]] Design mirrored(const UnitOptions& options, const Mark& mark);
[[nodiscard]] Design storeys(const UnitOptions& options, const Mark& mark);
[[nodiscard]] Design rot90(const Rot90Options& options, const Mark& mark);
[[nodiscard]] Design grid(const GridOptions& options, const Mark& mark);
[[nodiscard]] Design ring(const RingOptions& options, const Mark& mark);
[[nodiscard]] Design hall(const HallOptions& options, const Mark& mark);
[[nodiscard]] Design shapes(const ShapeOptions& options, const Mark& mark);
[[nodiscard]] Design long_corridor(const LongOptions& options, const Mark& mark);

}  // namespace plumbline::bim
