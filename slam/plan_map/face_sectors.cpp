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

/// Ranges of directions of FirstFaces, first to last.
struct Fans {
  int first = 0, last = 0;
};

/// Those that a list covers: its sectors and a little more.
std::array<Fans, FaceSectors::per_turn> fans_of_lists() {
  constexpr double slack = 1e-5;
  const auto pseudo = [](int sector) {
    const double angle = 2.0 * std::numbers::pi * sector / FaceSectors::per_turn;
    return pseudo_angle({std::cos(angle), std::sin(angle)});
  };
  std::array<Fans, FaceSectors::per_turn> lists;
  for (int sector = 0; sector < FaceSectors::per_turn; ++sector) {
    const double from = pseudo(sector), to = pseudo((sector + FaceSectors::wide) % FaceSectors::per_turn);
    lists[static_cast<std::size_t>(sector)] = {
        static_cast<int>(std::floor((from - slack) * FirstFaces::fans_per_quadrant)),
        static_cast<int>(std::floor(((to < from ? to + 4.0 : to) + slack) * FirstFaces::fans_per_quadrant))};
  }
  return lists;
}

/// Lists of several fans as one.
class Union {
 public:
  explicit Union(std::size_t segments) : from_(segments, infinity) {}

  [[nodiscard]] const std::vector<FirstFaces::Entry>& of(const FirstFaces& first_faces, int cell, const Fans& fans) {
    list_.clear();
    float complete = infinity;
    for (int fan = fans.first; fan <= fans.last; ++fan) {
      const FirstFaces::Entry* entry =
          first_faces.list(cell, (fan + FirstFaces::fans_per_turn) % FirstFaces::fans_per_turn);
      for (; entry->segment >= 0; ++entry) add(*entry);
      complete = std::min(complete, entry->from);
    }
    for (FirstFaces::Entry& entry : list_) entry.from = std::exchange(least(entry), infinity);
    std::sort(list_.begin(), list_.end(), [](const FirstFaces::Entry& a, const FirstFaces::Entry& b) {
      return a.from < b.from || (a.from == b.from && a.segment < b.segment);
    });
    list_.push_back({-1, complete});
    return list_;
  }

 private:
  [[nodiscard]] float& least(const FirstFaces::Entry& entry) { return from_[static_cast<std::size_t>(entry.segment)]; }
  void add(const FirstFaces::Entry& entry) {
    if (least(entry) == infinity) list_.push_back(entry);
    least(entry) = std::min(least(entry), entry.from);
  }

  std::vector<float> from_;  ///< by segment, infinity where it is not in the list
  std::vector<FirstFaces::Entry> list_;
};

}  // namespace

FaceSectors::FaceSectors(const std::vector<PlanSegment>& segments, const FirstFaces& first_faces, int cells) {
  if (first_faces.empty()) return;
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
  const std::array<Fans, per_turn> lists = fans_of_lists();
  Union several(segments.size());
  for (int cell = 0; cell < cells; ++cell) {
    for (const Fans& fans : lists) {
      const std::vector<Entry>& list = several.of(first_faces, cell, fans);
      first_.push_back(static_cast<int>(entries_.size()));
      entries_.insert(entries_.end(), list.begin(), list.end());
    }
    for (int fan = 0; fan < FirstFaces::fans_per_turn; ++fan) {
      const Entry* entry = first_faces.list(cell, fan);
      while (entry->segment >= 0) ++entry;
      complete_.push_back(entry->from);
    }
  }
}

}  // namespace plumbline::slam
