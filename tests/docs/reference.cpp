// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/reference.h"

#include <algorithm>
#include <string_view>

#include "bim/config/markdown.h"
#include "bim/formats/plan_yaml/plan_schema.h"
#include "bim/model/warning.h"
#include "scenarios/app/program.h"
#include "scenarios/host/files.h"
#include "scenarios/hunt/hunt_schema.h"
#include "scenarios/metrics/metrics.h"
#include "scenarios/metrics/result_words.h"
#include "scenarios/spec/scenario_schema.h"
#include "scenarios/sweep/sweep_schema.h"
#include "slam/io/recordings/recording_info.h"
#include "tests/docs/methods_page.h"

namespace plumbline::docs {

namespace {

std::string metrics_page() {
  namespace score = scenarios::score;
  std::string page = R"md(# Metrics

`results.json` holds these values for each method, and a scenario's gates may bound them. A metric that does not apply,
or cannot be computed, is absent. A dot in a name stands for a block. [Localizability](../methods/localizability.md) says
when scans and plan determine the pose. Distances walked are horizontal, between the places of scans, so that stairs and the sway of
a gait add nothing; `score --reference` knows no horizontal and takes them in space.

)md";
  MarkdownTable table({"metric", "unit", "better", "says"});
  for (const score::MetricRow& row : score::metrics()) {
    const char* better = row.better == score::Better::lower ? "lower" : "higher";
    table.add({markdown_code(row.name), std::string(row.unit), row.better == score::Better::neither ? "" : better,
               std::string(row.doc)});
  }
  page += table.text() +
          "\nAfter a kidnapping, all values of a localization except its state, its hypotheses and `kidnap_*` belong "
          "to the time before it.\n\n## Verdicts, evidence and causes of failure\n\n";
  MarkdownTable words({"of", "word", "says"});
  for (const score::ResultWord& word : score::result_words())
    words.add({word.key.starts_with("localization.") ? markdown_code(word.key) : std::string(word.key),
               markdown_code(word.word), std::string(word.doc)});
  return page + words.text();
}

std::string warnings_page() {
  std::string page = R"md(# Warnings

Every compromise that a reader makes is a warning of the element. `plumbline inspect BUILDING` counts them by kind and
shows one of each; `--json` lists all. A file that cannot be read is refused instead, with its place.

)md";
  MarkdownTable table({"kind", "means"});
  for (const bim::WarningRow& row : bim::warning_rows) table.add({markdown_code(row.kind), std::string(row.doc)});
  return page + table.text();
}

std::string commands_page() {
  std::string page = "# Commands\n\nWhat `--help` prints for the program and for each command.\n";
  for (const scenarios::CommandHelp& help : scenarios::program_help()) {
    const bool sub = std::count(help.command.begin(), help.command.end(), ' ') > 1;
    page += (sub ? "\n### " : "\n## ") + help.command + "\n\n```text\n" + help.text;
    page += std::string(help.text.ends_with('\n') ? "" : "\n") + "```\n";
  }
  return page;
}

std::string file_table(scenarios::DirectoryKind kind) {
  MarkdownTable table({"file", "holds"});
  for (const scenarios::FileRow& row : scenarios::files_of(kind))
    table.add({markdown_code(row.name), std::string(row.doc)});
  return table.text();
}

std::string files_page() {
  using Kind = scenarios::DirectoryKind;
  return R"md(# Files

Commands write their directories complete or not at all, and never replace a directory of another kind. Trajectories are
in the format of TUM: `t x y z qx qy qz qw`, in seconds of the run's clock and metres. The first scan is at 0.1 s.

## A run: `plumbline run`

)md" + file_table(Kind::run) +
         "\n## A recording: `plumbline simulate`\n\n" + file_table(Kind::recording) +
         "\n## An estimate: `plumbline estimate`\n\n" + file_table(Kind::estimate) + R"md(
### JSON files

- `<method>.hypotheses.jsonl`, a line for each scan: `stamp_ns`, `state`, `hypotheses` and, of some scans, `particles`, each
  `[x, y, yaw, weight]` in W. A hypothesis has `mass` (share, 0 to 1), `room`, `pose` (X_WR: x, y, z, qx, qy, qz, qw),
  `covariance` (3 x 3 of x, y, yaw, row by row, m and rad) and, where walls were matched, `walls`. A wall has `faces`, ids of the plan's faces, and
  `p0` and `p1`, the ends of the observed patch in R, m.
- `<method>.estimate.json`: `frame` (`map` or `world`); `planes`: `n` and `d` with n.p + d = 0, ends `p0` and `p1`,
  heights `z0` and `z1`; `rooms`: `kind`, `center`, `polygon`, `planes` (ids); `floors`: `center`, `n`, `d`. Its `loops`
  have `from_ns`, `to_ns`, and `pose`, that of the robot at `to_ns` in its frame at `from_ns`. All in m.
)md" + "\n## A sweep: `plumbline sweep`\n\n" +
         file_table(Kind::sweep) + "\n## A smallest run: `plumbline shrink`\n\n" + file_table(Kind::shrink) +
         "\n## A search: `plumbline hunt`\n\n" + file_table(Kind::hunt);
}

std::string recording_page() {
  return R"md(# Description files

`recording.yaml` of a recording, and the file that `estimate --description` takes: what is known of a robot besides the
records of its sensors. [Recordings](../guide/recordings.md#mount) has an example.

## The file

)md" + schema_tables(SchemaVisitor::sections_of<slam::RecordingInfo>());
}

std::string index_page() {
  return R"md(# Reference

The program describes itself here: `build/release/tests/plumbline_reference docs/reference` writes these pages, and a
test compares them. Change the code, not the pages.

- [commands.md](commands.md): each command's `--help`
- [plan.md](plan.md): plan files, every key
- [scenario.md](scenario.md): scenario files, every key
- [sweep.md](sweep.md): sweep files, every key
- [hunt.md](hunt.md): hunt files, every key
- [recording.md](recording.md): description files of recordings, every key
- [methods.md](methods.md): methods and their configs
- [metrics.md](metrics.md): metrics, verdicts, causes of failure
- [warnings.md](warnings.md): warnings of readers
- [files.md](files.md): directories of runs, recordings, estimates, sweeps, smallest runs and hunts
)md";
}

}  // namespace

std::vector<Page> reference_pages() {
  return {{"README.md", index_page()},
          {"commands.md", commands_page()},
          {"files.md", files_page()},
          {"hunt.md", scenarios::hunt_page()},
          {"methods.md", methods_page()},
          {"metrics.md", metrics_page()},
          {"plan.md", bim::plan_page()},
          {"recording.md", recording_page()},
          {"scenario.md", scenarios::scenario_page()},
          {"sweep.md", scenarios::sweep_page()},
          {"warnings.md", warnings_page()}};
}

}  // namespace plumbline::docs
