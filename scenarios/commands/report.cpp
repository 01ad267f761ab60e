// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "scenarios/commands/commands.h"
#include "scenarios/report/from_run.h"
#include "scenarios/run/files.h"
#include "scenarios/run/run_files.h"

namespace plumbline::scenarios {

Command add_report(CLI::App& program) {
  const auto dir = std::make_shared<std::string>();
  CLI::App* app = program.add_subcommand("report", "Writes the page of a run again");
  app->add_option("DIR", *dir, "run directory")->required();
  app->footer("Example: plumbline report runs/quickstart-1");
  return {app, [dir] {
            const RunFiles files = read_run_files(*dir);
            write_file(*dir + "/report.html", render_report(report_input(files, score::score_run(files))));
            std::printf("report: %s/report.html\n", dir->c_str());
            return 0;
          }};
}

}  // namespace plumbline::scenarios
