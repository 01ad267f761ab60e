// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "scenarios/score/score_run.h"

namespace plumbline::scenarios::score {

/// When a method's run is worth a look: where a localization that failed first gave a wrong answer from then on, or
/// else failed; where a method first said that it is lost; else where its error is greatest. On the run's clock, s;
/// absent without a pose.
[[nodiscard]] std::optional<double> telling_moment(const FinishedRun& run, const RunScore& score,
                                                   const std::string& method);

/// When a gate's method is worth a look. Of a metric that is absent the greatest error says nothing: there, where the
/// method failed or was lost, or nothing.
[[nodiscard]] std::optional<double> telling_moment(const FinishedRun& run, const RunScore& score,
                                                   const GateResult& gate);

/// A moment for a link, s, rounded up to 1 / steps: earlier nothing has happened yet.
[[nodiscard]] double rounded_up(double t_s, double steps);

/// A value of a link: letters, digits, "_", ".", "-" and "/" as they are, the rest as %XX.
[[nodiscard]] std::string in_link(const std::string& text);

/// "#t=34.1&m=vgicp" of the replay page, at that moment; empty where a gate has none because its metric is absent.
[[nodiscard]] std::string moment_link(const FinishedRun& run, const RunScore& score, const GateResult& gate);

}  // namespace plumbline::scenarios::score
