// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "bim/config/printable.h"
#include "bim/digest/digest.h"
#include "bim/model/adjacency.h"
#include "bim/plan/plan.h"
#include "scenarios/app/inspect/fixed_point.h"
#include "scenarios/app/inspect/inspect.h"
#include "scenarios/app/inspect/inspect_symmetry.h"

namespace plumbline::scenarios {
namespace {

using bim::Building;
using bim::BuildingMesh;

/// Characters of UTF-8 text.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

/// Rows of cells in columns as wide as their longest cell; the first column left, the others right, the last as it is.
class Table {
 public:
  explicit Table(std::vector<std::string> header) { rows_.push_back(std::move(header)); }
  void add(std::vector<std::string> row) {
    for (std::string& cell : row) cell = printable(cell);  // names come from the building's file
    rows_.push_back(std::move(row));
  }

  [[nodiscard]] std::string text() const {
    std::vector<std::size_t> widths(rows_.front().size(), 0);
    for (const auto& row : rows_)
      for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
    std::string text;
    for (const auto& row : rows_) {
      std::string line = " ";
      for (std::size_t i = 0; i < row.size(); ++i) {
        const std::string blanks(widths[i] - width(row[i]), ' ');
        const bool last = i + 1 == row.size();
        line += " " + (i == 0 || last ? row[i] + blanks : blanks + row[i]) + " ";
      }
      line.erase(line.find_last_not_of(' ') + 1);
      text += line + "\n";
    }
    return text;
  }

 private:
  std::vector<std::vector<std::string>> rows_;
};

template <class Elements>
int on_storey(const Elements& elements, int storey) {
  return static_cast<int>(
      std::count_if(elements.begin(), elements.end(), [&](const auto& e) { return e.storey == storey; }));
}

/// Each hole once, through however many walls it leads.
int openings_on(const Building& building, const std::vector<bool>& continued, int storey, bim::OpeningKind kind) {
  int count = 0;
  for (std::size_t i = 0; i < building.openings.size(); ++i) {
    const bim::Opening& opening = building.openings[i];
    if (!continued[i] && opening.kind == kind &&
        building.walls[static_cast<std::size_t>(opening.wall)].storey == storey)
      ++count;
  }
  return count;
}

std::string label(const std::string& name, const std::string& id) { return name.empty() ? id : name; }

std::string storey_table(const Building& building) {
  Table table({"storey", "floor m", "height m", "walls", "rooms", "doors", "windows", "voids", "slabs", "columns",
               "obstacles", "kind"});
  constexpr const char* kinds[] = {"habitable", "foundation", "roof"};
  const std::vector<bool> continued = bim::continued_openings(building);
  for (std::size_t i = 0; i < building.storeys.size(); ++i) {
    const bim::Storey& storey = building.storeys[i];
    const int s = static_cast<int>(i);
    const auto openings = [&](bim::OpeningKind kind) {
      return std::to_string(openings_on(building, continued, s, kind));
    };
    table.add({label(storey.name, storey.id), fixed_point(storey.elevation_m, 2), fixed_point(storey.height_m, 2),
               std::to_string(on_storey(building.walls, s)), std::to_string(on_storey(building.rooms, s)),
               openings(bim::OpeningKind::door), openings(bim::OpeningKind::window),
               openings(bim::OpeningKind::opening_void), std::to_string(on_storey(building.slabs, s)),
               std::to_string(on_storey(building.columns, s)), std::to_string(on_storey(building.obstacles, s)),
               kinds[static_cast<std::size_t>(storey.kind)]});
  }
  return table.text();
}

/// Each neighbour once, with every way there but windows: "Hall (door, open edge), outside (door)".
std::string leads_to(const Building& building, const std::vector<bim::Adjacent>& pairs, int room) {
  constexpr const char* ways[] = {"door", "window", "void", "open", "stair"};
  std::map<std::pair<bool, int>, std::string> neighbours;  // outside last
  for (const bim::Adjacent& pair : pairs) {
    if ((pair.a != room && pair.b != room) || pair.by == bim::Passage::window) continue;
    const int other = pair.a == room ? pair.b : pair.a;
    std::string& way = neighbours[{other < 0, other}];
    const std::string name = ways[static_cast<std::size_t>(pair.by)];
    if (way.find(name) == std::string::npos) way += (way.empty() ? "" : ", ") + name;
  }
  std::string text;
  for (const auto& [key, way] : neighbours) {
    const std::string name = key.first ? "outside"
                                       : label(building.rooms[static_cast<std::size_t>(key.second)].name,
                                               building.rooms[static_cast<std::size_t>(key.second)].id);
    text += (text.empty() ? "" : "; ") + name + " (" + way + ")";
  }
  return text;
}

std::string stair_table(const Building& building) {
  Table table({"stair", "from", "to", "steps", "rise m", "run m", "width m", "landings", "rooms"});
  const auto storey = [&](int i) {
    return i < 0 ? std::string("nowhere")
                 : label(building.storeys[static_cast<std::size_t>(i)].name,
                         building.storeys[static_cast<std::size_t>(i)].id);
  };
  const auto room = [&](int i) {
    return i < 0 ? std::string("outside")
                 : label(building.rooms[static_cast<std::size_t>(i)].name,
                         building.rooms[static_cast<std::size_t>(i)].id);
  };
  for (const bim::Stair& stair : building.stairs) {
    int steps = 0;
    for (const bim::StairFlight& flight : stair.flights) steps += flight.steps;
    const bim::StairFlight first = stair.flights.empty() ? bim::StairFlight{} : stair.flights.front();
    const auto length = [&](double v) { return stair.flights.empty() ? std::string("-") : fixed_point(v, 3); };
    table.add({label(stair.name, stair.id), storey(stair.from), storey(stair.to), std::to_string(steps),
               length(first.rise_m), length(first.run_m), length(first.width_m), std::to_string(stair.landings.size()),
               room(stair.rooms[0]) + " to " + room(stair.rooms[1])});
  }
  return table.text();
}

std::string room_table(const Building& building) {
  const bim::Plan plan = bim::make_plan(building, {});
  const std::vector<bim::Adjacent> pairs = bim::adjacency(building);
  Table table({"room", "storey", "area m2", "height m", "faces", "leads to"});
  for (std::size_t i = 0; i < building.rooms.size(); ++i) {
    const bim::Room& room = building.rooms[i];
    const std::string neighbours = leads_to(building, pairs, static_cast<int>(i));
    const bim::Storey& storey = building.storeys[static_cast<std::size_t>(room.storey)];
    table.add({label(room.name, room.id), label(storey.name, storey.id), fixed_point(room.area_m2(), 1),
               fixed_point(room.z1_m - room.z0_m, 2), std::to_string(plan.rooms[i].faces.size()), neighbours});
  }
  return table.text();
}

/// Obstacles by what they are: railings, furniture, clutter.
std::string kind_of(const Building& building, const bim::MeshElement& element) {
  constexpr const char* kinds[] = {"wall", "slab", "column", "stair"};
  return element.kind == bim::ElementKind::obstacle ? building.obstacles[static_cast<std::size_t>(element.index)].kind
                                                    : kinds[static_cast<std::size_t>(element.kind)];
}

std::string solid_table(const Building& building, const BuildingMesh& mesh) {
  struct Kind {
    int count = 0, closed = 0;
    double volume_m3 = 0.0;
  };
  std::map<std::string, Kind> kinds;
  for (const bim::MeshElement& element : mesh.elements) {
    Kind& kind = kinds[kind_of(building, element)];
    ++kind.count;
    kind.closed += element.closed ? 1 : 0;
    kind.volume_m3 += element.volume_m3;
  }
  Table table({"solid", "number", "closed", "volume m3"});
  for (const auto& [name, kind] : kinds)
    table.add({name, std::to_string(kind.count), std::to_string(kind.closed), fixed_point(kind.volume_m3, 2)});
  return table.text();
}

std::string change_table(const std::vector<bim::Change>& changes) {
  Table table({"not as planned", "element"});
  for (const bim::Change& change : changes) table.add({change.op, change.element});
  return table.text();
}

std::string warning_lines(const Building& building, const BuildingMesh& mesh) {
  std::map<std::string, std::vector<const bim::Warning*>> kinds;
  for (const bim::Warning& warning : building.warnings) kinds[warning.kind].push_back(&warning);
  for (const bim::Warning& warning : mesh.warnings) kinds[warning.kind].push_back(&warning);
  Table table({"warning", "times", "such as"});
  for (const auto& [kind, warnings] : kinds) {
    const bim::Warning& first = *warnings.front();
    table.add(
        {kind, std::to_string(warnings.size()), (first.element.empty() ? "" : first.element + ": ") + first.text});
  }
  return kinds.empty() ? "  no warnings\n" : table.text();
}

std::string totals(const Building& building, const BuildingMesh& mesh) {
  double area = 0.0, volume = 0.0;
  for (const bim::Room& room : building.rooms) area += room.area_m2();
  std::size_t closed = 0;
  for (const bim::MeshElement& element : mesh.elements) {
    if (element.closed) ++closed;
    if (element.kind == bim::ElementKind::wall) volume += element.volume_m3;
  }
  return "  " + std::to_string(building.walls.size()) + " walls of " + fixed_point(volume, 1) + " m3, " +
         std::to_string(building.openings.size()) + " openings, " + std::to_string(building.rooms.size()) +
         " rooms of " + fixed_point(area, 1) + " m2; " + std::to_string(mesh.elements.size()) + " solids (" +
         std::to_string(closed) + " closed) of " + std::to_string(mesh.triangles.size()) + " triangles\n";
}

}  // namespace

std::string inspect_text(const Building& building, const BuildingMesh& mesh, const std::vector<bim::Change>& changes) {
  std::string text = printable(building.name.empty() ? "building" : building.name) + " (" +
                     printable(building.schema + ", unit " + building.unit) + "), hash " + hex64(building.hash()) +
                     "\n\n";
  text += storey_table(building) + "\n";
  if (!building.rooms.empty()) text += room_table(building) + "\n";
  if (!building.stairs.empty()) text += stair_table(building) + "\n";
  if (!mesh.elements.empty()) text += solid_table(building, mesh) + "\n";
  if (!changes.empty()) text += change_table(changes) + "\n";
  text += symmetry_text(building, bim::analyse_symmetry(building)) + "\n";
  return text + totals(building, mesh) + "\n" + warning_lines(building, mesh);
}

}  // namespace plumbline::scenarios
