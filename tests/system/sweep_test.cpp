// SPDX-License-Identifier: Apache-2.0
// A sweep that is killed at any moment goes on where it was. PLUMBLINE_SWEEP_KILLS: how often (ci/full: 10).
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "bim/config/tree.h"
#include "tests/system/program.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

constexpr const char* tables[] = {"table.txt", "table.csv", "table.html", "runs.csv", "sweep.sqlite"};

/// Starts a sweep and kills it after so many times 10 ms; false when it had ended before.
bool killed_after(const std::string& file, const std::string& out, int ticks) {
  Setting setting;
  setting.signal = SIGKILL;
  setting.kill_when = [ticks]() mutable { return --ticks < 0; };
  return plumbline({"sweep", file, "-o", out, "--jobs", "2"}, setting).code == 128 + SIGKILL;
}

TEST(Sweep, KilledAtAnyMomentItGivesTheSameTable) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const Folder folder;
  for (const char* name : {"short.yaml", "short.plan.yaml"})
    write_file(folder / name, read_file(project_file(std::string("tests/system/") + name)));
  const std::string sweep = folder / "sweep.yaml";
  write_file(sweep,
             "sweep: 1\nscenarios: [short.yaml]\nseeds: 3\nmethods: [odometry]\n"
             "variants: [{name: two, set: [duration_s=2]}, {name: three, set: [duration_s=3]}, "
             "{name: three untold, set: [duration_s=3, prior.yaw=unknown]}]\n");
  const char* asked = std::getenv("PLUMBLINE_SWEEP_KILLS");
  const int kills = asked == nullptr ? 3 : std::atoi(asked);
  int killed = 0;
  for (int i = 0; i < kills; ++i)
    if (killed_after(sweep, folder / "broken", 15 + (i * 61) % 90)) ++killed;
  EXPECT_GE(killed, 1);
  const Outcome resumed = plumbline({"sweep", sweep, "-o", folder / "broken", "--jobs", "2"});
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  const Outcome whole = plumbline({"sweep", sweep, "-o", folder / "whole", "--jobs", "1"});
  ASSERT_EQ(whole.code, 0) << whole.err;
  for (const char* table : tables) {
    const std::string bytes = read_file((folder / "whole") + "/" + table);
    EXPECT_FALSE(bytes.empty()) << table;
    EXPECT_TRUE(bytes == read_file((folder / "broken") + "/" + table)) << table;
  }
  EXPECT_FALSE(fs::exists((folder / "broken") + "/.work"));
  for (const char* out : {"broken", "whole"}) EXPECT_FALSE(fs::exists((folder / out) + "/.lock")) << out;
  EXPECT_EQ(std::distance(fs::directory_iterator((folder / "whole") + "/results"), fs::directory_iterator()), 9);
}

/// A sweep of six short runs on three walks.
std::string six_runs(const Folder& folder) {
  for (const char* name : {"short.yaml", "short.plan.yaml"})
    write_file(folder / name, read_file(project_file(std::string("tests/system/") + name)));
  write_file(folder / "sweep.yaml",
             "sweep: 1\nname: six\nscenarios: [short.yaml]\nseeds: 3\nmethods: [odometry]\n"
             "variants: [{name: told, set: [duration_s=2]}, {name: untold, set: [duration_s=2, prior.yaw=unknown]}]\n");
  return folder / "sweep.yaml";
}

TEST(Sweep, ShardsGiveTheTableOfTheWhole) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const Folder folder;
  const std::string sweep = six_runs(folder);
  ASSERT_EQ(plumbline({"sweep", sweep, "-o", folder / "whole"}).code, 0);
  const auto collect = [&] {
    return plumbline({"sweep", "collect", sweep, "--from", folder / "1", folder / "2", "-o", folder / "collected"});
  };
  ASSERT_EQ(plumbline({"sweep", sweep, "--shard", "1/2", "-o", folder / "1"}).code, 0);
  EXPECT_EQ(collect().code, 2);  // the second is not there
  const Outcome second = plumbline({"sweep", sweep, "--shard", "2/2", "-o", folder / "2"});
  ASSERT_EQ(second.code, 0) << second.err;
  EXPECT_NE(second.out.find("shard 2 of 2: 2 of 6 runs are there"), std::string::npos) << second.out;
  EXPECT_FALSE(fs::exists(folder / "2/table.txt"));
  const Outcome collected = collect();
  ASSERT_EQ(collected.code, 0) << collected.err;
  for (const char* table : tables)
    EXPECT_TRUE(read_file(folder / ("whole/" + std::string(table))) ==
                read_file(folder / ("collected/" + std::string(table))))
        << table;
  fs::remove(folder / "1/results/" / fs::directory_iterator(folder / "1/results")->path().filename());
  EXPECT_NE(collect().err.find("lack 1 of 6 runs"), std::string::npos);
  for (const char* wrong : {"0/2", "3/2", "1", "1/2x", "a/b", "-1/2", "1/0"})
    EXPECT_EQ(plumbline({"sweep", sweep, "--shard", wrong, "-o", folder / "no"}).code, 2) << wrong;
  EXPECT_FALSE(fs::exists(folder / "no"));
}

/// Whether a process is there and does something.
bool runs(const std::string& pid) {
  const std::string stat = "/proc/" + pid + "/stat";
  return fs::exists(stat) && read_file(stat).find(") Z ") == std::string::npos;
}

// A method that hangs, with a process of its own that outlives a killed one.
TEST(Sweep, LeavesNoMethodBehindWhateverEndsIt) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const Folder folder;
  (void)six_runs(folder);
  write_file(folder / "hangs.sh", "trap '' TERM\nsleep 300 3>&- &\necho $! > child\necho $$ > pid\nexec sleep 301\n");
  write_file(folder / "hang.yaml",
             "sweep: 1\nscenarios: [short.yaml]\nseeds: 1\n"
             "methods: [{name: hangs, command: [/bin/sh, hangs.sh], start_s: 200}]\n");
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    fs::remove(folder / "pid");
    Setting setting;
    setting.signal = signal;
    setting.kill_when = [&] { return !read_file(folder / "pid").empty(); };
    EXPECT_EQ(plumbline({"sweep", folder / "hang.yaml", "-o", folder / "out"}, setting).code, 128 + signal);
    const auto pid_in = [&](const std::string& name) {
      const std::string text = read_file(folder / name);
      return text.substr(0, text.find('\n'));
    };
    const std::string child = pid_in("child"), method = pid_in("pid");
    ASSERT_FALSE(method.empty());
    for (int i = 0; i < 200 && runs(method); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_FALSE(runs(method)) << signal;
    if (signal == SIGKILL)
      ::kill(std::stoi(child), SIGKILL);  // nobody is left to end it
    else
      EXPECT_FALSE(runs(child)) << signal;
  }
}

// With a stand-in for sbatch that runs what it is given at once, every task twice, as after the death of a node.
TEST(Sweep, SlurmGetsAnArrayAndACollector) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const Folder folder;
  const std::string sweep = six_runs(folder);
  fs::create_directory(folder / "bin");
  write_file(
      folder / "bin/sbatch",
      "#!/bin/bash\necho \"$@\" >>\"$CALLS\"\nscript=${!#}\n"
      "last=$(sed -n 's/^#SBATCH --array=0-\\([0-9]*\\).*/\\1/p' \"$script\")\n"
      "if [ -n \"$last\" ]; then for t in $(seq 0 $last) 0; do SLURM_ARRAY_TASK_ID=$t bash \"$script\" "
      ">/dev/null || exit 1; done\nelse bash \"$script\" >/dev/null || exit 1; fi\necho 4$(wc -l <\"$CALLS\")\n");
  write_file(folder / "bin/scontrol", "#!/bin/bash\necho 'MaxArraySize            = 3'\n");
  for (const char* name : {"bin/sbatch", "bin/scontrol"}) fs::permissions(folder / name, fs::perms::owner_all);
  Setting setting;
  setting.env["PATH"] = folder / "bin:/usr/bin:/bin";
  setting.env["CALLS"] = folder / "calls";
  const Outcome outcome =
      plumbline({"sweep", sweep, "--slurm", "--jobs", "2", "--runs-per-task", "2", "-o", folder / "out it"}, setting);
  ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  // Three walks, at most two tasks an array.
  const std::string shards = folder / "out it.shards/";
  EXPECT_NE(read_file(shards + "array.sbatch").find("--array=0-1%2\n"), std::string::npos);
  EXPECT_NE(read_file(shards + "array2.sbatch").find("--array=0-0%2\n"), std::string::npos);
  EXPECT_NE(read_file(shards + "array.sbatch").find("#SBATCH --requeue"), std::string::npos);
  EXPECT_NE(read_file(folder / "calls").find("--dependency=afterany:41:42 "), std::string::npos)
      << read_file(folder / "calls");
  ASSERT_EQ(plumbline({"sweep", sweep, "-o", folder / "whole"}).code, 0);
  for (const char* table : tables)
    EXPECT_TRUE(read_file(folder / ("whole/" + std::string(table))) == read_file((folder / "out it/") + table))
        << table;
  write_file(folder / "bin/sbatch", "#!/bin/bash\necho 'sbatch: error: no slurm.conf' >&2\nexit 1\n");
  const Outcome refused = plumbline({"sweep", sweep, "--slurm", "-o", folder / "in/refused"}, setting);
  EXPECT_EQ(refused.code, 3);
  EXPECT_NE(refused.err.find("without --slurm the sweep runs on this machine"), std::string::npos) << refused.err;
  EXPECT_FALSE(fs::exists(folder / "in"));
  setting.env["PATH"] = folder / "nothing";  // where Slurm is installed it would be found
  const Outcome none = plumbline({"sweep", sweep, "--slurm", "-o", folder / "none"}, setting);
  EXPECT_EQ(none.code, 3);
  EXPECT_NE(none.err.find("sbatch is not there"), std::string::npos) << none.err;
}

TEST(Sweep, LinksNoPageOfAnEarlierScenario) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const Folder folder;
  write_file(folder / "short.plan.yaml", read_file(project_file("tests/system/short.plan.yaml")));
  const auto links_after = [&](const std::string& speed, std::vector<std::string> more) {
    write_file(folder / "s.yaml",
               "scenario: 1\nname: s\nbuilding: short.plan.yaml\nstart: {room: left}\n"
               "duration_s: 2\nmethods: [odometry]\nspeed_mps: " +
                   speed + "\n");
    write_file(folder / "sweep.yaml", "sweep: 1\nscenarios: [s.yaml]\nseeds: 1\n");
    std::vector<std::string> arguments = {"sweep", folder / "sweep.yaml", "-o", folder / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = plumbline(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return read_file(folder / "out/table.html").find("pages/s-1/report.html") != std::string::npos;
  };
  EXPECT_TRUE(links_after("0.6", {"--page", "worst"}));
  EXPECT_TRUE(links_after("0.6", {}));
  EXPECT_FALSE(links_after("0.4", {}));
  EXPECT_TRUE(links_after("0.4", {"--page", "worst"}));
}

TEST(Sweep, ASharedWalkGivesWhatSingleRunsGive) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const Folder folder;
  write_file(folder / "short.plan.yaml", read_file(project_file("tests/system/short.plan.yaml")));
  const std::string walk = "scenario: 1\nname: s\nbuilding: short.plan.yaml\nstart: {room: left}\nduration_s: 3\n";
  const std::string methods = "methods: [odometry, s_graph_localization]\n";
  write_file(folder / "s.yaml", walk + methods);
  write_file(folder / "s_known.yaml", walk + methods + "prior: {yaw: known}\n");
  write_file(folder / "s_unknown.yaml", walk + methods + "prior: {yaw: unknown}\n");
  const std::string sweep = folder / "sweep.yaml";
  write_file(sweep,
             "sweep: 1\nscenarios: [s.yaml]\nseeds: 1\nfirst_seed: 5\n"
             "variants: [{name: known, set: [prior.yaw=known]}, {name: unknown, set: [prior.yaw=unknown]}]\n");
  ASSERT_EQ(plumbline({"sweep", sweep, "-o", folder / "out"}).code, 0);
  const auto result = [&](const std::string& name) { return folder / ("out/results/s-" + name + "-5.json"); };
  for (const std::string name : {"known", "unknown"}) {
    const Outcome one = plumbline({"run", folder / ("s_" + name + ".yaml"), "--seed", "5", "--out", folder / name});
    ASSERT_EQ(one.code, 0) << one.err;
    const Tree alone = read_json(read_file((folder / name) + "/results.json"), name);
    const Tree shared = read_json(read_file(result(name)), name);
    for (const char* key : {"digest", "duration_s", "distance_m", "methods"})
      EXPECT_EQ(write_json(*shared.find(key)), write_json(*alone.find(key))) << name << " " << key;
  }
  const std::string before = read_file(result("known"));
  EXPECT_NE(before, read_file(result("unknown")));
  const auto untouched = fs::last_write_time(result("unknown"));
  fs::remove(result("known"));
  ASSERT_EQ(plumbline({"sweep", sweep, "-o", folder / "out"}).code, 0);
  EXPECT_EQ(read_file(result("known")), before);
  EXPECT_EQ(fs::last_write_time(result("unknown")), untouched);
}

TEST(Sweep, BadInputIsOneLineAndLeavesNothing) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const Folder folder;
  write_file(folder / "sweep.yaml", "sweep: 1\nscenarios: [none.yaml]\n");
  const Outcome outcome = plumbline({"sweep", folder / "sweep.yaml", "-o", folder / "out"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("sweep.yaml:2:13"), std::string::npos) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
  EXPECT_FALSE(fs::exists(folder / "out"));

  write_file(folder / "short.yaml", read_file(project_file("tests/system/short.yaml")));
  write_file(folder / "short.plan.yaml", read_file(project_file("tests/system/short.plan.yaml")));
  const std::vector<std::pair<std::string, std::string>> mistakes = {
      {"starts: [{room: attic}]\n", "short: start {room: attic}, seed 1: "},
      {"variants: [{name: a, set: [prior.yw=known]}]\n", "sweep.yaml:3:12: "},
      {"variants: [{name: a, set: [seed=4]}]\n", "sweep.yaml:3:12: a sweep gives every run its seed"},
      {"variants: [{name: a, set: [building=b.yaml]}]\n", "sweep.yaml:3:12: a sweep's runs are in their scenario's"},
      {"starts: [{room: left}]\nvariants: [{name: a, set: [start.room=hall]}]\n",
       "the sweep sets 'start' by its starts"},
      {"methods: [odometry]\nvariants: [{name: a, set: ['methods=[vgicp]']}]\n", "the sweep sets 'methods' itself"}};
  for (const auto& [mistake, words] : mistakes) {
    write_file(folder / "sweep.yaml", "sweep: 1\nscenarios: [short.yaml]\n" + mistake);
    const Outcome refused = plumbline({"sweep", folder / "sweep.yaml", "--seeds", "1", "-o", folder / "out"});
    EXPECT_EQ(refused.code, 2) << refused.err;
    EXPECT_NE(refused.err.find(words), std::string::npos) << refused.err;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
    EXPECT_EQ(refused.err.find("/.work/"), std::string::npos) << refused.err;
    EXPECT_FALSE(fs::exists(folder / "out")) << mistake;
  }
}

/// One scenario that cannot be walked takes nothing from the others, and is told each time.
TEST(Sweep, OneScenarioThatIsRefusedLeavesTheOthersTheirTable) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const Folder folder;
  write_file(folder / "short.plan.yaml", read_file(project_file("tests/system/short.plan.yaml")));
  const std::string walk = "scenario: 1\nbuilding: short.plan.yaml\nmethods: [odometry]\n";
  write_file(folder / "good.yaml", walk + "name: good\nstart: {room: left}\nduration_s: 2\n");
  write_file(folder / "bad.yaml", walk + "name: bad\nstart: {room: attic}\nduration_s: 2\n");
  write_file(folder / "sweep.yaml", "sweep: 1\nscenarios: [bad.yaml, good.yaml]\nseeds: 2\n");
  const auto sweep = [&] { return plumbline({"sweep", folder / "sweep.yaml", "-o", folder / "out"}); };
  const Outcome first = sweep();
  EXPECT_EQ(first.code, 2);
  EXPECT_NE(first.err.find("sweep.yaml: 2 of 4 runs cannot be made; bad-1: "), std::string::npos) << first.err;
  EXPECT_NE(first.err.find("attic"), std::string::npos) << first.err;
  const std::string cut_short = "good: 2 of 2 walks cut short, the first: the walk ended when its time was up";
  EXPECT_NE(first.err.find("warning: " + cut_short), std::string::npos) << first.err;
  for (const char* table : tables) EXPECT_TRUE(fs::exists(folder / ("out/" + std::string(table)))) << table;
  const std::string rows = read_file(folder / "out/runs.csv");
  EXPECT_NE(rows.find("good,,,1,odometry,complete,"), std::string::npos) << rows;
  EXPECT_NE(rows.find("bad,,,1,odometry,failed,,,,refused: "), std::string::npos) << rows;
  for (const char* table : {"out/table.html", "out/table.txt"}) {
    const std::string text = read_file(folder / table);
    EXPECT_NE(text.find("bad: 2 of 2 walks failed, the first: refused: "), std::string::npos) << text;
    EXPECT_NE(text.find(cut_short), std::string::npos) << text;
  }
  const Outcome again = sweep();
  EXPECT_EQ(again.code, 2);
  EXPECT_EQ(again.out, first.out);
  EXPECT_EQ(read_file(folder / "out/runs.csv"), rows);

  // A part of the sweep says so, too, and the worst run is one that can be made.
  EXPECT_EQ(plumbline({"sweep", folder / "sweep.yaml", "--shard", "1/1", "-o", folder / "part"}).code, 2);
  EXPECT_EQ(
      plumbline({"sweep", "collect", folder / "sweep.yaml", "--from", folder / "part", "-o", folder / "all"}).code, 2);
  EXPECT_EQ(read_file(folder / "all/runs.csv"), rows);
  EXPECT_EQ(read_file(folder / "out/table.html").find("--page bad"), std::string::npos);
  EXPECT_EQ(plumbline({"sweep", folder / "sweep.yaml", "-o", folder / "out", "--page", "worst"}).code, 2);
  EXPECT_TRUE(fs::exists(folder / "out/pages/good-1/report.html") ||
              fs::exists(folder / "out/pages/good-2/report.html"));
}

/// Runs that share a walk: one that is refused takes nothing from the other.
TEST(Sweep, OneMethodThatCannotRunThereLeavesTheOthersOfItsWalk) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const Folder folder;
  std::string plan = read_file(project_file("tests/system/short.plan.yaml"));
  plan.erase(plan.find("\nrooms:"), plan.find("\nmaterials:") - plan.find("\nrooms:"));
  write_file(folder / "bare.plan.yaml", plan);
  write_file(folder / "s.yaml", "scenario: 1\nname: s\nbuilding: bare.plan.yaml\nduration_s: 2\nmethods: [odometry]\n");
  write_file(folder / "sweep.yaml",
             "sweep: 1\nscenarios: [s.yaml]\nseeds: 1\nvariants: [{name: slam, set: ['methods=[odometry]']}, "
             "{name: plan, set: ['methods=[s_graph_localization]']}]\n");
  EXPECT_EQ(plumbline({"sweep", folder / "sweep.yaml", "-o", folder / "out"}).code, 2);
  const std::string rows = read_file(folder / "out/runs.csv");
  EXPECT_NE(rows.find("s,slam,,1,odometry,complete,"), std::string::npos) << rows;
  EXPECT_NE(rows.find("s,plan,,1,s_graph_localization,failed,,,,\"refused: method "), std::string::npos) << rows;
}

/// A method that kills the program stands for what breaks it; the others of its walk stand, and it is tried no more.
TEST(Sweep, ARunThatBreaksTheProgramHasFailed) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const Folder folder;
  write_file(folder / "short.plan.yaml", read_file(project_file("tests/system/short.plan.yaml")));
  write_file(folder / "s.yaml",
             "scenario: 1\nname: s\nbuilding: short.plan.yaml\nduration_s: 2\nmethods: [odometry]\n");
  write_file(folder / "kills.sh", "echo once >>'" + (folder / "started") + "'\nkill -ABRT $PPID\nexec sleep 100\n");
  write_file(folder / "sweep.yaml",
             "sweep: 1\nscenarios: [s.yaml]\nseeds: 1\nvariants: [{name: good, set: ['methods=[odometry]']}, "
             "{name: bad, set: ['methods=[{name: kills, command: [/bin/sh, " +
                 (folder / "kills.sh") + "]}]']}]\n");
  const auto sweep = [&] { return plumbline({"sweep", folder / "sweep.yaml", "-o", folder / "out"}); };
  const Outcome first = sweep();
  EXPECT_EQ(first.code, 3) << first.out;
  EXPECT_NE(first.err.find("1 of 2 runs broke the program; s-bad-1: the program died of signal 6"), std::string::npos)
      << first.err;
  const std::string rows = read_file(folder / "out/runs.csv");
  EXPECT_NE(rows.find("s,good,,1,odometry,complete,"), std::string::npos) << rows;
  EXPECT_NE(rows.find("s,bad,,1,kills,failed,,,,the program died of signal 6"), std::string::npos) << rows;
  const std::string started = read_file(folder / "started");
  EXPECT_EQ(started, "once\nonce\n");  // with the other, then for itself
  EXPECT_EQ(sweep().code, 3);
  EXPECT_EQ(read_file(folder / "started"), started);
  EXPECT_EQ(read_file(folder / "out/runs.csv"), rows);
}

TEST(Sweep, ReplacesNoTablesOfAnother) {
  if (!available()) GTEST_SKIP() << "PLUMBLINE_BINARY and PLUMBLINE_SOURCE are not set; run through ctest";
  const Folder folder;
  fs::create_directories(folder / "out/results");
  write_file(folder / "out/results/other--1.json", "{}");
  write_file(folder / "out/table.csv", "rows of another");
  write_file(folder / "short.yaml", read_file(project_file("tests/system/short.yaml")));
  write_file(folder / "short.plan.yaml", read_file(project_file("tests/system/short.plan.yaml")));
  write_file(folder / "sweep.yaml", "sweep: 1\nscenarios: [short.yaml]\nseeds: 1\n");
  const Outcome outcome = plumbline({"sweep", folder / "sweep.yaml", "-o", folder / "out"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("holds the results of another sweep; name another --out"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(read_file(folder / "out/table.csv"), "rows of another");
}

}  // namespace
}  // namespace plumbline::system_tests
