// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bim/config/printable.h"
#include "bim/config/tree.h"
#include "scenarios/app/commands.h"
#include "scenarios/app/estimate_score.h"
#include "scenarios/host/files.h"
#include "scenarios/host/manifest.h"
#include "scenarios/host/terminal.h"
#include "scenarios/run/digest_log.h"
#include "scenarios/score/moment.h"
#include "slam/io/recordings/tum.h"

namespace plumbline::scenarios {

namespace {

DigestLog load(const std::string& dir) {
  const std::string path = dir + "/digests.csv";
  if (!std::filesystem::exists(path))
    throw InputError({dir, 0, 0}, "holds no digests.csv; name a directory that plumbline run or estimate wrote");
  return read_digests(read_text_file(path), path);
}

/// Digests are of what was computed: files that were altered since may differ although they are equal.
void note_altered(const std::string& directory) {
  const std::vector<std::string> made_again =
      is_estimate_directory(directory) ? derived_files() : std::vector<std::string>{"score.json"};
  std::string names;
  if (std::filesystem::exists(directory + "/" + std::string(manifest_name)))
    for (const std::string& name : altered_files(directory, {made_again, false}))
      names += (names.empty() ? "" : ", ") + name;
  if (names.empty()) return;
  print_note("plumbline: warning: " + directory + ": altered since they were written: " + names +
             "; only digests.csv is compared");
}

/// The page of A with that of B beside it, at the time at which they differ; nothing where one of them has none.
std::string where_to_look(const std::string& a, const std::string& b, slam::Nanoseconds tick) {
  namespace fs = std::filesystem;
  if (!fs::exists(a + "/replay.html") || !fs::exists(b + "/replay.html")) return "";
  const std::string other = fs::absolute(b).lexically_normal().lexically_relative(fs::absolute(a).lexically_normal());
  return "look: " + printable(a) + "/replay.html#t=" + format_number(score::rounded_up(slam::seconds(tick), 100.0)) +
         "&with=" + score::in_link(other) + "/replay.html\n";
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
            for (const std::string& directory : {options->a, options->b}) note_altered(directory);
            const auto difference = first_difference(load(options->a), load(options->b));
            if (!difference) {
              std::puts("equal");
              return 0;
            }
            print("first difference at " + slam::format_stamp(difference->tick) + " s in " +
                  printable(difference->stage) + ": " + difference->what + "\n" +
                  where_to_look(options->a, options->b, difference->tick));
            return 1;
          }};
}

}  // namespace plumbline::scenarios
