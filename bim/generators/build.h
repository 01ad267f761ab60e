// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/generators/floor_template.h"

namespace plumbline {
class Stream;
}

namespace plumbline::bim {

// One pair a family: sampled parameters, always buildable, and the floor template they give. A template that cannot be
// built with the given sizes is an InputError at `mark`.

void sample_parameters(CorridorOptions& options, const Stream& stream);
void sample_parameters(UnitOptions& options, const Stream& stream);
void sample_parameters(Rot90Options& options, const Stream& stream);
void sample_parameters(GridOptions& options, const Stream& stream);
void sample_parameters(RingOptions& options, const Stream& stream);
void sample_parameters(HallOptions& options, const Stream& stream);
void sample_parameters(ShapeOptions& options, const Stream& stream);
void sample_parameters(LongOptions& options, const Stream& stream);

[[nodiscard]] FloorTemplate corridor(const CorridorOptions& options, const Mark& mark);
[[nodiscard]] FloorTemplate rot180(const UnitOptions& options, const Mark& mark);
[[nodiscard]] FloorTemplate mirrored(const UnitOptions& options, const Mark& mark);
[[nodiscard]] FloorTemplate storeys(const UnitOptions& options, const Mark& mark);
[[nodiscard]] FloorTemplate rot90(const Rot90Options& options, const Mark& mark);
[[nodiscard]] FloorTemplate grid(const GridOptions& options, const Mark& mark);
[[nodiscard]] FloorTemplate ring(const RingOptions& options, const Mark& mark);
[[nodiscard]] FloorTemplate hall(const HallOptions& options, const Mark& mark);
[[nodiscard]] FloorTemplate shapes(const ShapeOptions& options, const Mark& mark);
[[nodiscard]] FloorTemplate long_corridor(const LongOptions& options, const Mark& mark);

}  // namespace plumbline::bim
