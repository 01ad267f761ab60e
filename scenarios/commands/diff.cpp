// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "bim/config/tree.h"
#include "scenarios/commands/commands.h"
#include "scenarios/run/digest_log.h"
#include "slam/io/tum.h"

namespace plumbline::scenarios {

namespace {

DigestLog load(const std::string& dir) {
  const std::string path = dir + "/digests.csv";
  return read_digests(read_text_file(path), path);
}

}  // namespace

Command add_diff(CLI::App& program) {
  struct Options {
    std::string a, b;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* app = program.add_subcommand("diff", "Names the first stage and tick in which two runs differ");
  app->add_option("A", options->a, "run directory")->required();
  app->add_option("B", options->b, "run directory")->required();
  app->footer("Example: plumbline diff runs/quickstart-1 runs/quickstart-1-changed\nExit code 1 when they differ");
  return {app, [options] {
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
