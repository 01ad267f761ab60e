// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "bim/config/printable.h"
#include "bim/config/tree.h"
#include "scenarios/app/commands.h"
#include "scenarios/host/terminal.h"
#include "scenarios/run/digest_log.h"
#include "slam/io/recordings/tum.h"

namespace plumbline::scenarios {

namespace {

DigestLog load(const std::string& dir) {
  const std::string path = dir + "/digests.csv";
  if (!std::filesystem::exists(path))
    throw InputError({dir, 0, 0}, "holds no digests.csv; name a directory that plumbline run or estimate wrote");
  return read_digests(read_text_file(path), path);
}

}  // namespace

Command add_diff(CommandLine& program) {
  struct Options {
    std::string a, b;
  };
  const auto options = std::make_shared<Options>();
  CommandLine line = program.add_command("diff", "Names the first stage and scan in which two runs differ");
  line.option("A", options->a, "run directory").takes("DIR").required();
  line.option("B", options->b, "run directory").takes("DIR").required();
  line.footer("Example: plumbline diff runs/quickstart-1 runs/quickstart-1-changed\nExit code 1 when they differ");
  return {line, [options] {
            const auto difference = first_difference(load(options->a), load(options->b));
            if (!difference) {
              std::puts("equal");
              return 0;
            }
            print("first difference at " + slam::format_stamp(difference->tick) + " s in " +
                  printable(difference->stage) + ": " + difference->what + "\n");
            return 1;
          }};
}

}  // namespace plumbline::scenarios
