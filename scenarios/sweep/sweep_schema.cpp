// SPDX-License-Identifier: Apache-2.0
#include "scenarios/sweep/sweep_schema.h"

#include "scenarios/sweep/sweep_file.h"

namespace plumbline::scenarios {

namespace {

constexpr std::string_view introduction = R"md(# Sweep files

A sweep makes many runs and one table: scenarios x variants x starts x seeds, each run with all methods. `plumbline sweep
SWEEP` runs it. `plumbline sweep --schema` prints this page, which is made from the reader itself.

- `scenarios` are files, relative to the sweep; the examples here belong beside the folder `library`. A variant replaces values in them (`set: [prior.yaw=known]`); `starts` replace their starts.
- Runs of one seed that differ in `prior`, `methods`, `sensors` and `gates` only share one simulation. Each of them has, to the last
  bit, the scores that `plumbline run` gives.
- `sensors: [all, lidar]` gives every method that can run with LiDAR alone a second row, `NAME.lidar`. A variant may set it
  instead (`set: [sensors=lidar]`).
- Groups of such runs are processes of their own, `--jobs` at a time.
- Each run leaves one file in `results/`, complete or not at all. A run is not repeated while scenario, building, seed
  and program are those of its file. A sweep that was interrupted therefore continues.
- `runs.csv` has a row for each run and method, with the cause of a failure and the digests of run, sensor data and
  method; `compare` reads it. `table.txt`, `table.csv` and `table.html`
  have a row for each scenario, variant, start and method over all seeds. `sweep.sqlite` holds both. In the `.csv` files an
  apostrophe stands before a word that a spreadsheet would take for a formula.
- No result depends on `--jobs` or on interruptions.
- Rows of plan localization separate identifiable runs, where scans and plan determine the pose, from ambiguous ones,
  where several poses explain the scans. In marginal runs (evidence `weak`) the alternatives are nearly excluded, or too late
  to hold an answer for 5 s and 1 m.
- They give the success rate of identifiable runs with its 95 % interval (Wilson), the share of `honest_ambiguity` of
  ambiguous runs, the share of right answers of marginal runs, false convergences, and the median error of the identifiable runs.
- Of these runs the median distance to convergence counts one without `success` as infinite. The median error counts one
  without an error as infinite, as where it never converged or crashed.
- Rows of SLAM methods give the share of `complete` and the median error.
- Gates belong to `plumbline run`. A sweep checks none, and its exit code is 0 whatever its table holds.
- A run whose scenario cannot be walked counts as failed; the others go on, their table is written, and the exit code is 2.

)md";

}  // namespace

const std::vector<std::string>& sweep_examples() {
  static const std::vector<std::string> examples = {R"yaml(sweep: 1
name: with and without a compass
scenarios: [library/quickstart.yaml, library/house.yaml]
seeds: 20
first_seed: 1
methods: [vgicp, s_graph_localization]
sensors: [all, lidar]
variants:
  - {name: compass, set: [prior.yaw=known]}
  - {name: no compass, set: [prior.yaw=unknown, duration_s=90]}
)yaml",
                                                    R"yaml(sweep: 1
name: where it starts
scenarios: [library/house.yaml]
seeds: 5
starts:
  - {room: living}
  - {storey: ground, at: [1.5, 2.5], yaw_deg: 90}
  - {random: anywhere}
)yaml"};
  return examples;
}

std::vector<SchemaSection> sweep_schema() { return SchemaVisitor::sections_of<SweepFile>(); }

std::string sweep_page() {
  std::string page(introduction);
  for (const std::string& text : sweep_examples()) page += "```yaml\n" + text + "```\n\n";
  return page + "## The file\n\n" + schema_tables(sweep_schema());
}

}  // namespace plumbline::scenarios
