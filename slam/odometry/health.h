// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <limits>
#include <optional>

#include "bim/config/visit.h"
#include "slam/io/records.h"
#include "slam/registration/registration.h"

namespace plumbline::slam {

struct HealthConfig {
  double usual_share = 0.5;
  double confirmed_share = 0.25;
  double min_matched = 0.15;
  int recent_scans = 20;
  double as_usual_share = 0.7;
  double sure_share = 0.85;
  double max_deviation_m = 0.2;
  double max_deviation_rad = 0.3;
  double max_acceleration_mps2 = 10.0;
  double max_turn_acceleration_radps2 = 20.0;
  double max_start_speed_mps = 40.0;
  int bad_scans = 3;
  int good_scans = 10;
  int restart_scans = 20;
  double restart_s = 2.0;
  double max_unobserved_m = 1.0;
  double measuring_share = 0.5;

  [[nodiscard]] Nanoseconds restart_ns() const { return static_cast<Nanoseconds>(restart_s * 1e9); }

  template <class V>
  void visit(V& v) {
    v("usual_share", usual_share,
      share_field(
          "share of what recent scans matched of their features, in the median, below which a scan does not fit"));
    v("confirmed_share", confirmed_share,
      share_field("the same for a scan whose step was expected and whose residual is as usual: behind a door little of "
                  "a scan was seen before"));
    v("min_matched", min_matched,
      share_field("least share of a scan's features that must match the map, whatever is usual"));
    v("recent_scans", recent_scans,
      Field{.doc = "accepted scans whose median is the usual share of matches", .min = 1, .max = 1000});
    v("as_usual_share", as_usual_share,
      share_field("the same for a scan whose step neither odometry nor the motion before let expect"));
    v("sure_share", sure_share,
      share_field("the same below which such a step may be an alias: the place counts as unknown from there on"));
    v("max_deviation_m", max_deviation_m,
      Field{.doc = "how far a plausible step may be from what odometry or the motion before let expect, whatever the "
                   "time between scans",
            .min = 0.0});
    v("max_deviation_rad", max_deviation_rad, Field{.doc = "the same for its rotation", .min = 0.0});
    v("max_acceleration_mps2", max_acceleration_mps2,
      Field{
          .doc = "and how much farther: largest acceleration of a plausible step, beside odometry and the step before",
          .unit = "m/s²",
          .min = 0.1});
    v("max_turn_acceleration_radps2", max_turn_acceleration_radps2,
      Field{.doc = "largest angular acceleration of a plausible step", .unit = "rad/s²", .min = 0.1});
    v("max_start_speed_mps", max_start_speed_mps,
      Field{.doc = "largest speed of the first step, when none is known", .min = 0.1});
    v("bad_scans", bad_scans, Field{.doc = "bad scans in a row after which the odometry is lost", .min = 1});
    v("good_scans", good_scans, Field{.doc = "good scans in a row after which it has recovered", .min = 1});
    v("restart_scans", restart_scans, Field{.doc = "bad scans in a row after which a new map starts", .min = 1});
    v("restart_s", restart_s,
      Field{.doc = "or, without odometry, time lost after which it does", .min = 0.0, .max = 1e6});
    v("max_unobserved_m", max_unobserved_m,
      Field{.doc = "standard deviation of unmeasured motion, above which the odometry is lost", .min = 0.01});
    // Chosen on 36 walks without odometry. The usual share is 0.35 to 0.50 on five: three are off by metres, two, among
    // leaves, by 0.3 m. On the others it is 0.59 to 0.98.
    v("measuring_share", measuring_share,
      share_field("usual share of matches below which scans without odometry do not measure the motion"));
  }
};

/// A step that is expected, and how far such steps were off of late or are as a rule; infinite where that is not known.
struct ExpectedMotion {
  // Not explicit: a step alone is expected, too.
  ExpectedMotion(const Pose& expected, double sigma = std::numeric_limits<double>::infinity(),
                 double rotation_sigma = std::numeric_limits<double>::infinity())
      : step(expected), sigma_m(sigma), sigma_rad(rotation_sigma) {}

  Pose step;
  double sigma_m;
  double sigma_rad;
};

/// What a step may be compared with. Either of them suffices: feet slip, and a robot may stop.
struct ExpectedStep {
  Nanoseconds dt = 0;                       ///< since the scan before
  std::optional<ExpectedMotion> odometry;   ///< what odometry measured of it
  std::optional<ExpectedMotion> continued;  ///< as if the motion before went on
};

/// By how far a step is not the one that was expected: as far as a point of the scene that is next to the robot.
[[nodiscard]] double surprise_m(const Pose& step, const Pose& expected);

/// Whether scan matching is trusted: for each scan at once, and as a state with hysteresis. All that it compares with
/// comes from the scans before: no sensor's noise, no robot's speed. "Usual" is the median share of matched features
/// over the latest accepted scans.
class OdometryHealth {
 public:
  explicit OdometryHealth(const HealthConfig& config) : config_(config) {}

  /// Assesses one registration. step: the robot's motion since the scan before. True: accept it.
  [[nodiscard]] bool assess(const Registration& registration, const Pose& step, const ExpectedStep& expected);
  /// That median, in [0, 1]; 1 before enough scans were accepted.
  [[nodiscard]] double usual_matched() const;
  /// Median residual of the same scans, m; 0 before any was accepted.
  [[nodiscard]] double usual_residual() const;
  /// Whether scans, matched as is usual, measure a motion by themselves. Where most of what they see contradicts the
  /// map, as among vehicles that move along or rows of leaves, a pose that fits the rest may be any.
  [[nodiscard]] bool measures() const { return usual_matched() >= config_.measuring_share; }
  /// Whether a scan matches about as much as is usual.
  [[nodiscard]] bool is_as_usual(const Registration& registration) const {
    return registration.matched >= config_.as_usual_share * usual();
  }
  /// Whether a step that nothing let expect rests on a match that is clearly poorer than usual: it may be an alias of
  /// the place.
  [[nodiscard]] bool is_doubtful(const Registration& registration, const Pose& step,
                                 const ExpectedStep& expected) const {
    return registration.matched < config_.sure_share * usual() && !is_expected_step(step, expected);
  }
  /// Share below which a scan does not fit.
  [[nodiscard]] double least_matched(const Registration& registration, const Pose& step,
                                     const ExpectedStep& expected) const;
  /// How far a robot can have come in dt from where its motion leads.
  struct Reach {
    double way_m, turn_rad;
  };
  [[nodiscard]] Reach reach(Nanoseconds dt) const;
  /// Whether a robot can have made this step.
  [[nodiscard]] bool is_plausible_step(const Pose& step, const ExpectedStep& expected) const;
  /// Whether this step is within the errors of what let it expect. True where nothing did.
  [[nodiscard]] static bool is_expected_step(const Pose& step, const ExpectedStep& expected);
  [[nodiscard]] bool lost() const { return lost_; }
  /// True once after so many bad scans that the map is of no use.
  [[nodiscard]] bool wants_restart() const { return bad_ > 0 && bad_ % config_.restart_scans == 0; }
  /// A new map began: nothing is usual yet.
  void restart();

 private:
  [[nodiscard]] double usual() const;  ///< 0 before any scan matched

  HealthConfig config_;
  std::deque<double> matched_;    ///< by accepted scans
  std::deque<double> residuals_;  ///< of the same
  int bad_ = 0, good_ = 0;        ///< in a row
  bool lost_ = false;
};

}  // namespace plumbline::slam
