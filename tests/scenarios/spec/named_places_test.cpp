// SPDX-License-Identifier: Apache-2.0
#include "scenarios/spec/named_places.h"

#include <gtest/gtest.h>

#include "tests/input_error.h"

namespace plumbline::scenarios {
namespace {

/// Storeys a and b of one name, each with a room of one name; a third room is called as another's id.
bim::Building twins() {
  bim::Building building;
  for (const char* id : {"a", "b"}) {
    bim::Storey& storey = building.storeys.emplace_back();
    storey.id = id;
    storey.name = "floor";
    bim::Room& room = building.rooms.emplace_back();
    room.id = std::string(id) + "/room1";
    room.name = "room 1";
    room.storey = static_cast<int>(building.storeys.size()) - 1;
  }
  bim::Room& last = building.rooms.emplace_back();
  last.id = "c";
  last.name = "b/room1";
  last.storey = 1;
  std::swap(building.rooms[1], building.rooms[2]);
  return building;
}

TEST(NamedPlaces, AnIdGoesBeforeANameOfAnother) {
  const bim::Building building = twins();
  EXPECT_EQ(building.rooms.at(static_cast<std::size_t>(find_room(building, "b/room1", {}))).id, "b/room1");
  EXPECT_EQ(find_storey(building, "b", {}), 1);
}

TEST(NamedPlaces, ANameOfSeveralIsRefusedWithTheirIds) {
  const bim::Building building = twins();
  EXPECT_EQ(input_error([&] {
              (void)find_room(building, "room 1", {"s.yaml", 3, 5});
            }),
            "s.yaml:3:5: 'room 1' is the name of several rooms; name one of them by its id: a/room1 b/room1");
  EXPECT_EQ(input_error([&] {
              (void)find_storey(building, "floor", {"s.yaml", 3, 5});
            }),
            "s.yaml:3:5: 'floor' is the name of several storeys; name one of them by its id: a b");
}

TEST(NamedPlaces, AnUnknownRoomIsAnsweredWithNames) {
  bim::Building building = twins();
  building.rooms[0].name = "Living";
  building.rooms[1].name = "Bath 2";
  building.rooms[2].name = "";
  EXPECT_NE(input_error([&] { (void)find_room(building, "Zzzzzzzzz", {}); }).find("has: Living 'Bath 2' b/room1"),
            std::string::npos);
}

TEST(NamedPlaces, OnOneStoreyANameNeedsToBeItsOwnThereAlone) {
  const bim::Building building = twins();
  EXPECT_EQ(building.rooms.at(static_cast<std::size_t>(find_room_on(building, 0, "room 1", {}))).id, "a/room1");
  EXPECT_EQ(building.rooms.at(static_cast<std::size_t>(find_room_on(building, 1, "room 1", {}))).id, "b/room1");
  EXPECT_EQ(input_error([&] {
              (void)find_room_on(building, 0, "b/room1", {"s.yaml", 3, 5});
            }),
            "s.yaml:3:5: no room 'b/room1' on the storey of the start; did you mean 'a/room1'?");
}

}  // namespace
}  // namespace plumbline::scenarios
