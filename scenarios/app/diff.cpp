// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "bim/config/tree.h"
#include "scenarios/app/commands.h"
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
  line.option("A", options->a, "run directory").required();
  line.option("B", options->b, "run directory").required();
  line.footer("Example: plumbline diff runs/quickstart-1 runs/quickstart-1-changed\nExit code 1 when they differ");
  return {line, [options] {
            const auto difference = first_difference(load(options->a), load(options->b));
            if (!difference) {
              std::puts("equal");
              return 0;
            }
            std::printf("first difference at %s s in %s: %s\n", slam::format_stamp(difference->tick).c_str(),
                        difference->stage.c_str(), difference->what.c_str());
            return 1;
          }};
}

}  // namespace plumbline::scenarios
