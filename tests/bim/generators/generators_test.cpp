// SPDX-License-Identifier: Apache-2.0
#include "bim/generators/generators.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "bim/mesh/mesh.h"
#include "bim/symmetry/symmetry.h"
#include "tests/bim/generators/option_sweep.h"
#include "tests/input_error.h"

namespace plumbline::bim {
namespace {

constexpr std::uint64_t extrude_between = 240;  ///< of which at least 200 must be possible

Isometry2 turn_of(const PlanIsometryEntry& entry) {
  return Isometry2::turn(entry.angle_deg * std::numbers::pi / 180.0, entry.about);
}

bool same(const Isometry2& a, const Isometry2& b) {
  const Eigen::Vector2d probe(7.0, 3.0);
  constexpr double same_m = 1e-5;  // rounding of written coordinates, to 1 micrometre, and of the fit
  return a.mirrored == b.mirrored && (a * probe - b * probe).norm() < same_m && (a.t - b.t).norm() < same_m;
}

const BuildingSymmetry* find(const SymmetryReport& report, const Isometry2& g, bool roughly) {
  for (const BuildingSymmetry& symmetry : report.building) {
    const double turn = std::remainder(symmetry.isometry.angle - g.angle, 2.0 * std::numbers::pi);
    if (roughly ? std::abs(turn) < 0.02 : same(symmetry.isometry, g)) return &symmetry;
  }
  return nullptr;
}

/// Exactly what was constructed is found.
void expect_group(const SweepCase& c, const SymmetryReport& report) {
  std::size_t turns = 0, copies = 0;
  for (const PlanIsometryEntry& entry : c.generated.plan.symmetry->group) {
    if (entry.angle_deg == 0.0) {
      ++copies;
      continue;
    }
    ++turns;
    const BuildingSymmetry* found = find(report, turn_of(entry), false);
    ASSERT_NE(found, nullptr) << c.what << " " << entry.angle_deg;
    EXPECT_EQ(found->similarity.grade, SimilarityGrade::exact) << c.what;
  }
  const auto exact = [](const auto& s) { return s.similarity.grade == SimilarityGrade::exact; };
  EXPECT_EQ(static_cast<std::size_t>(std::count_if(report.building.begin(), report.building.end(), exact)), turns)
      << c.what;
  const auto shifted = std::count_if(report.copies.begin(), report.copies.end(), [&](const StoreySymmetry& s) {
    return exact(s) && std::abs(s.isometry.angle) < 1e-6 && s.isometry.t.norm() < 1e-5;
  });
  EXPECT_EQ(static_cast<std::size_t>(shifted), copies) << c.what;
}

/// Rooms said to be alike are found in one class, exactly alike.
void expect_rooms(const SweepCase& c, const SymmetryReport& report) {
  for (const std::vector<std::string>& like : c.generated.plan.symmetry->rooms_alike) {
    const bool found = std::any_of(report.rooms.begin(), report.rooms.end(), [&](const RoomClass& room_class) {
      return std::all_of(like.begin(), like.end(), [&](const std::string& id) {
        return std::any_of(room_class.rooms.begin(), room_class.rooms.end(), [&](const SimilarRoom& room) {
          return c.building.rooms[static_cast<std::size_t>(room.room)].id == id &&
                 room.similarity.grade == SimilarityGrade::exact;
        });
      });
    });
    EXPECT_TRUE(found) << c.what << ": " << like.front() << " and " << like.size() - 1 << " more";
  }
}

/// The largest deviation stands at the feature, or where the isometry puts it or takes it from.
void expect_residual_at_feature(const SweepCase& c, const Isometry2& g, const Similarity& similarity) {
  const PlanFeatureEntry& feature = *c.generated.plan.symmetry->feature;
  ASSERT_FALSE(similarity.deviations.empty()) << c.what;
  const Eigen::Vector2d at = similarity.deviations.front().at;
  double nearest = 1e9;
  for (const Eigen::Vector2d& place :
       {feature.at, Eigen::Vector2d(g * feature.at), Eigen::Vector2d(g.inverse() * feature.at)})
    nearest = std::min(nearest, (at - place).norm());
  // A shifted wall deviates anywhere along it; everything else is smaller than a metre.
  EXPECT_LT(nearest, feature.kind == FeatureKind::wall_shift ? 8.0 : 1.2) << c.what << " " << at.transpose();
  EXPECT_GT(similarity.deviation_m, 0.3 * feature.size_m) << c.what;
}

/// The feature breaks the whole group: nothing is exact any more; a look at the nearly alike finds it.
void expect_broken(const SweepCase& c, const SymmetryReport& report) {
  for (const BuildingSymmetry& symmetry : report.building)
    EXPECT_NE(symmetry.similarity.grade, SimilarityGrade::exact) << c.what << " " << symmetry.isometry.angle;
  SymmetryConfig loose;
  loose.near_m = loose.reach_m;
  loose.iou_min = 0.6;
  const SymmetryReport nearly = analyse_symmetry(c.building, loose);
  for (const PlanIsometryEntry& entry : c.generated.plan.symmetry->group) {
    if (entry.angle_deg == 0.0) continue;
    const BuildingSymmetry* found = find(nearly, turn_of(entry), true);
    ASSERT_NE(found, nullptr) << c.what << " " << entry.angle_deg;
    expect_residual_at_feature(c, turn_of(entry), found->similarity);
  }
}

TEST(Families, TwoHundredBuildingsAreSoundAndAsSymmetricAsConstructed) {
  std::size_t count = 0, exact = 0;
  for (std::uint64_t k = 0; k < extrude_between; ++k) {
    const std::optional<SweepCase> c = sweep_case(k);
    if (!c) continue;
    ++count;
    for (const MeshElement& element : build_mesh(c->building).elements)
      ASSERT_TRUE(element.closed) << c->what << " " << element.id;
    const SymmetryReport report = analyse_symmetry(c->building);
    if (c->generated.plan.symmetry->exact) {
      ++exact;
      expect_group(*c, report);
      expect_rooms(*c, report);
    } else {
      expect_broken(*c, report);
    }
  }
  EXPECT_GE(count, 200U);
  EXPECT_GE(exact, 30U);
  RecordProperty("buildings", static_cast<int>(count));
}

std::string plan_of(const std::string& family, const std::vector<std::pair<std::string, std::string>>& options) {
  Tree tree = Tree::map();
  for (const auto& [key, value] : options) tree.set(key, value);
  return write_plan(generate(family, tree).plan);
}

std::string error_of(const std::string& family, const std::vector<std::pair<std::string, std::string>>& options) {
  return input_error([&] { (void)plan_of(family, options); });
}

TEST(Families, SizeZeroIsTheSameBuildingAsNoFeature) {
  for (const GeneratorRow& family : generators()) {
    const std::string name(family.name);
    for (const char* feature : {"door_shift", "wall_shift", "niche", "window", "column", "clutter"})
      EXPECT_EQ(plan_of(name, {{"seed", "3"}, {"feature", feature}, {"epsilon_m", "0"}}),
                plan_of(name, {{"seed", "3"}}));
  }
}

TEST(Families, SeedsDifferAndWhatIsGivenStands) {
  for (const GeneratorRow& family : generators()) {
    const std::string name(family.name);
    EXPECT_EQ(plan_of(name, {{"seed", "3"}}), plan_of(name, {{"seed", "3"}}));
    EXPECT_NE(plan_of(name, {{"seed", "3"}}), plan_of(name, {{"seed", "4"}}));
    EXPECT_NE(plan_of(name, {{"seed", "3"}, {"height_m", "2.71"}}).find("height_m: 2.71"), std::string::npos);
  }
}

TEST(Families, SaysWhatIsWrong) {
  EXPECT_NE(error_of("corridr", {}).find("did you mean 'corridor'?"), std::string::npos);
  EXPECT_NE(error_of("corridor", {{"epsilon_m", "0.01"}, {"feature", "niche"}}).find("at least 0.02 m"),
            std::string::npos);
  EXPECT_NE(error_of("corridor", {{"epsilon_m", "0.1"}}).find("needs a feature"), std::string::npos);
  EXPECT_NE(error_of("corridor", {{"rooms", "1"}}).find("out of range"), std::string::npos);
  EXPECT_NE(error_of("corridor", {{"door_offset_m", "1.9"}}).find("may be off by"), std::string::npos);
  EXPECT_NE(error_of("storeys", {{"storeys", "1"}}).find("at least 2"), std::string::npos);
  EXPECT_NE(error_of("hall", {{"pillars_x", "40"}}).find("fewer pillars"), std::string::npos);
  EXPECT_NE(error_of("corridor", {{"epsilon_m", "0.5"}, {"feature", "door_shift"}, {"glass", "true"}}).find("no glass"),
            std::string::npos);
}

TEST(Families, FeatureIsSeenOrNotAsAskedFor) {
  for (const char* visible : {"true", "false"}) {
    Tree options = Tree::map();
    options.set("feature", "column").set("epsilon_m", "0.2").set("feature_visible", visible);
    const GeneratedPlan generated = generate("corridor", options);
    const std::vector<std::string>& seen = generated.plan.symmetry->feature->visible_from;
    EXPECT_EQ(std::find(seen.begin(), seen.end(), generated.start) != seen.end(), std::string(visible) == "true");
    EXPECT_FALSE(seen.empty());
  }
}

bool exactly_symmetric(const Building& building) {
  const std::vector<BuildingSymmetry> found = analyse_symmetry(building).building;
  return std::any_of(found.begin(), found.end(),
                     [](const auto& s) { return s.similarity.grade == SimilarityGrade::exact; });
}

/// The plan with one door built elsewhere along its wall.
std::string with_moved_door(PlanFile plan, const std::string& door, double by_m) {
  PlanDeviationEntry& moved = plan.deviations.emplace_back();
  moved.op = DeviationOp::move_opening;
  moved.target = door;
  moved.by_m = by_m;
  return write_plan(plan);
}

TEST(Families, DeviationsBreakAndCreateSymmetry) {
  Tree options = Tree::map();
  options.set("seed", "3");
  const PlanFile even = generate("rot180", options).plan;
  options.set("feature", "door_shift").set("epsilon_m", "0.3");
  const PlanFile uneven = generate("rot180", options).plan;
  const std::string door = uneven.symmetry->feature->element;
  const auto place = [&](const PlanFile& plan) {
    return plan.openings[static_cast<std::size_t>(find_entry(plan.openings, door))].s_m;
  };
  const double shift = place(uneven) - place(even);
  ASSERT_NEAR(std::abs(shift), 0.3, 1e-6);
  const PlanWithDeviations broken = read_plan_with_deviations(with_moved_door(even, door, shift), "broken");
  EXPECT_TRUE(exactly_symmetric(broken.as_planned));
  EXPECT_FALSE(exactly_symmetric(broken.as_built.building));
  const PlanWithDeviations created = read_plan_with_deviations(with_moved_door(uneven, door, -shift), "created");
  EXPECT_FALSE(exactly_symmetric(created.as_planned));
  EXPECT_TRUE(exactly_symmetric(created.as_built.building));
}

/// Rooms are clear of half an inner wall, so that a thin outer wall stands within them.
TEST(Generators, SizesThatMakeNoReadablePlanAreRefused) {
  Tree options = Tree::map();
  options.set("facade_m", 0.1).set("partition_m", 0.27);
  const std::string error = input_error([&] { static_cast<void>(generate("corridor", options)); });
  EXPECT_NE(error.find("a facade no thinner than the partitions"), std::string::npos) << error;
  options.set("facade_m", 0.27);
  EXPECT_FALSE(generate("corridor", options).plan.walls.empty());
}

}  // namespace
}  // namespace plumbline::bim
