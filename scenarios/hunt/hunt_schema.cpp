// SPDX-License-Identifier: Apache-2.0
#include "scenarios/hunt/hunt_schema.h"

#include "scenarios/hunt/hunt_file.h"

namespace plumbline::scenarios {

namespace {

constexpr std::string_view hunt_introduction = R"md(# Hunt files

A hunt searches for failures that are a method's fault. `plumbline hunt HUNT` runs it; `plumbline hunt --schema` prints this page, which
is made from the reader itself.

- `scenarios` are files, relative to the hunt; the example here belongs beside the folder `library`.
- The first runs lie all over the ranges, as a Latin hypercube [mckay1979], and take scenarios and families in turns. Each has a seed of
  its own. The others (`refine`) are drawn in generations of 8 near the worst runs so far, half of them with the same seed. Of
  runs that failed in one way at most two are drawn near to, so that the search does not end with one failure.
- Badness: with the share s = error / (error + 0.5 m), s of a method that did well, 1 + s of a failure that is its fault, 2 of a
  crash, 0 of a failure that is not its fault. A run is as bad as its worst method.
- `crashed`, `false_convergence` and `overconfident` are the method's fault.
- `late`, `lost` and failed gates of a localization are its fault where the evidence is `unique`: scans and plan determine the pose in
  time, by what the method was told.
- `lost` of SLAM is its fault where another method of the run, `truth` aside, had a pose for the whole walk, at most 0.5 m off. A failed
  gate of SLAM is where another one kept the same bound. So name several methods.
- Where a signal ends the whole program, the walk with `truth` alone and each method by itself are run. Methods that end it alone have
  `crashed`. Where none does, where the walk does so with `truth`, or where the program was killed (SIGKILL, as when memory is short),
  the walk counts as failed, and `hunt.csv` says why.
- Other failures are counted with the reason; `lucky` is one of them.
- Failures are of one kind where method, verdict or gate, cause and the keys of the ingredients are the same. The worst of each kind
  is in `failures/NN`, the severest kind first: crashed, false_convergence, overconfident, lost, late, gates.
- No result depends on `--jobs`. After an interruption the runs of the slices and generations that are done stand in the tables; a hunt does not continue, it begins anew.

)md";

}  // namespace

const std::vector<std::string>& hunt_examples() {
  static const std::vector<std::string> examples = {R"yaml(hunt: 1
name: slippery
scenarios: [library/quickstart.yaml]
runs: 60
refine: 0.5
seed: 1
methods: [odometry, vgicp, s_graph_localization]
gates:
  - {metric: ate_aligned_rmse_m, method: vgicp, max: 0.25}
vary:
  - {key: faults.slip_mps, min: 0.01, max: 1, log: true}
  - {key: route.loop, min: 1, max: 3, whole: true}
  - {key: prior.yaw, values: [known, unknown]}
)yaml",
                                                    R"yaml(hunt: 1
name: corridors
runs: 100
methods: [s_graph_localization]
generate:
  - family: corridor
    options:
      - {key: rooms, min: 3, max: 8}
      - {key: feature, values: [column, door_shift]}
      - {key: epsilon_m, min: 0.02, max: 0.3, log: true}
  - {family: rot180}
vary:
  - {key: duration_s, min: 20, max: 60}
)yaml"};
  return examples;
}

std::vector<SchemaSection> hunt_schema() { return SchemaVisitor::sections_of<HuntFile>(); }

std::string hunt_page() {
  std::string page(hunt_introduction);
  for (const std::string& text : hunt_examples()) page += "```yaml\n" + text + "```\n\n";
  return page + "## The file\n\n" + schema_tables(hunt_schema());
}

}  // namespace plumbline::scenarios
