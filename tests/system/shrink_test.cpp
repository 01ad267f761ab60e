// SPDX-License-Identifier: Apache-2.0
// A run whose gate on leg odometry fails, made as small as it can be.
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>

#include "bim/config/tree.h"
#include "tests/system/run_once.h"

namespace plumbline::system_tests {
namespace {

namespace fs = std::filesystem;

/// Files of the shrunk run that are the same bytes however it was made.
constexpr const char* files[] = {"scenario.yaml", "building.plan.yaml", "shrink.json", "run/results.json"};

class Shrink : public RunOnce<Shrink, 1> {
 public:
  static Outcome begin() {
    write_file(*folder_ / "short.plan.yaml", read_file(project_file("tests/system/short.plan.yaml")));
    write_file(*folder_ / "drifts.yaml",
               "scenario: 1\nname: drifts\nbuilding: short.plan.yaml\nstart: {room: left}\n"
               "route: {rooms: [hall, right]}\nduration_s: 6\npeople: [{rooms: [right]}]\n"
               "methods: [truth, odometry]\n"
               "gates: [{metric: ate_aligned_rmse_m, method: odometry, max: 0.001}]\n");
    return plumbline({"run", *folder_ / "drifts.yaml", "-o", run()});
  }
  static std::string run() { return *folder_ / "run"; }

  /// Shrinks it with as many runs as find what it needs.
  [[nodiscard]] static Outcome shrink(const std::string& out, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"shrink", run(), "-o", out, "--max-runs", "12"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return plumbline(arguments);
  }
};

TEST_F(Shrink, FindsWhatTheFailureNeedsAndFailsAgain) {
  const Outcome first = shrink(*folder_ / "small");
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("fails: odometry: ate_aligned_rmse_m is "), std::string::npos) << first.out;
  EXPECT_NE(first.out.find(
                "\nneeds: odometry.preset: noisy\ndoes not need: people 1, lidar.preset: real, prior.yaw: unknown\n"),
            std::string::npos)
      << first.out;
  EXPECT_NE(first.out.find("again: plumbline run "), std::string::npos);
  const Tree json = read_json(read_file(*folder_ / "small/shrink.json"), "shrink.json");
  const Tree &before = *json.find("before"), &after = *json.find("after");
  for (const char* size : {"duration_s", "distance_m", "methods", "elements"})
    EXPECT_LT(after.find(size)->as_double(), before.find(size)->as_double()) << size;
  EXPECT_LE(json.find("runs")->as_int(), 12);
  EXPECT_EQ(json.find("end")->as_string(), "max_runs");
  EXPECT_EQ(plumbline({"run", *folder_ / "small/scenario.yaml", "-o", *folder_ / "again"}).code, 1);
  EXPECT_EQ(read_file(*folder_ / "again/results.json"), read_file(*folder_ / "small/run/results.json"));
  EXPECT_FALSE(fs::exists(*folder_ / "small/.partial"));

  ASSERT_EQ(shrink(*folder_ / "with_two", {"--jobs", "2"}).code, 0);
  for (const char* file : files)
    EXPECT_TRUE(read_file(*folder_ / "small/" + std::string(file)) ==
                read_file(*folder_ / "with_two/" + std::string(file)))
        << file;
}

TEST_F(Shrink, KeepsWhatItIsToldToKeep) {
  const Outcome kept = shrink(*folder_ / "kept", {"--keep", "duration,ingredients,building", "--jobs", "2"});
  ASSERT_EQ(kept.code, 0) << kept.err;
  const Tree json = read_json(read_file(*folder_ / "kept/shrink.json"), "shrink.json");
  EXPECT_EQ(json.find("end")->as_string(), "smallest");
  EXPECT_EQ(json.find("before")->find("duration_s")->as_double(), json.find("after")->find("duration_s")->as_double());
  EXPECT_EQ(json.find("before")->find("elements")->as_int(), json.find("after")->find("elements")->as_int());
  EXPECT_EQ(json.find("after")->find("rooms")->as_int(), 1);
}

TEST_F(Shrink, InterruptedItLeavesTheSmallestSoFarOrNothing) {
  const std::string out = *folder_ / "stopped";
  Setting setting;
  setting.signal = SIGINT;
  bool second = false;  // while this is tried, the first has come to something
  setting.kill_when = [&] {
    const std::string tried = read_file(out + "/.partial/work/trial0/scenario.yaml");
    second = second || (tried.find("duration_s: 6") == std::string::npos && !tried.empty());
    return second;
  };
  const Outcome stopped = plumbline({"shrink", run(), "-o", out, "--jobs", "1"}, setting);
  EXPECT_EQ(stopped.code, 128 + SIGINT) << stopped.err;
  EXPECT_NE(stopped.err.find("scenario.yaml is the smallest so far"), std::string::npos) << stopped.err;
  const Tree json = read_json(read_file(out + "/shrink.json"), "shrink.json");
  EXPECT_EQ(json.find("end")->as_string(), "interrupted");
  EXPECT_NE(read_file(out + "/scenario.yaml").find("methods: [odometry]"), std::string::npos);
  EXPECT_FALSE(fs::exists(out + "/run"));
  EXPECT_FALSE(fs::exists(out + "/.partial"));
}

TEST_F(Shrink, InterruptedInItsLastRunItKeepsWhatItFound) {
  const std::string out = *folder_ / "nearly";
  Setting setting;
  setting.signal = SIGTERM;
  setting.kill_when = [&] { return fs::exists(out + "/.partial/run"); };
  const Outcome stopped = plumbline({"shrink", run(), "-o", out, "--max-runs", "1"}, setting);
  EXPECT_EQ(stopped.code, 128 + SIGTERM) << stopped.err;
  EXPECT_TRUE(fs::exists(out + "/scenario.yaml"));
  EXPECT_EQ(read_json(read_file(out + "/shrink.json"), "shrink.json").find("end")->as_string(), "interrupted");
  EXPECT_FALSE(fs::exists(out + "/run"));
  EXPECT_EQ(shrink(out, {"--force", "--keep", "duration,ingredients,building"}).code, 0);
  EXPECT_TRUE(fs::exists(out + "/run/results.json"));
}

TEST_F(Shrink, CarelessUseIsRefusedAndLeavesNothing) {
  const auto error = [&](const std::vector<std::string>& arguments) {
    const Outcome outcome = plumbline(arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    return outcome.err;
  };
  const std::string out = *folder_ / "none";
  fs::create_directory(*folder_ / "empty");
  EXPECT_NE(error({"shrink", *folder_ / "empty", "-o", out}).find("is no run directory"), std::string::npos);
  EXPECT_NE(error({"shrink", *folder_ / "nowhere", "-o", out}).find("no such directory"), std::string::npos);
  EXPECT_NE(error({"shrink", run(), "-o", out, "--method", "odometri"}).find("did you mean 'odometry'?"),
            std::string::npos);
  EXPECT_NE(error({"shrink", run(), "-o", out, "--method", "truth"}).find("'truth' does not fail in this run"),
            std::string::npos);
  EXPECT_NE(error({"shrink", run(), "-o", out, "--gate", "rooms.recall"}).find("no gate on 'rooms.recall'"),
            std::string::npos);
  (void)error({"shrink", run(), "-o", out, "--keep", "walls"});
  (void)error({"shrink", run(), "-o", out, "--max-runs", "0"});
  (void)error({"shrink", run()});
  EXPECT_NE(error({"shrink", run(), "-o", run(), "--force"}).find("no shrink writes"), std::string::npos);
  EXPECT_FALSE(fs::exists(out));
}

TEST_F(Shrink, AnOutsideEstimateCannotBeRunAgain) {
  fs::copy(run(), *folder_ / "outside", fs::copy_options::recursive);
  ASSERT_EQ(
      plumbline({"score", *folder_ / "outside", "--estimate", "mine=" + (*folder_ / "outside/odometry.tum")}).code, 1);
  write_file(*folder_ / "outside/results.json", [&] {
    std::string text = read_file(*folder_ / "outside/results.json");
    const std::string found = "\"mine\": {\n      \"verdict\": \"complete\"";
    return text.replace(text.find(found), found.size(), "\"mine\": {\n      \"verdict\": \"lost\"");
  }());
  const Outcome outside =
      plumbline({"shrink", *folder_ / "outside", "--method", "mine", "--unchecked", "-o", *folder_ / "none"});
  EXPECT_EQ(outside.code, 2);
  EXPECT_NE(outside.err.find("'mine' is an outside estimate"), std::string::npos) << outside.err;
}

TEST_F(Shrink, WhatDoesNotFailOrWasAlteredIsRefused) {
  const std::string good = *folder_ / "good";
  ASSERT_EQ(plumbline({"run", *folder_ / "drifts.yaml", "--method", "truth", "-o", good}).code, 0);
  const Outcome passes = plumbline({"shrink", good, "-o", *folder_ / "none"});
  EXPECT_EQ(passes.code, 2);
  EXPECT_NE(passes.err.find("does not fail: every verdict is good and no gate failed"), std::string::npos)
      << passes.err;

  // A building in which the same gate passes, as of a run of another build.
  fs::copy(run(), *folder_ / "altered", fs::copy_options::recursive);
  write_file(*folder_ / "altered/scenario.yaml",
             read_file(run() + "/scenario.yaml")
                 .replace(read_file(run() + "/scenario.yaml").find("preset: noisy"), 13, "preset: ideal"));
  const Outcome altered = plumbline({"shrink", *folder_ / "altered", "-o", *folder_ / "none"});
  EXPECT_EQ(altered.code, 2);
  EXPECT_NE(altered.err.find("scenario.yaml"), std::string::npos) << altered.err;
  const Outcome other = plumbline({"shrink", *folder_ / "altered", "--unchecked", "-o", *folder_ / "none"});
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("does not fail the same way when it is run again (the gate"), std::string::npos)
      << other.err;
  EXPECT_FALSE(fs::exists(*folder_ / "none"));
}

}  // namespace
}  // namespace plumbline::system_tests
