// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "bim/config/visit.h"

namespace plumbline::slam {

/// One point of the plan-localization paper: as it is printed, or corrected.
enum class PaperVariant { printed, corrected };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(PaperVariant) { return {"printed", "corrected"}; }

/// Each defect of [shaheer2023] by itself, docs/methods/baselines.md. Printed where that runs and is not ruled out by
/// the paper's own results; so corrected are the increment (printed, particles walk backwards), the weight (printed, it
/// grows without bound with negative residuals), the faces (printed, the second face of a wall lies on the far side of
/// W's origin) and the state (printed, z, roll and pitch are drawn at random too, which no number of particles fills).
struct PaperSwitches {
  bool rooms = true;
  PaperVariant increment = PaperVariant::corrected;
  PaperVariant weight = PaperVariant::corrected;
  PaperVariant planes = PaperVariant::printed;
  PaperVariant faces = PaperVariant::corrected;
  PaperVariant form = PaperVariant::printed;
  PaperVariant frame = PaperVariant::printed;
  PaperVariant wrap = PaperVariant::printed;
  PaperVariant extent = PaperVariant::printed;
  PaperVariant classes = PaperVariant::printed;
  PaperVariant roomless = PaperVariant::printed;
  PaperVariant outline = PaperVariant::printed;
  PaperVariant yaw = PaperVariant::printed;
  PaperVariant resampling = PaperVariant::printed;
  PaperVariant tempering = PaperVariant::printed;
  PaperVariant convergence = PaperVariant::printed;
  PaperVariant state = PaperVariant::corrected;
  PaperVariant handover = PaperVariant::printed;

  template <class V>
  void visit(V& v) {
    // Off: every particle is matched with all walls [shaheer2023, table 6].
    v("rooms", rooms,
      Field{.doc = "topological factor: match only against walls of the room a particle is in", .basic = true});
    v("increment", increment, Field{.doc = "eq. 5: x_t^-1 x_t-1; corrected: its inverse"});
    // The factors of a scan's planes multiply either way.
    v("weight", weight,
      Field{.doc =
                "eq. 8-9: signed, variance multiplies, mu of one dimension; corrected: Gaussian of three dimensions, "
                "squared, divided by variances, with its determinant for mu"});
    v("planes", planes, Field{.doc = "dropped observations cost nothing; corrected: every plane counts, as a mixture"});
    v("faces", faces, Field{.doc = "eq. 2: second face (-n, d + T); corrected: where it is"});
    v("form", form, Field{.doc = "eq. 3: closest point, which has no side; corrected: normal towards the sensor"});
    v("frame", frame, Field{.doc = "eq. 7 compares in W; corrected: in the sensor's frame"});
    v("wrap", wrap, Field{.doc = "differences of angles are not wrapped; corrected: they are"});
    v("extent", extent, Field{.doc = "walls are infinite; corrected: patch on the face, and seen from there"});
    v("classes", classes, Field{.doc = "x walls and y walls; corrected: any direction within the gate"});
    // Corrected, walls of adjacent rooms count, too.
    v("roomless", roomless,
      Field{.doc = "particles outside all rooms match all walls; corrected: none is outside, doors belong to the last "
                   "room"});
    v("outline", outline, Field{.doc = "room by position and size along W's axes; corrected: its polygon"});
    v("yaw", yaw, Field{.doc = "without a prior: uniform; corrected: half of it parallel to walls"});
    v("resampling", resampling, Field{.doc = "multinomial, each time; corrected: systematic, at half the effective"});
    v("tempering", tempering, Field{.doc = "none; corrected: a tenth of the particles stays effective"});
    v("convergence", convergence,
      Field{.doc = "best particle against the mean of all; corrected: one cluster, for a while"});
    v("state", state, Field{.doc = "z, roll, pitch free; corrected: from floor and gravity"});
    v("handover", handover, Field{.doc = "S-Graph matches all walls; corrected: visible ones, patch on the face"});
  }
};

}  // namespace plumbline::slam
