// SPDX-License-Identifier: Apache-2.0
#include "scenarios/compare/compared_builds.h"

#include <unistd.h>

#include <filesystem>
#include <system_error>
#include <vector>

#include "bim/config/input_file.h"
#include "bim/config/tree.h"
#include "bim/digest/digest.h"
#include "bim/errors.h"
#include "scenarios/host/files.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/host/terminal.h"
#include "scenarios/sweep/children.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

std::string program_digest(const std::string& path) { return hex64(Digest().add(read_text_file(path)).value()); }

/// OUT with the digests of its programs: a folder of another program is refused, not made anew, and sweeps of older
/// programs keep the runs of another build. What is made here goes with this object where no sweep was begun.
class BuildsFolder {
 public:
  explicit BuildsFolder(const ComparedBuilds& builds) : out_(builds.out), file_(builds.out + "/programs.json") {
    const Tree programs = Tree::map().set("a", program_digest(builds.a)).set("b", program_digest(builds.b));
    if (fs::exists(file_)) {
      const Tree known = read_json(read_text_file(file_), file_);
      for (const auto& [side, digest] : programs.as_map()) {
        const Tree* before = known.is_map() ? known.find(side) : nullptr;
        if (before == nullptr || before->as_string() != digest.as_string())
          throw InputError({out_ + "/" + side, 0, 0}, "is of another program; name another -o, or remove " + out_);
      }
      return;
    }
    for (const std::string& side : {a(), b()})
      if (fs::exists(side)) throw InputError({side, 0, 0}, "is of an unknown program; name another -o");
    made_ = make_folders(out_, out_);
    write_file(file_, write_json(programs) + "\n");
  }
  ~BuildsFolder() {
    std::error_code error;
    if (fs::exists(a(), error) || fs::exists(b(), error)) return;
    fs::remove(file_, error);
    for (auto it = made_.rbegin(); it != made_.rend(); ++it) fs::remove(*it, error);
  }
  BuildsFolder(const BuildsFolder&) = delete;
  BuildsFolder& operator=(const BuildsFolder&) = delete;

  [[nodiscard]] std::string a() const { return out_ + "/a"; }
  [[nodiscard]] std::string b() const { return out_ + "/b"; }

 private:
  std::string out_, file_;
  std::vector<std::string> made_;  ///< folders that were not there, outermost first
};

void sweep_with(const std::string& program, const ComparedBuilds& builds, const std::string& out) {
  print_note("plumbline: " + program + " runs " + builds.sweep + " into " + out);
  const auto arguments = [&](std::size_t) {
    std::vector<std::string> words = {"sweep", builds.sweep, "-o", out, "--jobs", std::to_string(builds.jobs)};
    if (builds.seeds > 0) words.insert(words.end(), {"--seeds", std::to_string(builds.seeds)});
    return words;
  };
  const auto ended = [&](std::size_t, const ChildEnd& end) {
    constexpr int bad_input = 2;
    if (end.code == 0) return;
    if (end.code == bad_input && fs::exists(out + "/runs.csv")) {  // a walk that cannot be made; the others are
      print_note("plumbline: warning: " + program + ": " + end.last_line);
      return;
    }
    if (end.code == bad_input) throw InputError({program, 0, 0}, "refuses the sweep: " + end.last_line);
    throw EnvironmentError(program + ": the sweep ended with " + std::to_string(end.code) + ": " + end.last_line);
  };
  fs::remove(out + "/runs.csv");  // of an earlier call; a sweep that gets as far writes it anew
  try {
    run_children(1, 1, arguments, ended, program);
  } catch (const Interrupted& interrupted) {
    throw Interrupted(interrupted.signal(), "the same command goes on");
  }
  if (!fs::exists(out + "/runs.csv")) throw InputError({program, 0, 0}, "made no sweep; name a plumbline program");
}

}  // namespace

bool is_program(const std::string& path) { return fs::is_regular_file(path) && ::access(path.c_str(), X_OK) == 0; }

std::pair<std::string, std::string> sweep_with_both(const ComparedBuilds& builds) {
  const BuildsFolder folder(builds);
  sweep_with(builds.a, builds, folder.a());
  sweep_with(builds.b, builds, folder.b());
  return {folder.a(), folder.b()};
}

}  // namespace plumbline::scenarios
