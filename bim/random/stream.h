// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace plumbline {

/// Every random stream of the program, by name. Estimators may use "slam.*" only (ci/check_layers).
[[nodiscard]] std::span<const std::string_view> stream_names();

/// What the streams of a run are drawn from. Parts of a run differ in their noise; what is drawn once for all of it, as
/// an instrument's calibration error, is drawn by `run` alone.
struct Seed {
  // NOLINTNEXTLINE(google-explicit-constructor): a number is the seed of a run with one part
  Seed(std::uint64_t of_run, std::uint32_t of_part = 0) : run(of_run), part(of_part) {}

  std::uint64_t run;
  std::uint32_t part;
};

/// Counter-based random numbers (Philox4x32-10 [salmon2011]). A draw is addressed by (tick, lane, draw) and depends on
/// nothing else, so neither order nor threads nor another consumer can change it.
class Stream {
 public:
  /// name must stand in stream_names(), else InternalError.
  Stream(Seed seed, std::string_view name);

  /// 64 random bits.
  [[nodiscard]] std::uint64_t bits(std::uint64_t tick, std::uint32_t lane = 0, std::uint32_t draw = 0) const;
  /// Uniform in [0, 1), 53 bits.
  [[nodiscard]] double uniform(std::uint64_t tick, std::uint32_t lane = 0, std::uint32_t draw = 0) const;
  /// Standard normal (Box-Muller).
  [[nodiscard]] double gauss(std::uint64_t tick, std::uint32_t lane = 0, std::uint32_t draw = 0) const;
  /// Four independent standard normals at the cost of one block (Box-Muller on 32 bits each, up to 6.8 sigma).
  [[nodiscard]] std::array<double, 4> gauss4(std::uint64_t tick, std::uint32_t lane = 0, std::uint32_t draw = 0) const;

 private:
  std::uint64_t key_;
};

/// The seed a method gets: derived from the run's seed and the method's name, so that no estimator can redraw what
/// the simulator drew.
[[nodiscard]] std::uint64_t method_seed(std::uint64_t run_seed, std::string_view method);

}  // namespace plumbline
