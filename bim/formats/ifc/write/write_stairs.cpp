// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "bim/formats/ifc/step/step_string.h"
#include "bim/formats/ifc/write/write_elements.h"

namespace plumbline::bim {

using step::none;
using step::ref;

void ElementWriter::add_stairs() {
  for (const Stair& stair : building_.stairs) {
    // One body a flight and landing belongs to these; anything else is the stair's own.
    const std::size_t parts = stair.flights.size() + stair.landings.size();
    const bool own = stair.bodies.size() != parts;
    const int shape = ShapeWriter(document_, "stair").body(own ? stair.bodies : std::vector<Solid>{}).finish();
    const int number = document_.add_product("IFCSTAIR", {"stair", stair.id, stair.name, stair.from}, shape,
                                             {step_string(stair.id), ".NOTDEFINED."});
    document_.contain(number, stair.from);
    document_.assign_material(number, stair.material);
    document_.add_properties(
        number, "Plumbline_Stair",
        {text_property("Id", stair.id), storey_property("From", stair.from), storey_property("To", stair.to),
         room_property("RoomFoot", stair.rooms[0]), room_property("RoomHead", stair.rooms[1])});
    std::vector<int> numbers;
    int count = 0;
    const auto body = [&] { return own ? std::vector<Solid>{} : std::vector<Solid>{stair.bodies[numbers.size()]}; };
    for (const StairFlight& flight : stair.flights) numbers.push_back(add_flight(stair, flight, ++count, body()));
    for (const Landing& landing : stair.landings) numbers.push_back(add_landing(stair, landing, ++count, body()));
    if (!numbers.empty()) document_.relate("IFCRELAGGREGATES", {ref(number), step::refs(numbers)});
  }
}

int ElementWriter::add_flight(const Stair& stair, const StairFlight& flight, int count,
                              const std::vector<Solid>& bodies) {
  const Eigen::Vector2d way(std::cos(flight.yaw), std::sin(flight.yaw));
  const int shape = ShapeWriter(document_, "stair")
                        .axis(flight.start, flight.start + flight.steps * flight.run_m * way)
                        .body(bodies)
                        .finish();
  const std::string name = stair.id + "/part" + std::to_string(count);
  const int number = document_.add_product("IFCSTAIRFLIGHT", {"flight", name, name, stair.from}, shape,
                                           {none, step::integer(flight.steps), step::integer(flight.steps),
                                            step_real(flight.rise_m), step_real(flight.run_m), ".STRAIGHT."});
  document_.add_properties(number, "Plumbline_StairFlight",
                           {{"Yaw", step::typed("IFCPLANEANGLEMEASURE", step_real(flight.yaw))},
                            length_property("Width", flight.width_m),
                            length_property("Bottom", flight.z0_m)});
  return number;
}

int ElementWriter::add_landing(const Stair& stair, const Landing& landing, int count,
                               const std::vector<Solid>& bodies) {
  const int shape = ShapeWriter(document_, "stair").footprint({landing.polygon, {}}).body(bodies).finish();
  const std::string name = stair.id + "/part" + std::to_string(count);
  const int number = document_.add_product("IFCSLAB", {"landing", name, name, stair.from}, shape, {none, ".LANDING."});
  document_.add_properties(number, "Plumbline_Landing", {length_property("Level", landing.z_m)});
  return number;
}

}  // namespace plumbline::bim
