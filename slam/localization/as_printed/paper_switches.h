// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "bim/config/visit.h"

namespace plumbline::slam {

/// One thing that the plan-localization paper prints or leaves open: as it is printed, or put right.
enum class AsIn { printed, corrected };

}  // namespace plumbline::slam

namespace plumbline {
template <>
struct EnumNames<slam::AsIn> {
  static constexpr std::array<std::string_view, 2> names = {"printed", "corrected"};
};
}  // namespace plumbline

namespace plumbline::slam {

/// Each defect of [BIM-Loc] by itself [facts: localization 1.2]. Printed where that runs and is not ruled out by the
/// paper's own results; so corrected are the increment (printed, particles walk backwards), the weight (printed, it
/// grows without bound with negative residuals), the faces (printed, the second face of a wall lies on the far side of
/// W's origin) and the state (printed, z, roll and pitch are drawn at random too, which no number of particles fills).
struct PaperSwitches {
  bool rooms = true;  ///< the topological factor; off: every particle is matched against all walls [table 6]
  AsIn increment = AsIn::corrected;
  AsIn weight = AsIn::corrected;
  AsIn planes = AsIn::printed;
  AsIn faces = AsIn::corrected;
  AsIn form = AsIn::printed;
  AsIn frame = AsIn::printed;
  AsIn wrap = AsIn::printed;
  AsIn extent = AsIn::printed;
  AsIn classes = AsIn::printed;
  AsIn roomless = AsIn::printed;
  AsIn outline = AsIn::printed;
  AsIn yaw = AsIn::printed;
  AsIn resampling = AsIn::printed;
  AsIn tempering = AsIn::printed;
  AsIn convergence = AsIn::printed;
  AsIn state = AsIn::corrected;
  AsIn handover = AsIn::printed;

  template <class V>
  void visit(V& v) {
    v("rooms", rooms, Field{.doc = "topological factor: match only against walls of the room a particle is in"});
    v("increment", increment, Field{.doc = "eq. 5: x_t^-1 x_t-1; corrected: the other way round"});
    v("weight", weight, Field{.doc = "eq. 8-9: signed, variance multiplies; corrected: squared, divided by it"});
    v("planes", planes, Field{.doc = "dropped observations cost nothing; corrected: every plane counts, as a mixture"});
    v("faces", faces, Field{.doc = "eq. 2: second face (-n, d + T); corrected: where it is"});
    v("form", form, Field{.doc = "eq. 3: closest point, which has no side; corrected: normal towards the sensor"});
    v("frame", frame, Field{.doc = "eq. 7 compares in W; corrected: in the sensor's frame"});
    v("wrap", wrap, Field{.doc = "differences of angles are not wrapped; corrected: they are"});
    v("extent", extent, Field{.doc = "walls are infinite; corrected: patch on the face, and seen from there"});
    v("classes", classes, Field{.doc = "x walls and y walls; corrected: any direction within the gate"});
    v("roomless", roomless,
      Field{.doc = "a particle in no room is matched against all walls; corrected: none lives outside, the last room "
                   "holds in doors, and walls of rooms next door count"});
    v("outline", outline, Field{.doc = "room by position and size along W's axes; corrected: its polygon"});
    v("yaw", yaw, Field{.doc = "untold: uniform; corrected: half of it parallel to walls"});
    v("resampling", resampling, Field{.doc = "multinomial, each time; corrected: systematic, at half the effective"});
    v("tempering", tempering, Field{.doc = "none; corrected: a tenth of the particles stays effective"});
    v("convergence", convergence,
      Field{.doc = "best particle against the mean of all; corrected: one cluster, for a while"});
    v("state", state, Field{.doc = "z, roll, pitch free; corrected: from floor and gravity"});
    v("handover", handover, Field{.doc = "S-Graph matches all walls; corrected: visible ones, patch on the face"});
  }
};

}  // namespace plumbline::slam
