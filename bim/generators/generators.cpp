// SPDX-License-Identifier: Apache-2.0
#include "bim/generators/generators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <type_traits>

#include "bim/config/schema.h"
#include "bim/errors.h"
#include "bim/formats/plan_yaml/plan_write.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/generators/build.h"
#include "bim/generators/feature.h"
#include "bim/generators/visibility.h"
#include "bim/random/stream.h"

namespace plumbline::bim {

namespace {

constexpr double epsilon_min_m = 0.02;  ///< smaller than this a beam sees no feature
constexpr double slab_m = 0.2;          ///< between a ceiling and the floor above it [PlanSolids]

constexpr std::array<GeneratorRow, 10> rows = {{
    {"corridor", "equal rooms along a corridor, on one side or both (half turn)"},
    {"rot180", "two flats, one the other turned by 180 degrees"},
    {"rot90", "rooms around a square core, four times the same by quarter turns"},
    {"mirrored", "two flats, one the mirror image of the other: no proper symmetry"},
    {"storeys", "the same flat on every storey"},
    {"grid", "rows and columns of equal rooms, a door between neighbours"},
    {"ring", "a corridor around a closed core, equal rooms on all four sides"},
    {"hall", "a hall with rows of pillars between two equal rooms"},
    {"shapes", "two rooms of L shape, trapezoids or with a cut corner, half a turn apart"},
    {"long", "a long corridor without features between two equal rooms"},
}};

/// Lists key, default and what may stand there.
class OptionLister {
 public:
  template <class T>
  void operator()(std::string_view key, const T& value, const Field& field = {}) {
    const SchemaField schema = schema_field(std::string(key), "", field);
    OptionRow row{schema.key, "", schema.meaning, "", ""};
    if (!schema.unit.empty() && schema.unit != "-") row.doc += ", " + schema.unit;
    if constexpr (std::is_enum_v<T>) {
      row.value = EnumNames<T>::names[static_cast<std::size_t>(value)];
      for (const std::string_view name : EnumNames<T>::names)
        row.choices += (row.choices.empty() ? "" : " | ") + std::string(name);
    } else if constexpr (std::is_same_v<T, bool>) {
      row.value = value ? "true" : "false";
      row.choices = "true | false";
    } else if constexpr (std::is_arithmetic_v<T>) {
      row.value = format_number(static_cast<double>(value));
      row.type = std::is_integral_v<T> ? "integer" : "number";
    } else if constexpr (std::is_same_v<T, std::optional<std::uint64_t>>) {
      row.type = "integer";
    }
    rows.push_back(std::move(row));
  }
  std::vector<OptionRow> rows;
};

/// A generator: how the floor of a family is made from its options.
template <class Options>
struct Generator {
  using Build = FloorTemplate (*)(const Options&, const Mark&);
  Build build;
  Options defaults;
};

/// Calls `use` with the generator of this name.
template <class Use>
auto with_generator(std::string_view name, const Use& use) {
  UnitOptions tower;
  tower.storeys = 3;
  if (name == "corridor") return use(Generator<CorridorOptions>{corridor, {}});
  if (name == "rot180") return use(Generator<UnitOptions>{rot180, {}});
  if (name == "rot90") return use(Generator<Rot90Options>{rot90, {}});
  if (name == "mirrored") return use(Generator<UnitOptions>{mirrored, {}});
  if (name == "storeys") return use(Generator<UnitOptions>{storeys, tower});
  if (name == "grid") return use(Generator<GridOptions>{grid, {}});
  if (name == "ring") return use(Generator<RingOptions>{ring, {}});
  if (name == "hall") return use(Generator<HallOptions>{hall, {}});
  if (name == "shapes") return use(Generator<ShapeOptions>{shapes, {}});
  if (name == "long") return use(Generator<LongOptions>{long_corridor, {}});
  std::vector<std::string> known;
  std::string list;
  for (const GeneratorRow& row : rows) {
    known.emplace_back(row.name);
    list += " " + known.back();
  }
  const std::string guess = did_you_mean(name, known);
  throw InputError({}, "there is no family '" + std::string(name) +
                           (guess.empty() ? "'; there are:" + list : "'; did you mean '" + guess + "'?"));
}

template <class Options>
Options read_options(const Options& defaults, const Tree& tree) {
  const auto read = [&](Options options) {
    FieldReader::read(tree, "", {}, options);
    return options;
  };
  Options options = read(defaults);
  if (!options.seed) return options;
  Options drawn = defaults;
  sample_parameters(drawn, Stream(*options.seed, "bim.generate"));
  return read(drawn);
}

Mark mark_of(const Tree& options, std::string_view key) {
  const Tree* tree = options.find(key);
  return tree != nullptr ? tree->mark : options.mark;
}

void check_feature(const GeneratorOptions& options, const Tree& tree) {
  if (options.epsilon_m > 0.0 && options.epsilon_m < epsilon_min_m)
    throw InputError(mark_of(tree, "epsilon_m"), format_number(options.epsilon_m) +
                                                     " m is too small a feature; it must be 0 or at least " +
                                                     format_number(epsilon_min_m) + " m");
  if (options.epsilon_m > 0.0 && options.feature == FeatureKind::none)
    throw InputError(mark_of(tree, "epsilon_m"), "a size needs a feature; name one, for example door_shift");
  if (options.epsilon_m <= 0.0 && options.feature != FeatureKind::none && tree.find("epsilon_m") == nullptr)
    throw InputError(mark_of(tree, "feature"), "a feature needs a size, in m; add --epsilon, for example 0.3");
}

std::string storey_name(int i) { return i == 0 ? "ground" : "level_" + std::to_string(i); }

/// Rooms that a rotation of the group maps onto one another, and those that the template declares alike.
std::vector<std::vector<std::string>> rooms_alike(const FloorTemplate& floor) {
  std::vector<std::vector<std::string>> classes = floor.alike;
  std::erase_if(classes, [](const auto& like) { return like.size() < 2; });
  const auto listed = [&](const std::string& id) {
    return std::any_of(classes.begin(), classes.end(),
                       [&](const auto& like) { return std::find(like.begin(), like.end(), id) != like.end(); });
  };
  for (const TemplateRoom& room : floor.rooms) {
    if (listed(room.id)) continue;
    std::vector<std::string> like = {room.id};
    for (const TemplateRoom& other : floor.rooms) {
      const bool swapped = std::any_of(floor.group.begin(), floor.group.end(), [&](const TemplateRotation& turn) {
        const Isometry2 g = Isometry2::turn(turn.angle_deg * std::numbers::pi / 180.0, turn.about);
        return (g * centroid(room.outline) - centroid(other.outline)).norm() < same_m;
      });
      if (other.id != room.id && swapped) like.push_back(other.id);
    }
    if (like.size() > 1) classes.push_back(std::move(like));
  }
  return classes;
}

/// Writes floors above each other. The one with the feature, if any, stands in full; of the others the lowest does,
/// and the rest copy it.
class Tower {
 public:
  Tower(const FloorTemplate& floor, const GeneratorOptions& options, const FeaturedTemplate* featured,
        int featured_storey)
      : floor_(floor), options_(options), featured_(featured), featured_storey_(featured_storey) {}

  PlanFile build() {
    plan_.name = floor_.name;
    for (int i = 0; i < floor_.storeys; ++i) add_storey(i);
    add_symmetry();
    return std::move(plan_);
  }

  /// Id of a room of the template on a storey.
  [[nodiscard]] std::string room_id(const std::string& room, int storey) const {
    return prefixes_[static_cast<std::size_t>(storey)] + room;
  }

 private:
  void add_storey(int i) {
    PlanStoreyEntry entry;
    entry.id = storey_name(i);
    entry.elevation_m = i * (options_.height_m + slab_m);
    entry.elevation_m = std::round(entry.elevation_m * 1e6) / 1e6;
    const bool special = featured_ != nullptr && i == featured_storey_;
    if (special || plain_.empty()) {
      entry.height_m = options_.height_m;
      prefixes_.push_back(i == 0 ? "" : entry.id + "_");
      add_storey_entries(special ? featured_->floor : floor_, options_, entry.id, prefixes_.back(), plan_);
      if (!special) plain_ = entry.id;
      if (!special) plain_prefix_ = prefixes_.back();
    } else {
      entry.copy_of = plain_;
      prefixes_.push_back(entry.id + "/" + plain_prefix_);
    }
    plan_.storeys.push_back(std::move(entry));
  }

  void add_symmetry() {
    PlanSymmetryEntry symmetry;
    symmetry.exact = featured_ == nullptr;
    std::vector<std::string> storeys;
    for (const PlanStoreyEntry& storey : plan_.storeys) storeys.push_back(storey.id);
    for (const TemplateRotation& turn : floor_.group)
      symmetry.group.push_back({turn.angle_deg, turn.about, storeys, storeys});
    for (std::size_t i = 1; i < storeys.size(); ++i)
      symmetry.group.push_back({0.0, Eigen::Vector2d::Zero(), {storeys.front()}, {storeys[i]}});
    symmetry.rooms_alike = rooms_alike(floor_);
    if (floor_.storeys > 1) {
      std::vector<std::vector<std::string>> all;
      std::vector<std::vector<std::string>> floor = symmetry.rooms_alike;
      for (const TemplateRoom& room : floor_.rooms) {
        const bool listed = std::any_of(floor.begin(), floor.end(), [&](const auto& like) {
          return std::find(like.begin(), like.end(), room.id) != like.end();
        });
        if (!listed) floor.push_back({room.id});
      }
      for (const std::vector<std::string>& like : floor) {
        all.emplace_back();
        for (int i = 0; i < floor_.storeys; ++i)
          for (const std::string& room : like) all.back().push_back(room_id(room, i));
      }
      symmetry.rooms_alike = std::move(all);
    }
    plan_.symmetry = std::move(symmetry);
  }

  const FloorTemplate& floor_;
  const GeneratorOptions& options_;
  const FeaturedTemplate* featured_;
  int featured_storey_;
  PlanFile plan_;
  std::string plain_, plain_prefix_;
  std::vector<std::string> prefixes_;
};

/// Rooms to try the feature in: the start's own where it is to be seen, otherwise the farthest first.
std::vector<std::string> rooms_to_try(const FloorTemplate& floor, bool visible) {
  if (visible) return {floor.start};
  const Eigen::Vector2d start = centroid(floor.rooms[static_cast<std::size_t>(floor.find_room(floor.start))].outline);
  std::vector<std::pair<double, std::string>> rooms;
  for (const TemplateRoom& room : floor.rooms)
    if (room.id != floor.start) rooms.emplace_back(-(centroid(room.outline) - start).norm(), room.id);
  std::stable_sort(rooms.begin(), rooms.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> ids;
  for (const auto& [distance, id] : rooms) ids.push_back(id);
  return ids;
}

/// The plan with its feature at the first position that has the required visibility.
PlanFile with_feature(const FloorTemplate& floor, const GeneratorOptions& options, const Mark& mark) {
  const int storey = !options.feature_visible && floor.storeys > 1 ? floor.storeys - 1 : 0;
  const bool same_storey = storey == 0;
  for (const std::string& room : rooms_to_try(floor, options.feature_visible)) {
    for (const FeaturedTemplate& featured : place_feature(floor, options, room)) {
      Tower tower(floor, options, &featured, storey);
      PlanFile plan = tower.build();
      const Building building = read_plan_text(write_plan(plan), "generated");
      std::vector<std::string> seen = rooms_that_see(building, storey, featured.seen_at);
      const bool from_start = same_storey && std::find(seen.begin(), seen.end(), floor.start) != seen.end();
      if (from_start != options.feature_visible) continue;
      const std::string prefix = storey == 0 ? "" : storey_name(storey) + "_";
      plan.symmetry->feature =
          PlanFeatureEntry{options.feature,     options.epsilon_m,           prefix + featured.element,
                           storey_name(storey), tower.room_id(room, storey), featured.at,
                           std::move(seen)};
      return plan;
    }
  }
  const std::string name(EnumNames<FeatureKind>::names[static_cast<std::size_t>(options.feature)]);
  throw InputError(mark, "no position for a " + name + " of " + format_number(options.epsilon_m) +
                             " m that the start room " + (options.feature_visible ? "sees" : "does not see") +
                             "; another feature, a smaller size, other sizes of rooms" +
                             (options.glass ? " or no glass" : ""));
}

/// Throws when what was asked for gives no plan that is right in itself, though each size is allowed.
void check_readable(const FloorTemplate& floor, const GeneratorOptions& options, const Tree& tree) {
  try {
    (void)read_plan_text(write_plan(Tower(floor, options, nullptr, 0).build()), "its plan");
  } catch (const InputError& error) {
    const bool thin = options.facade_m < options.partition_m;
    throw InputError(mark_of(tree, thin ? "facade_m" : ""),
                     std::string("these sizes make no plan that can be read (") + error.what() + ")" +
                         (thin ? "; a facade no thinner than the partitions would do" : ""));
  }
}

}  // namespace

std::span<const GeneratorRow> generators() { return rows; }

std::vector<OptionRow> generator_options(std::string_view family) {
  return with_generator(family, [](const auto& entry) {
    OptionLister lister;
    auto options = entry.defaults;
    options.visit(lister);
    return lister.rows;
  });
}

GeneratedPlan generate(std::string_view family, const Tree& options_tree) {
  return with_generator(family, [&](const auto& entry) {
    const auto options = read_options(entry.defaults, options_tree);
    check_feature(options, options_tree);
    FloorTemplate floor = entry.build(options, options_tree.mark);
    floor.name = std::string(family);
    check_readable(floor, options, options_tree);
    GeneratedPlan generated;
    generated.plan = options.epsilon_m > 0.0 ? with_feature(floor, options, mark_of(options_tree, "feature"))
                                             : Tower(floor, options, nullptr, 0).build();
    generated.start = floor.start;
    for (const TemplateRoom& room : floor.rooms)
      if (room.id != floor.start) generated.rooms.push_back(room.id);
    generated.rooms.push_back(floor.start);
    return generated;
  });
}

}  // namespace plumbline::bim
