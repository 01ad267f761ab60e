// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bim/config/number_list.h"
#include "bim/config/printable.h"
#include "bim/config/schema.h"
#include "bim/errors.h"
#include "bim/model/rooms.h"
#include "bim/plan/plan.h"
#include "bim/random/stream.h"
#include "scenarios/app/commands.h"
#include "scenarios/app/degraded_recording.h"
#include "scenarios/app/estimate_command.h"
#include "scenarios/app/estimate_description.h"
#include "scenarios/app/lidar_height.h"
#include "scenarios/app/open_recording.h"
#include "scenarios/app/page_attempt.h"
#include "scenarios/app/recording_check.h"
#include "scenarios/app/recording_doubts.h"
#include "scenarios/app/recording_summary.h"
#include "scenarios/host/files.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/host/manifest.h"
#include "scenarios/host/progress.h"
#include "scenarios/host/terminal.h"
#include "scenarios/metrics/state_names.h"
#include "scenarios/report/estimate/estimate_page.h"
#include "scenarios/report/estimate/page_file.h"
#include "scenarios/report/estimate/plan_drawing.h"
#include "scenarios/run/method_runner.h"
#include "scenarios/run/run_files.h"
#include "scenarios/run/run_pipeline.h"
#include "scenarios/run/timings.h"
#include "scenarios/spec/method_names.h"
#include "scenarios/spec/named_places.h"
#include "scenarios/spec/resolve.h"
#include "scenarios/spec/run_site.h"
#include "slam/io/recordings/recording.h"
#include "slam/io/stopwatch.h"
#include "slam/methods.h"

namespace plumbline::scenarios {

namespace {

/// The method asked for, whose name may say .lidar as in a scenario.
MethodChoice find_choice(const EstimateArguments& options, slam::MethodTable table) {
  MethodChoice choice = choice_of(options.method);
  const Sensors asked = options.sensors == "lidar" ? Sensors::lidar : Sensors::all;
  if (options.sensors_option->given() && asked == Sensors::all && choice.sensors == Sensors::lidar)
    throw InputError({"--sensors", 0, 0}, "says all, and '" + options.method + "' LiDAR alone; give one of them");
  if (asked == Sensors::lidar) choice.sensors = asked;
  check_methods({choice.label()}, {Mark{"--method", 0, 0}}, table);
  if (choice.method == truth_method)
    throw InputError({"--method", 0, 0}, "'" + choice.method + "' is no estimator; a recording holds no truth");
  return choice;
}

/// The scenario that run and simulate leave beside a recording; of one from elsewhere, the default.
Scenario scenario_of(const std::string& recording) {
  namespace fs = std::filesystem;
  fs::path folder = fs::is_directory(recording) ? fs::path(recording) : fs::path(recording).parent_path();
  if (!folder.has_filename()) folder = folder.parent_path();  // of a closing slash
  const bool inner = folder.filename() == recording_folder && !fs::exists(folder / "scenario.yaml");
  const std::string path = ((inner ? folder.parent_path() : folder) / "scenario.yaml").string();
  return fs::exists(path) ? read_scenario(read_text_file(path), path).scenario : Scenario();
}

struct LoadedPlan {
  std::shared_ptr<const bim::Plan> plan;
  std::optional<Eigen::Vector3d> moved_by;  ///< see bim::Building
  std::optional<std::string> storey;        ///< that of the prior, as the plan calls it
  bool furnished = true;                    ///< it has furniture as planned, where there is any
  PlanDrawing drawing;                      ///< for the page
};

/// The plan, with the furniture that the run's methods were told of, or as --plan-furniture says. The storey that
/// --storey or else the recording names may be given by its name or its id.
LoadedPlan load_plan(const EstimateArguments& options, const slam::MethodRow& row, const slam::RecordingInfo& info) {
  if (!row.needs_plan) return {};
  if (options.plan.empty())
    throw InputError({"--plan", 0, 0}, "is required: method '" + options.method + "' localizes in a plan");
  Scenario scenario = scenario_of(options.input.recording);
  scenario.building_options = info.plan;
  scenario.world = {};
  const bool none = options.furniture_option->given() ? options.plan_furniture == names_of(ToldFurniture{}).front()
                                                      : scenario.plan.furniture == ToldFurniture::none;
  const RunBuilding building(load_site(options.plan, scenario), none ? ToldFurniture::none : ToldFurniture::as_planned);
  const auto plan = std::make_shared<bim::Plan>(*building.plan_as_planned());
  for (bim::PlanRoom& room : plan->rooms) room.name = bim::room_name(building.as_planned().rooms, room.name);
  LoadedPlan loaded{plan, building.as_planned().moved_by, {}, !none, plan_drawing(building.as_planned(), *plan)};
  const std::optional<std::string> named =
      options.storey.empty() ? slam::prior_of(info).storey : std::optional(options.storey);
  if (!named) return loaded;
  const int storey =
      find_storey(building.as_planned(), *named, {options.storey.empty() ? options.input.recording : "--storey", 0, 0});
  loaded.storey = loaded.plan->storeys[static_cast<std::size_t>(storey)].name;
  return loaded;
}

/// What only localization takes is refused elsewhere: who gives it expects poses in the plan.
void check_plan_options(const EstimateArguments& options, const slam::MethodRow& row) {
  if (row.needs_plan) return;
  const auto refuse = [&](const char* name) {
    throw InputError({name, 0, 0}, "is of methods that localize in a plan; '" + options.method + "' does not");
  };
  if (!options.plan.empty()) refuse("--plan");
  if (!options.storey.empty()) refuse("--storey");
  if (options.yaw_option->given()) refuse("--yaw-deg");
  if (options.furniture_option->given()) refuse("--plan-furniture");
}

/// Localization starts from rooms: without one on the storey of the prior, or anywhere, there is nothing to run.
void check_rooms(const EstimateArguments& options, const bim::Plan& plan, const slam::Prior& prior) {
  const auto starts_here = [&](const bim::PlanRoom& room) {
    return !prior.storey || plan.storeys[static_cast<std::size_t>(room.storey)].name == *prior.storey;
  };
  if (std::any_of(plan.rooms.begin(), plan.rooms.end(), starts_here)) return;
  throw InputError({options.plan, 0, 0}, "has no rooms" +
                                             (prior.storey ? " on storey '" + *prior.storey + "'" : std::string()) +
                                             ", and method '" + options.method + "' starts from rooms; add rooms");
}

/// The prior of the recording, with that of the command line over it.
slam::Prior make_prior(const EstimateArguments& options, const slam::RecordingInfo& info, const LoadedPlan& loaded) {
  slam::Prior prior = slam::prior_of(info);
  if (options.yaw_option->given()) prior.yaw_W = wrap_angle(options.yaw_deg * std::numbers::pi / 180.0);
  prior.storey = loaded.storey;
  return prior;
}

/// Every value of the method's config: those of --config over the defaults.
Tree make_config(const EstimateArguments& options, const slam::MethodRow& row) {
  if (options.config.empty()) return row.configure ? row.configure({}) : Tree();
  if (!row.configure) throw InputError({"--config", 0, 0}, "method '" + options.method + "' has no values to set");
  return row.configure(read_yaml(read_text_file(options.config), options.config));
}

std::uint64_t run_seed(const EstimateArguments& options, const slam::RecordingInfo& info) {
  return options.seed_option->given() ? options.seed : info.seed.value_or(options.seed);
}

/// loaded: the plan, where the method needs one.
slam::MethodInput make_input(const EstimateArguments& options, const slam::MethodRow& row,
                             const slam::Recording& recording, LoadedPlan& loaded) {
  const slam::RecordingInfo& info = recording.info();
  slam::MethodInput input;
  input.config = make_config(options, row);
  input.has_odometry = recording.has_odometry();  // MethodRunner keeps it back where LiDAR alone is asked for
  if (row.needs_odometry && !input.has_odometry)
    throw InputError({options.input.recording, 0, 0},
                     "holds no odometry, which method '" + options.method +
                         "' needs; --odometry gives it, and vgicp and s_graphs_plus do without");
  input.seed = method_seed(run_seed(options, info), seed_name(row));
  input.calibration = slam::calibration_of(info);
  loaded = load_plan(options, row, info);
  input.plan = loaded.plan;
  if (input.plan) {
    input.prior = make_prior(options, info, loaded);
    check_rooms(options, *input.plan, input.prior);
  }
  return input;
}

struct Answer {
  MethodRecord record;  ///< on the recording's own clock
  ScansRead scans;
  double recorded_s = 0.0;          ///< from the first scan to the last
  std::vector<std::string> doubts;  ///< of the records that the method got
};

Answer run_method(slam::Recording& recording, const slam::MethodRow& row, const slam::MethodInput& input,
                  Sensors sensors) {
  Progress progress(std::string(row.name), {});
  std::optional<slam::Nanoseconds> first;
  slam::Nanoseconds last = 0;
  RecordingDoubts doubts;
  const SensorSource source = [&](slam::SensorFrame& frame) {
    if (!recording.next(frame)) return false;
    last = frame.scan.stamp;
    if (!first) first = last;
    doubts.add(frame);
    progress.at(slam::seconds(last - *first));
    return true;
  };
  std::vector<std::unique_ptr<MethodRunner>> methods;
  methods.push_back(std::make_unique<MethodRunner>(row, input, sensors));
  Answer answer;
  answer.record = std::move(run_pipeline(source, std::move(methods), {}).front());
  answer.scans = doubts.scans();
  answer.recorded_s = slam::seconds(last - first.value_or(last));
  answer.doubts =
      doubts.warnings(answer.record, input.calibration.X_RL.q, recording.has_odometry() && sensors == Sensors::all);
  shift_times(answer.record, recording.origin());
  return answer;
}

/// What the command line gives, before anything is read of the recording.
EstimateDescription describe_given(const EstimateArguments& options, const slam::MethodRow& row,
                                   const LoadedPlan& loaded, const slam::MethodInput& input) {
  EstimateDescription description;
  description.method = row.name;
  description.recording = name_of_path(options.input.recording);
  if (loaded.plan) {
    description.plan = name_of_path(options.plan);
    description.plan_furniture = loaded.furnished ? "as_planned" : "none";
    description.plan_moved_by = loaded.moved_by;
    for (std::size_t i = 0; i < loaded.plan->storeys.size(); ++i)
      if (loaded.storey == loaded.plan->storeys[i].name) description.storey = loaded.drawing.plan.storeys[i].name;
  }
  const bool has_config =
      !options.config.empty() && row.configure && write_yaml(input.config) != write_yaml(row.configure({}));
  description.command = repeating_command(options, has_config);
  return description;
}

/// The table with the process that --method gives, if it does.
std::optional<ProcessTable> take_process(EstimateArguments& options, slam::MethodTable table) {
  std::optional<ProcessSpec> process = process_of(options.method, std::filesystem::current_path().string());
  if (!process) return std::nullopt;
  check_program(process->command, *process->folder, {"--method", 0, 0});
  process->plan = !options.plan.empty();
  options.method = process->name;
  options.is_process = true;
  return ProcessTable(table, {*process}, {Mark{"--method", 0, 0}});
}

void warn_of_moved_plan(const EstimateArguments& options, const LoadedPlan& loaded,
                        std::vector<std::string>& warnings) {
  if (!loaded.moved_by) return;
  const std::string said = "coordinates are those of a map; poses are in W, to which it is moved by " +
                           flow_text(number_list(*loaded.moved_by)) + " m";
  print_note("plumbline: warning: " + options.plan + ": its " + said);
  warnings.push_back("the plan's " + said);
}

/// Prints what to know of the recording that has been read, and adds to the warnings what estimate.yaml has not
/// elsewhere.
void warn_of_recording(const EstimateArguments& options, const slam::Recording& recording,
                       const std::vector<std::string>& doubts, std::vector<std::string>& warnings) {
  std::vector<std::string> all = warnings_of(recording);
  const std::size_t elsewhere = recording.left_out().size() + recording.assumed().size();
  all.insert(all.end(), doubts.begin(), doubts.end());
  for (const std::string& said : all) print_note("plumbline: warning: " + options.input.recording + ": " + said);
  warnings.insert(warnings.end(), all.begin() + static_cast<std::ptrdiff_t>(elsewhere), all.end());
}

/// Writes all but the timings and the page.
void write_answer(const std::string& dir, const MethodRecord& record, const LoadedPlan& loaded,
                  const std::string& description) {
  write_method(dir, record);
  write_file(dir + "/digests.csv", write_digests(record.digests));
  write_file(dir + "/estimate.yaml", description);
  if (loaded.plan) write_file(dir + "/" + std::string(plan_drawing_name), write_plan_drawing(loaded.drawing));
}

void print_answer(const EstimateArguments& options, const slam::Recording& recording, const slam::MethodInput& input,
                  HeightSource height, const Answer& answer, bool has_page) {
  const MethodRecord& record = answer.record;
  print(words_of(recording.taken(), answer.scans, recording.has_odometry()) + "\n");
  if (height != HeightSource::description)
    std::printf("LiDAR %.2f m above the floor, %s; --description gives it\n", input.calibration.sensor_height_m,
                height == HeightSource::scans
                    ? "by the first scans that show it"
                    : "as of the simulated robot, since the scans of half a minute show no floor");
  print(printable(options.out) + "/" + record.name + ".tum: " + std::to_string(record.causal.size()) + " poses\n");
  if (record.lost_scans > 0) std::printf("LOST at %d of %d scans\n", record.lost_scans, record.scans);
  if (!record.beliefs.empty())
    std::printf("%s at the end, %zu hypotheses\n", std::string(state_name(record.beliefs.back().state)).c_str(),
                record.beliefs.back().hypotheses.size());
  if (has_page) print("report: " + printable(options.out) + "/" + std::string(estimate_page_name) + "\n");
}

int estimate(EstimateArguments options, slam::MethodTable table) {
  const double start_s = slam::wall_s();
  const std::optional<ProcessTable> own = take_process(options, table);
  if (own) table = own->table();
  const MethodChoice choice = find_choice(options, table);
  const slam::MethodRow& row = *row_of(choice.method, table);
  check_plan_options(options, row);
  const Degradation degradation = options.degradation.value();
  const AlteredRecording altered = altered_in_recording(options.input.recording);
  refuse_altered(altered.folder, altered.files, options.unchecked);
  options.input.topics.point_times = !degradation.no_times;
  const std::unique_ptr<slam::Recording> recording = degraded(open_any_recording(options.input), degradation);
  LoadedPlan loaded;
  slam::MethodInput input = make_input(options, row, *recording, loaded);
  EstimateDescription description = describe_given(options, row, loaded, input);
  warn_of_moved_plan(options, loaded, description.warnings);
  description.height = find_height(options, degradation, recording->info(), input, description.warnings);
  description.seed = run_seed(options, recording->info());
  description.sensors = choice.sensors;
  description.degradation = degradation;
  description.altered = altered.files;

  catch_interrupts();
  RunDirectory directory(options.out, DirectoryKind::estimate, options.force);
  const Answer answer = run_method(*recording, row, input, choice.sensors);
  warn_of_recording(options, *recording, answer.doubts, description.warnings);
  warn_of_height(options, description.height, input.calibration.sensor_height_m, answer.record, description.warnings);
  description.scans = answer.scans;
  write_answer(directory.staging(), answer.record, loaded, describe(description, *recording, input));
  const bool paged = attempt_page(options.out, directory.staging(), [&] { write_estimate_page(directory.staging()); });
  write_file(
      directory.staging() + "/timings.json",
      write_timings({}, {answer.record}, {slam::wall_s() - start_s, slam::process_cpu_s(), answer.recorded_s, 1}));
  directory.commit();
  if (answer.record.crashed) {
    print_note("plumbline: method '" + answer.record.name + "' crashed: " + answer.record.error);
    return 1;
  }
  print_answer(options, *recording, input, description.height, answer, paged);
  return 0;
}

}  // namespace

Command add_estimate(CommandLine& program, slam::MethodTable table) {
  const auto options = std::make_shared<EstimateArguments>();
  CommandLine line = program.add_command("estimate", "Runs a method on a recording, simulated or real");
  line.option("RECORDING", options->input.recording,
              "directory written by simulate or run --record, capture of a Velodyne LiDAR (.pcap), bag of ROS 1 (.bag) "
              "or ROS "
              "2 (.mcap, .db3, rosbag2 folder), or folder of point clouds (.pcd, .ply or KITTI's .bin)")
      .required();
  line.option("--description", options->input.description,
              "a recording.yaml with the LiDAR's mount, for a capture or bag, which has none");
  line.option("--points-topic", options->input.topics.points, "of a bag [the first PointCloud2 or Livox CustomMsg]");
  line.option("--odometry-topic", options->input.topics.odometry, "of a bag [the first Odometry]");
  line.option("--imu-topic", options->input.topics.imu, "of a bag [the first Imu]");
  line.option("--odometry", options->input.motion.odometry,
              "poses of the robot, of a recording without odometry: TUM, EuRoC, or KITTI's, one for each scan "
              "[odometry.tum beside clouds]");
  line.option(
      "--imu", options->input.motion.imu,
      "imu.csv of a recording without an IMU, or EuRoC's data.csv, in the robot's frame [imu.csv beside clouds]");
  line.option("--method", options->method, "one of plumbline methods, or NAME=COMMAND: a process of your own")
      .takes("METHOD")
      .required();
  options->sensors_option =
      line.option("--sensors", options->sensors,
                  "what the method gets: all records, or lidar, without odometry and IMU; names its files NAME.lidar "
                  "[all]")
          .one_of({"all", "lidar"});
  options->degradation.declare(line);
  line.option("--plan", options->plan, "building, for methods that localize in a plan");
  options->furniture_option =
      line.option("--plan-furniture", options->plan_furniture,
                  "what the plan has of what may have moved: none or as_planned [the run's, else as_planned]")
          .one_of({"none", "as_planned"});
  line.option("--config", options->config,
              "parameters of the method (YAML); plumbline methods --config NAME prints them");
  line.option("-o,--out", options->out, "directory to write; its report.html shows what came out")
      .takes("DIR")
      .required();
  options->seed_option = line.seed("--seed", options->seed, "seed of the run [the recording's, else 1]");
  options->yaw_option = line.option("--yaw-deg", options->yaw_deg,
                                    "compass: heading in the plan at the start [the recording's, else unknown]")
                            .range(-360.0, 360.0);
  line.option("--storey", options->storey, "storey of the start [the recording's, else unknown]");
  line.flag("--force", options->force, "replace the estimate that stands in --out");
  line.flag("--unchecked", options->unchecked,
            "takes a recording whose files were altered since they were written; estimate.yaml names them");
  line.footer(
      "Example: plumbline estimate walk --method s_graphs_plus -o out\n"
      "         plumbline estimate walk --method s_graph_localization --plan house.plan.yaml -o out\n"
      "         plumbline estimate walk --method vgicp --sensors lidar -o out\n"
      "         plumbline estimate walk --method vgicp --every 5 --without rings,times -o out\n"
      "         plumbline estimate vlp16.pcap --method vgicp -o out");
  return {line, [options, table] { return estimate(*options, table); }};
}

}  // namespace plumbline::scenarios
