// SPDX-License-Identifier: Apache-2.0
#include "scenarios/localizability/localizability_map.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "bim/config/tree.h"
#include "bim/errors.h"
#include "scenarios/host/parallel.h"
#include "scenarios/localizability/aliased_poses.h"
#include "scenarios/localizability/walks.h"

namespace plumbline::scenarios {

namespace {

constexpr std::size_t most_ratios = std::size_t{1} << 27U;
constexpr std::size_t block = 64;  ///< cells between two moments at which isometries are shared
constexpr double height_m = 1e-3;  ///< a sensor over the floor of a storey is no further off its height there

/// Cells of a map, their scans and the isometries found so far.
class Mapper {
 public:
  explicit Mapper(const LocalizabilityMapInput& input)
      : input_(input),
        own_index_(input.index == nullptr ? std::make_unique<PlaceIndex>(index_of(input)) : nullptr),
        finder_(own_index_ ? *own_index_ : *input.index, *input.as_planned, *input.as_built, input.loose,
                input.isometries) {
    for (std::size_t f = 0; f < input.floors.size(); ++f)
      for (const Eigen::Vector2d& p : input.floors[f].cells_W) map_.cells.push_back({f, p, {}, {}, {}});
    if (map_.cells.size() <= most_map_cells) return;
    const double share = static_cast<double>(map_.cells.size()) / static_cast<double>(most_map_cells);
    throw InputError({"--step", 0, 0}, "gives " + std::to_string(map_.cells.size()) + " places, and there may be " +
                                           std::to_string(most_map_cells) + "; " +
                                           format_number(std::ceil(11.0 * input.step_m * std::sqrt(share)) / 10.0) +
                                           " m would do, or no --step, for one that fits --budget");
  }

  LocalizabilityMap make() {
    scans_.resize(map_.cells.size());
    for_each_index(scans_.size(), input_.threads, [&](std::size_t i) { scans_[i] = finder_.scan_at(place(i)); });
    find_aliases();
    map_.beams = finder_.work();
    map_.beams += finder_.work_of_llr() * answer_by_walks({input_, finder_, scans_}, map_);
    return std::move(map_);
  }

 private:
  struct Found {
    std::vector<CellAlias> known;
    std::vector<FoundAlias> fresh;
  };

  [[nodiscard]] SensorPose place(std::size_t cell) const {
    const MapCell& c = map_.cells[cell];
    const double z = input_.storeys[input_.floors[c.floor].storey].sensor_z_W(c.p_W);
    return {{c.p_W.x(), c.p_W.y(), z}, 0.0};
  }

  [[nodiscard]] bool on_a_storey_asked_for(std::size_t cell, const SensorPose& alias) const {
    const std::size_t own = input_.floors[map_.cells[cell].floor].storey;
    for (std::size_t s = 0; s < input_.storeys.size(); ++s)
      if (std::abs(input_.storeys[s].sensor_z_W(alias.position_W.head<2>()) - alias.position_W.z()) < height_m)
        return input_.across || s == own;
    return false;
  }

  /// Adds aliases of a cell under known isometries, as far as their llr allows.
  void try_isometries(std::size_t cell, double llr_max, std::vector<CellAlias>& aliases) const {
    const ReferenceScan& scan = scans_[cell];
    std::vector<SensorPose> taken = {scan.place};
    for (const CellAlias& alias : aliases) taken.push_back(image(alias.isometry, scan.place));
    for (std::size_t g = 0; g < map_.isometries.size(); ++g) {
      const SensorPose alias = image(g, scan.place);
      const auto alike = [&](const SensorPose& other) {
        return same_pose(alias, other, localizability_constants.same_alias_m, localizability_constants.same_alias_deg);
      };
      if (same_pose(alias, scan.place, localizability_constants.distinct_m, localizability_constants.distinct_deg) ||
          !on_a_storey_asked_for(cell, alias))
        continue;
      if (std::any_of(taken.begin(), taken.end(), alike) || finder_.clearly_different(scan, alias)) continue;
      const double llr = finder_.llr(scan, alias);
      if (llr > llr_max) continue;
      taken.push_back(alias);
      aliases.push_back({g, llr});
    }
  }

  [[nodiscard]] SensorPose image(std::size_t isometry, const SensorPose& place) const {
    const Pose X = map_.isometries[isometry] * place.pose();
    return {X.t, X.yaw()};
  }

  [[nodiscard]] Found search(std::size_t cell) const {
    Found found;
    // Where an isometry of another cell fits less well, one of this cell's own may fit better.
    try_isometries(cell, localizability_constants.marginal_llr, found.known);
    std::vector<SensorPose> known;
    for (const CellAlias& alias : found.known) known.push_back(image(alias.isometry, scans_[cell].place));
    const auto own = static_cast<int>(input_.floors[map_.cells[cell].floor].storey);
    found.fresh = finder_.find(scans_[cell], {input_.across ? -1 : own, input_.compass_only}, known);
    return found;
  }

  /// The isometry by which a cell has an alias; one found before where it does the same there.
  std::size_t isometry_to(std::size_t cell, const SensorPose& alias) {
    constexpr double same_m = 1e-3, same_deg = 0.02;
    for (std::size_t g = 0; g < map_.isometries.size(); ++g)
      if (same_pose(image(g, scans_[cell].place), alias, same_m, same_deg)) return g;
    if (map_.isometries.size() * map_.cells.size() >= most_ratios)
      throw InputError({"--step", 0, 0}, "gives too many aliased places; it must be larger");
    map_.isometries.push_back(alias.pose() * scans_[cell].place.pose().inverse());
    return map_.isometries.size() - 1;
  }

  /// Block by block, each with the isometries of those before it; then every cell with all of them.
  void find_aliases() {
    const std::size_t n = map_.cells.size();
    for (std::size_t first = 0; first < n; first += block) {
      if (input_.progress) input_.progress(first, n);
      std::vector<Found> found(std::min(block, n - first));
      for_each_index(found.size(), input_.threads, [&](std::size_t i) { found[i] = search(first + i); });
      for (std::size_t i = 0; i < found.size(); ++i) {
        std::vector<CellAlias>& aliases = map_.cells[first + i].aliases;
        aliases = std::move(found[i].known);
        for (const FoundAlias& alias : found[i].fresh)
          aliases.push_back({isometry_to(first + i, alias.place), alias.llr});
      }
    }
    for_each_index(n, input_.threads, [&](std::size_t cell) {
      try_isometries(cell, localizability_constants.drop_llr, map_.cells[cell].aliases);
    });
  }

  const LocalizabilityMapInput& input_;
  std::unique_ptr<PlaceIndex> own_index_;
  AliasFinder finder_;
  std::vector<ReferenceScan> scans_;
  LocalizabilityMap map_;
};

}  // namespace

PlaceIndex index_of(const LocalizabilityMapInput& input) {
  return {*input.as_planned, input.storeys, std::min(input.step_m, localizability_constants.grid_m), input.threads};
}

LocalizabilityMap compute_localizability_map(const LocalizabilityMapInput& input) { return Mapper(input).make(); }

}  // namespace plumbline::scenarios
