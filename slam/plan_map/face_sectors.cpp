// SPDX-License-Identifier: Apache-2.0
#include "slam/plan_map/face_sectors.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <utility>

namespace plumbline::slam {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Ranges of directions of RayCandidateTable, first to last.
struct BinRange {
  int first = 0, last = 0;
};

/// Those that a list covers: its sectors and a little more.
std::array<BinRange, FaceSectors::per_turn> bins_of_lists() {
  constexpr double slack = 1e-5;
  const auto pseudo = [](int sector) {
    const double angle = 2.0 * std::numbers::pi * sector / FaceSectors::per_turn;
    return pseudo_angle({std::cos(angle), std::sin(angle)});
  };
  std::array<BinRange, FaceSectors::per_turn> lists;
  for (int sector = 0; sector < FaceSectors::per_turn; ++sector) {
    const double from = pseudo(sector), to = pseudo((sector + FaceSectors::wide) % FaceSectors::per_turn);
    lists[static_cast<std::size_t>(sector)] = {
        static_cast<int>(std::floor((from - slack) * RayCandidateTable::azimuth_bins_per_quadrant)),
        static_cast<int>(
            std::floor(((to < from ? to + 4.0 : to) + slack) * RayCandidateTable::azimuth_bins_per_quadrant))};
  }
  return lists;
}

/// Lists of several azimuth bins as one.
class MergedBins {
 public:
  explicit MergedBins(std::size_t segments) : from_(segments, infinity) {}

  [[nodiscard]] const std::vector<RayCandidateTable::Entry>& of(const RayCandidateTable& ray_candidates, int cell,
                                                                const BinRange& bins) {
    list_.clear();
    float complete = infinity;
    for (int bin = bins.first; bin <= bins.last; ++bin) {
      const RayCandidateTable::Entry* entry = ray_candidates.list(
          cell, (bin + RayCandidateTable::azimuth_bins_per_turn) % RayCandidateTable::azimuth_bins_per_turn);
      for (; entry->segment >= 0; ++entry) add(*entry);
      complete = std::min(complete, entry->from);
    }
    for (RayCandidateTable::Entry& entry : list_) entry.from = std::exchange(least(entry), infinity);
    std::sort(list_.begin(), list_.end(), [](const RayCandidateTable::Entry& a, const RayCandidateTable::Entry& b) {
      return a.from < b.from || (a.from == b.from && a.segment < b.segment);
    });
    list_.push_back({-1, complete});
    return list_;
  }

 private:
  [[nodiscard]] float& least(const RayCandidateTable::Entry& entry) {
    return from_[static_cast<std::size_t>(entry.segment)];
  }
  void add(const RayCandidateTable::Entry& entry) {
    if (least(entry) == infinity) list_.push_back(entry);
    least(entry) = std::min(least(entry), entry.from);
  }

  std::vector<float> from_;  ///< by segment, infinity where it is not in the list
  std::vector<RayCandidateTable::Entry> list_;
};

}  // namespace

FaceSectors::FaceSectors(const std::vector<PlanSegment>& segments, const RayCandidateTable& ray_candidates, int cells) {
  if (ray_candidates.empty()) return;
  const auto f = [](double value) { return all(static_cast<float>(value)); };
  for (const PlanSegment& s : segments) {
    const int first_hole = static_cast<int>(holes_.size());
    for (const bim::FaceHole& hole : s.holes) holes_.push_back({f(hole.s0), f(hole.s1), f(hole.z0), f(hole.z1)});
    faces_.push_back({f(s.n.x()),
                      f(s.n.y()),
                      f(s.e.x()),
                      f(s.e.y()),
                      f(s.a.x()),
                      f(s.a.y()),
                      {f(0.0), f(s.length), f(s.z0), f(s.z1)},
                      first_hole,
                      static_cast<int>(holes_.size())});
  }
  const std::array<BinRange, per_turn> lists = bins_of_lists();
  MergedBins several(segments.size());
  for (int cell = 0; cell < cells; ++cell) {
    for (const BinRange& bins : lists) {
      const std::vector<Entry>& list = several.of(ray_candidates, cell, bins);
      first_.push_back(static_cast<int>(entries_.size()));
      entries_.insert(entries_.end(), list.begin(), list.end());
    }
    for (int bin = 0; bin < RayCandidateTable::azimuth_bins_per_turn; ++bin) {
      const Entry* entry = ray_candidates.list(cell, bin);
      while (entry->segment >= 0) ++entry;
      complete_.push_back(entry->from);
    }
  }
}

}  // namespace plumbline::slam
