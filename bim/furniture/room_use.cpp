// SPDX-License-Identifier: Apache-2.0
#include "bim/furniture/room_use.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "bim/errors.h"

namespace plumbline::bim {

namespace {

struct Keyword {
  std::string_view word;
  RoomUse use;
};

/// The first that fits decides. UTF-8, lower case.
constexpr std::array<Keyword, 73> keywords = {{
    {"bedroom", RoomUse::bedroom},
    {"schlaf", RoomUse::bedroom},
    {"kinderzimmer", RoomUse::bedroom},
    {"gästezimmer", RoomUse::bedroom},
    {"bed", RoomUse::bedroom},
    {"kitchen", RoomUse::kitchen},
    {"küche", RoomUse::kitchen},
    {"kueche", RoomUse::kitchen},
    {"kochen", RoomUse::kitchen},
    {"pantry", RoomUse::kitchen},
    {"bath", RoomUse::bath},
    {"bathroom", RoomUse::bath},
    {"toilet", RoomUse::bath},
    {"shower", RoomUse::bath},
    {"wc", RoomUse::bath},
    {"restroom", RoomUse::bath},
    {"bad", RoomUse::bath},
    {"badezimmer", RoomUse::bath},
    {"dusche", RoomUse::bath},
    {"toilette", RoomUse::bath},
    {"living", RoomUse::living},
    {"lounge", RoomUse::living},
    {"dining", RoomUse::living},
    {"wohn", RoomUse::living},
    {"wohnen", RoomUse::living},
    {"wohnzimmer", RoomUse::living},
    {"esszimmer", RoomUse::living},
    {"classroom", RoomUse::classroom},
    {"lecture", RoomUse::classroom},
    {"seminar", RoomUse::classroom},
    {"klassenzimmer", RoomUse::classroom},
    {"klasse", RoomUse::classroom},
    {"klassenraum", RoomUse::classroom},
    {"hörsaal", RoomUse::classroom},
    {"unterricht", RoomUse::classroom},
    {"meeting", RoomUse::meeting},
    {"conference", RoomUse::meeting},
    {"besprechung", RoomUse::meeting},
    {"konferenz", RoomUse::meeting},
    {"office", RoomUse::office},
    {"study", RoomUse::office},
    {"büro", RoomUse::office},
    {"buero", RoomUse::office},
    {"arbeitszimmer", RoomUse::office},
    {"workshop", RoomUse::workshop},
    {"laboratory", RoomUse::workshop},
    {"lab", RoomUse::workshop},
    {"labor", RoomUse::workshop},
    {"werkstatt", RoomUse::workshop},
    {"produktion", RoomUse::workshop},
    {"garage", RoomUse::workshop},
    {"storage", RoomUse::store},
    {"storeroom", RoomUse::store},
    {"store", RoomUse::store},
    {"warehouse", RoomUse::store},
    {"archive", RoomUse::store},
    {"lager", RoomUse::store},
    {"abstell", RoomUse::store},
    {"abstellraum", RoomUse::store},
    {"archiv", RoomUse::store},
    {"keller", RoomUse::store},
    {"corridor", RoomUse::corridor},
    {"hallway", RoomUse::corridor},
    {"passage", RoomUse::corridor},
    {"flur", RoomUse::corridor},
    {"gang", RoomUse::corridor},
    {"diele", RoomUse::corridor},
    {"korridor", RoomUse::corridor},
    {"entrance", RoomUse::corridor},
    {"lobby", RoomUse::hall},
    {"foyer", RoomUse::hall},
    {"hall", RoomUse::hall},
    {"halle", RoomUse::hall},
}};

constexpr double narrow_m = 2.7;  ///< a hall no wider than this is a corridor

/// ASCII and the capital letters of Latin-1, in UTF-8.
std::string lower_case(std::string text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c >= 'A' && c <= 'Z') text[i] = static_cast<char>(c + 0x20);
    const bool latin = i > 0 && static_cast<unsigned char>(text[i - 1]) == 0xC3;
    if (latin && c >= 0x80 && c <= 0x9E) text[i] = static_cast<char>(c + 0x20);
  }
  return text;
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char c : lower_case(text)) {
    const bool letter = (c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80;
    if (letter) words.back() += c;
    if (!letter && !words.back().empty()) words.emplace_back();
  }
  return words;
}

bool names(const std::string& word, std::string_view keyword) {
  constexpr std::size_t short_word = 3;  // would stand in many others
  if (word == keyword) return true;
  if (keyword.size() <= short_word || word.starts_with("storey")) return false;
  return word.starts_with(keyword) || word.ends_with(keyword);
}

/// Length of the outline's box along its longer and shorter side.
Eigen::Vector2d extent_of(const Room& room) {
  Eigen::Vector2d low = room.polygon.front(), high = low;
  for (const Eigen::Vector2d& p : room.polygon) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector2d size = high - low;
  return {size.maxCoeff(), size.minCoeff()};
}

RoomUse use_by_size(double area_m2, const Eigen::Vector2d& extent) {
  constexpr double elongated = 3.0, store_m2 = 6.0, office_m2 = 22.0, meeting_m2 = 45.0, classroom_m2 = 100.0;
  if (extent.y() <= narrow_m && extent.x() >= elongated * extent.y()) return RoomUse::corridor;
  if (area_m2 < store_m2) return RoomUse::store;
  if (area_m2 < office_m2) return RoomUse::office;
  if (area_m2 < meeting_m2) return RoomUse::meeting;
  return area_m2 < classroom_m2 ? RoomUse::classroom : RoomUse::hall;
}

using enum FurnitureShape;
using enum Spot;

constexpr int any = 1 << 20;

constexpr FurnitureItem chair_beside{chair, {0.42, 0.42, 0.85}, {0.5, 0.5, 0.95}, beside, any};
constexpr FurnitureItem low_shelf{shelf, {0.6, 0.3, 0.9}, {1.2, 0.4, 1.3}, wall, any};
constexpr FurnitureItem tall_shelf{shelf, {0.8, 0.3, 1.7}, {1.2, 0.45, 2.1}, wall, any};
constexpr FurnitureItem small_table{table, {0.7, 0.6, 0.72}, {1.2, 0.8, 0.76}, beside, any};

}  // namespace

RoomUse use_of(const Room& room) {
  if (room.polygon.size() < 3) return RoomUse::corridor;
  const Eigen::Vector2d extent = extent_of(room);
  std::vector<std::string> words = words_of(room.name);
  for (std::string& word : words_of(room.id)) words.push_back(std::move(word));
  for (const auto& [keyword, use] : keywords)
    for (const std::string& word : words)
      if (names(word, keyword)) return use == RoomUse::hall && extent.y() <= narrow_m ? RoomUse::corridor : use;
  return use_by_size(signed_area(room.polygon), extent);
}

std::span<const FurnitureItem> items_of(RoomUse use) {
  static constexpr FurnitureItem bedroom[] = {{bed, {0.9, 2.0, 0.8}, {1.8, 2.1, 1.0}, wall, 1},
                                              {wardrobe, {1.0, 0.6, 2.0}, {2.0, 0.65, 2.2}, wall, 1},
                                              {desk, {1.0, 0.6, 0.73}, {1.4, 0.7, 0.76}, wall, 1, 1},
                                              tall_shelf,
                                              {wardrobe, {0.8, 0.5, 1.8}, {1.2, 0.6, 2.2}, wall, 2},
                                              low_shelf,
                                              small_table,
                                              chair_beside};
  static constexpr FurnitureItem living[] = {{sofa, {1.6, 0.85, 0.75}, {2.4, 0.95, 0.9}, wall, 2},
                                             {table, {0.9, 0.5, 0.42}, {1.2, 0.7, 0.5}, middle, 1},
                                             tall_shelf,
                                             {table, {1.4, 0.8, 0.73}, {2.0, 1.0, 0.77}, middle, 1, 6},
                                             {wardrobe, {1.0, 0.4, 0.8}, {1.8, 0.5, 1.2}, wall, 2},
                                             low_shelf,
                                             small_table,
                                             chair_beside};
  static constexpr FurnitureItem kitchen_items[] = {{kitchen, {1.8, 0.6, 2.05}, {3.6, 0.65, 2.15}, wall, 2},
                                                    {table, {1.0, 0.7, 0.73}, {1.6, 0.9, 0.77}, middle, 1, 4},
                                                    {wardrobe, {0.6, 0.6, 1.8}, {0.7, 0.65, 2.1}, wall, 2},
                                                    low_shelf,
                                                    small_table,
                                                    chair_beside};
  static constexpr FurnitureItem bath[] = {{wardrobe, {0.5, 0.35, 0.8}, {0.9, 0.5, 1.9}, wall, 3},
                                           {shelf, {0.4, 0.3, 0.9}, {0.8, 0.35, 1.8}, wall, any}};
  static constexpr FurnitureItem office[] = {{desk, {1.4, 0.7, 0.72}, {1.8, 0.8, 0.76}, wall, any, 1},
                                             tall_shelf,
                                             {table, {1.2, 0.8, 0.73}, {1.8, 0.9, 0.76}, middle, 1, 4},
                                             {wardrobe, {0.8, 0.42, 1.6}, {1.2, 0.5, 2.0}, wall, any},
                                             low_shelf,
                                             small_table,
                                             chair_beside};
  static constexpr FurnitureItem meeting[] = {{table, {2.0, 1.0, 0.73}, {3.6, 1.4, 0.76}, middle, any, 12},
                                              {table, {1.2, 0.8, 0.73}, {1.8, 1.0, 0.76}, middle, any, 6},
                                              {wardrobe, {1.0, 0.42, 0.8}, {1.6, 0.5, 1.2}, wall, 3},
                                              tall_shelf,
                                              small_table,
                                              chair_beside};
  static constexpr FurnitureItem store[] = {{shelf, {1.0, 0.4, 1.8}, {2.0, 0.6, 2.2}, wall, any},
                                            {pallet, {1.2, 0.8, 0.6}, {1.2, 0.8, 1.6}, beside, any},
                                            {shelf, {1.0, 0.4, 1.8}, {2.0, 0.6, 2.2}, beside, any},
                                            low_shelf};
  static constexpr FurnitureItem workshop[] = {{machine, {1.6, 0.9, 1.5}, {3.2, 1.8, 2.2}, middle, any},
                                               {table, {1.6, 0.7, 0.85}, {2.2, 0.8, 0.95}, wall, any},
                                               {pallet, {1.2, 0.8, 0.5}, {1.2, 0.8, 1.4}, beside, any},
                                               tall_shelf,
                                               small_table};
  static constexpr FurnitureItem classroom[] = {{desk, {1.2, 0.55, 0.72}, {1.4, 0.65, 0.76}, middle, any, 2},
                                                tall_shelf,
                                                {wardrobe, {1.0, 0.42, 1.0}, {1.6, 0.5, 2.0}, wall, 4},
                                                small_table,
                                                chair_beside};
  static constexpr FurnitureItem hall[] = {{table, {1.6, 0.8, 0.73}, {2.4, 1.0, 0.76}, middle, any, 8},
                                           {sofa, {1.6, 0.85, 0.75}, {2.2, 0.95, 0.9}, wall, 4},
                                           tall_shelf,
                                           {pallet, {1.2, 0.8, 0.5}, {1.2, 0.8, 1.4}, beside, any},
                                           {shelf, {1.2, 0.4, 1.8}, {2.0, 0.6, 2.2}, beside, any},
                                           small_table,
                                           chair_beside};
  static constexpr FurnitureItem corridor[] = {{shelf, {0.8, 0.3, 0.8}, {1.4, 0.4, 1.9}, wall, any},
                                               {wardrobe, {0.8, 0.35, 1.0}, {1.2, 0.45, 2.0}, wall, any},
                                               {chair, {0.42, 0.42, 0.85}, {0.5, 0.5, 0.95}, wall, any},
                                               {shelf, {0.4, 0.22, 0.8}, {0.8, 0.28, 1.2}, wall, any}};
  switch (use) {
    case RoomUse::bedroom:
      return bedroom;
    case RoomUse::living:
      return living;
    case RoomUse::kitchen:
      return kitchen_items;
    case RoomUse::bath:
      return bath;
    case RoomUse::office:
      return office;
    case RoomUse::meeting:
      return meeting;
    case RoomUse::store:
      return store;
    case RoomUse::workshop:
      return workshop;
    case RoomUse::classroom:
      return classroom;
    case RoomUse::hall:
      return hall;
    case RoomUse::corridor:
      return corridor;
  }
  throw InternalError("unknown use of a room");
}

}  // namespace plumbline::bim
