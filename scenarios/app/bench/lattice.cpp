// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/bench/lattice.h"

#include "bim/config/tree.h"

namespace plumbline::scenarios {

namespace {

std::string point(double x, double y) { return "[" + format_number(x) + ", " + format_number(y) + "]"; }

/// Lists of a plan, grown wall by wall.
class Lattice {
 public:
  explicit Lattice(const LatticeConfig& config) : config_(config) {}

  void add_wall(double x0, double y0, double x1, double y1) {
    const std::string id = "w" + std::to_string(walls_++);
    walls_text_ += "  - {id: " + id + ", storey: s, a: " + point(x0, y0) + ", b: " + point(x1, y1) +
                   ", thickness_m: " + format_number(config_.thickness_m) + "}\n";
    openings_text_ += "  - {id: " + id + "d, wall: " + id + ", kind: door, s_m: 1, width_m: 0.9}\n";
    openings_text_ +=
        "  - {id: " + id + "v, wall: " + id + ", kind: window, s_m: 2.6, width_m: 1.2, sill_m: 0.9, height_m: 1.2}\n";
  }

  void add_room(int i, int j) {
    const double x = i * config_.cell_x_m, y = j * config_.cell_y_m;
    rooms_text_ += "  - {id: r" + std::to_string(i) + "_" + std::to_string(j) + ", storey: s, polygon: [" +
                   point(x, y) + ", " + point(x + config_.cell_x_m, y) + ", " +
                   point(x + config_.cell_x_m, y + config_.cell_y_m) + ", " + point(x, y + config_.cell_y_m) + "]}\n";
  }

  [[nodiscard]] std::string text() const {
    return "plan: 1\nname: lattice\nstoreys: [{id: s}]\nwalls:\n" + walls_text_ + "openings:\n" + openings_text_ +
           (rooms_text_.empty() ? "" : "rooms:\n" + rooms_text_);
  }

 private:
  LatticeConfig config_;
  int walls_ = 0;
  std::string walls_text_, openings_text_, rooms_text_;
};

}  // namespace

std::string lattice_plan(int walls, const LatticeConfig& config) {
  int n = 1;
  while (2 * n * (n + 1) < walls) ++n;
  Lattice lattice(config);
  int left = walls;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < n; ++j) {
      if (left-- > 0)
        lattice.add_wall(i * config.cell_x_m, j * config.cell_y_m, i * config.cell_x_m, (j + 1) * config.cell_y_m);
      if (left-- > 0)
        lattice.add_wall(j * config.cell_x_m, i * config.cell_y_m, (j + 1) * config.cell_x_m, i * config.cell_y_m);
    }
  // Line i holds the walls at x = i and at y = i; the cells below the last whole line have all four of theirs.
  const int lines = walls / (2 * n);
  for (int i = 0; i + 1 < lines; ++i)
    for (int j = 0; j + 1 < lines; ++j) lattice.add_room(i, j);
  return lattice.text();
}

}  // namespace plumbline::scenarios
