// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_repair.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "bim/formats/ifc/step/step_entities.h"
#include "bim/formats/ifc/step/step_parse.h"

namespace plumbline::bim {
namespace {

/// Top-level attributes of "(...)", from the opening bracket to its closing one; `end` is behind that.
struct Attributes {
  std::vector<std::string_view> items;
  std::size_t end = 0;
};

Attributes split(std::string_view text) {
  Attributes result;
  int depth = 0;
  std::size_t begin = 1;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '\'') {
      at = std::min(text.find('\'', at + 1), text.size() - 1);
    } else if (c == '(') {
      ++depth;
    } else if (c == ',' && depth == 1) {
      result.items.push_back(text.substr(begin, at - begin));
      begin = at + 1;
    } else if (c == ')' && --depth == 0) {
      result.items.push_back(text.substr(begin, at - begin));
      result.end = at + 1;
      break;
    }
  }
  return result;
}

std::string line_breaks(std::string_view text) {
  return std::string(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')), '\n');
}

/// Attributes with their brackets, up to the closing one, without references to missing entities.
std::string kept(std::string_view attributes, const std::set<std::int64_t>& missing) {
  std::string result;
  int depth = 0;
  for (std::size_t at = 0; at < attributes.size(); ++at) {
    const char c = attributes[at];
    if (c == '\'') {
      const std::size_t end = std::min(attributes.find('\'', at + 1), attributes.size() - 1);
      result += attributes.substr(at, end + 1 - at);
      at = end;
      continue;
    }
    if (c == '(') ++depth;
    if (c == ')') --depth;
    if (c != '#') {
      result += c;
      if (depth == 0) break;
      continue;
    }
    std::int64_t number = 0;
    const auto [end, error] =
        std::from_chars(attributes.data() + at + 1, attributes.data() + attributes.size(), number);
    const auto length = static_cast<std::size_t>(end - attributes.data()) - at;
    if (error != std::errc() || !missing.contains(number)) {
      result += attributes.substr(at, length);
    } else if (depth == 1) {
      result += '$';
    } else {
      // With the comma before it, or else the one behind.
      std::size_t next = at + length;
      while (next < attributes.size() && attributes[next] == ' ') ++next;
      const std::size_t last = result.find_last_not_of(" \n\r\t");
      if (last != std::string::npos && result[last] == ',')
        result.erase(last, 1);
      else if (next < attributes.size() && attributes[next] == ',')
        at = next - length;
    }
    at += length - 1;
  }
  return result;
}

/// Replaces ranges of a text, given by their beginnings.
class Edits {
 public:
  explicit Edits(const std::string& text) : text_(text) {}

  void replace(const char* begin, std::size_t length, std::string by) {
    edits_[static_cast<std::size_t>(begin - text_.data())] = {length, std::move(by)};
  }
  [[nodiscard]] std::string done() const {
    std::string result;
    std::size_t at = 0;
    for (const auto& [begin, edit] : edits_) {
      result.append(text_, at, begin - at).append(edit.second);
      at = begin + edit.first;
    }
    return result.append(text_, at, std::string::npos);
  }

 private:
  const std::string& text_;
  std::map<std::size_t, std::pair<std::size_t, std::string>> edits_;
};

struct NewClass {
  std::string_view type;
  std::string_view known;
  std::size_t shared = 0;      ///< attributes that both have, from the first
  std::size_t attributes = 0;  ///< of the known class
};

constexpr std::string_view proxy = "IFCBUILDINGELEMENTPROXY", building = "IFCBUILDING", storey = "IFCBUILDINGSTOREY";

/// Classes of IFC4X3 [iso2024] that IFC4 does not have and that may hold or be a part of a building.
constexpr std::array<NewClass, 33> new_classes{{
    {"IFCBEARING", proxy, 8, 9},
    {"IFCBRIDGE", building, 9, 12},
    {"IFCBRIDGEPART", building, 9, 12},
    {"IFCBUILTELEMENT", proxy, 8, 9},
    {"IFCCAISSONFOUNDATION", proxy, 8, 9},
    {"IFCCONVEYORSEGMENT", proxy, 8, 9},
    {"IFCCOURSE", proxy, 8, 9},
    {"IFCDEEPFOUNDATION", proxy, 8, 9},
    {"IFCELECTRICFLOWTREATMENTDEVICE", proxy, 8, 9},
    {"IFCFACILITY", building, 9, 12},
    {"IFCFACILITYPART", building, 9, 12},
    {"IFCFACILITYPARTCOMMON", building, 9, 12},
    {"IFCIMPACTPROTECTIONDEVICE", proxy, 8, 9},
    {"IFCKERB", proxy, 8, 9},
    {"IFCLIQUIDTERMINAL", proxy, 8, 9},
    {"IFCMARINEFACILITY", building, 9, 12},
    {"IFCMARINEPART", building, 9, 12},
    {"IFCMOBILETELECOMMUNICATIONSAPPLIANCE", proxy, 8, 9},
    {"IFCMOORINGDEVICE", proxy, 8, 9},
    {"IFCNAVIGATIONELEMENT", proxy, 8, 9},
    {"IFCPAVEMENT", proxy, 8, 9},
    {"IFCRAIL", proxy, 8, 9},
    {"IFCRAILWAY", building, 9, 12},
    {"IFCRAILWAYPART", building, 9, 12},
    {"IFCREINFORCEDSOIL", proxy, 8, 9},
    {"IFCROAD", building, 9, 12},
    {"IFCROADPART", building, 9, 12},
    {"IFCSIGN", proxy, 8, 9},
    {"IFCSIGNAL", proxy, 8, 9},
    {"IFCTRACKELEMENT", proxy, 8, 9},
    {"IFCTRANSPORTATIONDEVICE", proxy, 8, 9},
    {"IFCVEHICLE", proxy, 8, 9},
    {"IFCDISTRIBUTIONBOARD", proxy, 8, 9},
}};

/// What a tessellation of IFC4X3 is in IFC4, which has no tags of points and the normals before the flag; empty where
/// it is the same.
std::string known_tessellation(std::string_view type, const std::vector<std::string_view>& items) {
  if (type.starts_with("IFCCARTESIANPOINTLIST") && items.size() > 1)
    return std::string(type) + "(" + std::string(items[0]) + ")";
  if (type != "IFCTRIANGULATEDFACESET" || items.size() < 4) return {};
  const auto begins = [&](std::size_t i, char c) {
    const std::size_t first = items[i].find_first_not_of(" \n\r\t");
    return first != std::string_view::npos && items[i][first] == c;
  };
  if (!begins(1, '.') && !begins(2, '(')) return {};
  std::string known = std::string(type) + "(";
  for (const std::size_t i : {std::size_t{0}, std::size_t{2}, std::size_t{1}}) known += std::string(items[i]) + ",";
  for (std::size_t i = 3; i < items.size(); ++i) known += std::string(items[i]) + (i + 1 < items.size() ? "," : ")");
  return known;
}

/// Whether a part of a facility divides it upwards, as storeys do. A plain one may leave open how it divides it.
bool is_level(std::string_view type, const std::vector<std::string_view>& items) {
  if (!type.ends_with("PART") && !type.ends_with("PARTCOMMON")) return false;
  const auto says = [&](std::string_view how) {
    return std::any_of(items.begin(), items.end(),
                       [&](std::string_view item) { return item.find(how) != std::string_view::npos; });
  };
  if (says(".VERTICAL.")) return true;
  return type.starts_with("IFCFACILITYPART") && !says(".LATERAL.") && !says(".LONGITUDINAL.") && !says(".REGION.");
}

/// What an entity of IFC4X3 is in IFC4; empty where it is the same. `levels`: parts of facilities are storeys.
std::string known_entity(std::string_view type, const std::vector<std::string_view>& items, bool levels) {
  const auto found =
      std::find_if(new_classes.begin(), new_classes.end(), [&](const NewClass& row) { return row.type == type; });
  if (found == new_classes.end()) return known_tessellation(type, items);
  const NewClass row = levels && is_level(type, items) ? NewClass{type, storey, 9, 10} : *found;
  std::string known = std::string(row.known) + "(";
  for (std::size_t i = 0; i < row.attributes; ++i) {
    if (i > 0) known += ',';
    known += i < row.shared && i < items.size() ? std::string(items[i]) : "$";
  }
  return known + ")";
}

bool may_differ(std::string_view type) {
  return type.starts_with("IFCCARTESIANPOINTLIST") || type == "IFCTRIANGULATEDFACESET" ||
         std::any_of(new_classes.begin(), new_classes.end(), [&](const NewClass& row) { return row.type == type; });
}

}  // namespace

std::string without_dangling(const std::string& text, const StepText& checked, const std::string& file) {
  if (checked.dangling.empty()) return text;
  std::map<std::int64_t, std::set<std::int64_t>> missing;
  for (const auto& [number, target] : checked.dangling) missing[number].insert(target);
  const StepEntities entities(text, file);
  Edits edits(text);
  for (const auto& [number, targets] : missing) {
    const std::string_view attributes = entities.entity(number).attributes;
    const std::size_t length = split(attributes).end;
    edits.replace(attributes.data(), length, kept(attributes, targets));
  }
  return edits.done();
}

std::string with_known_classes(const std::string& text, const StepText& checked, const std::string& file) {
  if (!checked.schema.starts_with("IFC4X")) return text;
  const StepEntities entities(text, file);
  Edits edits(text);
  const bool levels = std::none_of(entities.all().begin(), entities.all().end(),
                                   [](const StepEntities::Entity& entity) { return entity.type == storey; });
  for (const StepEntities::Entity& entity : entities.all()) {
    if (!may_differ(entity.type)) continue;
    const Attributes attributes = split(entity.attributes);
    const std::string known = known_entity(entity.type, attributes.items, levels);
    if (known.empty()) continue;
    const char* begin = entity.type.data();
    const auto length = static_cast<std::size_t>(entity.attributes.data() + attributes.end - begin);
    const std::string breaks = line_breaks({begin, length});
    edits.replace(begin, length, known + breaks.substr(std::min(breaks.size(), line_breaks(known).size())));
  }
  return edits.done();
}

std::string schema_of_entities(const std::string& text, const StepText& checked, const std::string& file) {
  constexpr std::size_t old_count = 8, new_count = 9;
  std::size_t old_walls = 0, new_walls = 0;
  const StepEntities entities(text, file);
  for (const StepEntities::Entity& entity : entities.all()) {
    if (entity.type != "IFCWALL" && entity.type != "IFCWALLSTANDARDCASE" && entity.type != "IFCOPENINGELEMENT")
      continue;
    const std::size_t count = split(entity.attributes).items.size();
    old_walls += count == old_count ? 1 : 0;
    new_walls += count == new_count ? 1 : 0;
  }
  const bool read_as_old = schema_for_reader(checked.schema) == "IFC2X3";
  if (old_walls > 0 && new_walls == 0 && !read_as_old) return "IFC2X3";
  if (new_walls > 0 && old_walls == 0 && read_as_old) return "IFC4";
  return checked.schema;
}

}  // namespace plumbline::bim
