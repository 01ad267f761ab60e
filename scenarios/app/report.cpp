// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <string>

#include "bim/config/printable.h"
#include "scenarios/app/commands.h"
#include "scenarios/host/files.h"
#include "scenarios/host/terminal.h"
#include "scenarios/report/report_builder.h"
#include "scenarios/run/run_files.h"

namespace plumbline::scenarios {

Command add_report(CommandLine& program) {
  const auto dir = std::make_shared<std::string>();
  CommandLine line = program.add_command("report", "Writes report.html of a run again");
  line.option("DIR", *dir, "run directory").required();
  line.footer("Example: plumbline report runs/quickstart-1");
  return {line, [dir] {
            const FinishedRun run = read_run(*dir);
            remove_abandoned(*dir);
            write_file(*dir + "/report.html", render_report(report_input(run, score::score_run(run))));
            print("report: " + printable(*dir) + "/report.html\n");
            return 0;
          }};
}

}  // namespace plumbline::scenarios
