// SPDX-License-Identifier: Apache-2.0
#include "scenarios/host/files.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "bim/config/descriptor.h"
#include "bim/errors.h"
#include "scenarios/host/manifest.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view staging_name = ".partial";

[[noreturn]] void fail(const std::string& path, const std::string& what, int error) {
  throw EnvironmentError(path + ": " + what + ": " + std::strerror(error));
}

void sync_directory(const std::string& path) {
  const Descriptor dir(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (dir.get() >= 0) static_cast<void>(::fsync(dir.get()));
}

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() > end.size() && text.substr(text.size() - end.size()) == end;
}

std::vector<std::string> names_in(const std::string& path) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(path, error), end; !error && it != end; it.increment(error))
    names.push_back(it->path().filename().string());
  if (error) fail(path, "cannot be listed", error.value());
  std::sort(names.begin(), names.end());
  return names;
}

std::string temporary_of(const std::string& path) { return path + ".tmp"; }

/// Writes a file beside its place, whole and on the disk.
void write_beside(const std::string& path, std::string_view bytes) {
  Descriptor file(::open(temporary_of(path).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (file.get() < 0) fail(path, "cannot be written", errno);
  if (!write_all(file.get(), bytes)) fail(path, "cannot be written", errno);
  if (::fsync(file.get()) != 0 && errno != EINVAL) fail(path, "cannot be written", errno);
  if (file.close_now() != 0) fail(path, "cannot be written", errno);
}

}  // namespace

void write_file(const std::string& path, std::string_view bytes) { write_files({{path, bytes}}); }

void require_replaceable(const std::string& path) {
  std::error_code unknown;
  const fs::file_status there = fs::symlink_status(path, unknown);
  if (fs::exists(there) && !fs::is_regular_file(there) && !fs::is_symlink(there))
    throw InputError({path, 0, 0}, "is no file that could be replaced; give another name");
}

void write_files(const std::vector<FileBytes>& files) {
  for (const FileBytes& file : files) require_replaceable(file.path);
  try {
    for (const FileBytes& file : files) write_beside(file.path, file.bytes);
    for (const FileBytes& file : files)
      if (::rename(temporary_of(file.path).c_str(), file.path.c_str()) != 0)
        fail(file.path, "cannot be written", errno);
  } catch (...) {
    for (const FileBytes& file : files) ::unlink(temporary_of(file.path).c_str());
    throw;
  }
}

namespace {

constexpr std::string_view method_name = "<method>", building_start = "building.";

constexpr std::array<FileRow, 20> run_files = {{
    {"report.html", "the report: maps, errors over time, verdicts, gates; it loads nothing from elsewhere", true, true},
    {"replay.html",
     "with `--replay`, `report --3d` or a failed gate: the run in three dimensions at any of its times, in one file",
     true, true},
    {"results.json",
     "scores and gates; it appears last, so that its directory is complete. `building.moved_by_m`: added to the "
     "coordinates of a building in map coordinates; `shift_ns`: added to the stamps of an outside estimate, ns",
     true, true},
    {"junit.xml", "gates and methods as JUnit test cases", true, true},
    {"<method>.tum",
     "the causal trajectory: each pose as first given, one a scan; SLAM scores use it; X_MR of SLAM, X_WR of a "
     "localization",
     false},
    {"<method>.final.tum", "the trajectory after the last optimisation", false},
    {"<method>.map.ply", "the map: x, y, z as float32, m; in M of SLAM, in W of a localization", false},
    {"<method>.map.pcd", "the same map in PCD format", false},
    {"<method>.estimate.json", "planes, rooms, floors, loop closures and the planes of some scans, in the map's frame",
     false},
    {"<method>.hypotheses.jsonl",
     "of a localization, a line for each scan: pose hypotheses with shares and covariances, state, particles", false},
    {"<method>.graph.json", "of a graph method: keyframes, planes, rooms, floors and factors", false},
    {"truth.tum", "X_WR: true poses of R in the plan's frame W, at 100 Hz and at every scan", false},
    {"truth_surface.ply", "points of the building that true returns hit, one per voxel of 0.1 m, in W, m"},
    {"scenario.yaml", "the resolved scenario; `run` of this file, or `replay`, repeats the run"},
    {"building.*", "the building that the scenario names", false},
    {"digests.csv", "a digest for each stage and scan; `diff` and `replay` compare them"},
    {"timings.json", "CPU time of each stage; the only file that differs between repetitions"},
    {"failure.txt", "why the scenario ended early, where it did"},
    {manifest_name, "a digest of every file as it was written; `score`, `report` and `replay` compare them", false},
    {recording_folder, "with `--record`: the sensor data of the run, as `simulate` writes it"},
}};

constexpr std::array<FileRow, 12> recording_files = {{
    {"lidar.pcap", "the LiDAR's packets as the sensor sends them, with nanosecond stamps; not of an `os1_64`"},
    {"odometry.tum", "X_OR: pose of R in the odometry frame O, `t x y z qx qy qz qw`"},
    {"odometry_covariance.csv",
     "header, then time and the upper triangle, row by row, of the 6 x 6 covariance of the motion since the record "
     "before: right increment (x, y, z, rotation about x, y, z) in R, m and rad"},
    {"imu.csv",
     "header, then `t,wx,wy,wz,ax,ay,az`: s, rad/s, m/s²; angular velocity and specific force in R, so (0, 0, 9.81) at "
     "rest and level"},
    {"recording.yaml",
     "the LiDAR's mount, packets per scan, seed, digest of the sensor data, and the prior of localization"},
    {"recording.bag", "the same data as a ROS 1 bag (LZ4), with `--bag`"},
    {"recording.mcap", "the same data as ROS 2 records it (MCAP), with `--mcap`"},
    {"rosbag2", "the same data as ROS 2 records it (SQLite and metadata.yaml), with `--rosbag2`"},
    {"truth.tum", "true poses; `estimate` does not read them"},
    {manifest_name, "a digest of every file as it was written; `estimate` compares those that it reads", false},
    {"scenario.yaml", "the resolved scenario"},
    {"building.*", "the building that the scenario names", false},
}};

constexpr std::array<FileRow, 15> estimate_files = {{
    {"report.html",
     "the page: answer, path on the plan or the map, states and hypotheses over time, what to know of the recording; "
     "it "
     "loads nothing from elsewhere; `score` and `report` write it again",
     false, true},
    {manifest_name, "a digest of every file as it was written; `score` and `report` compare them", false},
    {"estimate.yaml",
     "the recording, method and seed of the estimate, which `score` compares with the run; under `input` what was "
     "read, under `left_out` what was not, under `assumed` what its numbers were taken to mean, under `warnings` what "
     "else was printed of it, under `given` names, prior and the command that makes it again, `plan_moved_by_m` what "
     "was added to the coordinates of a plan in map coordinates, under `unchecked` files of the "
     "recording that had been altered"},
    {"plan.json",
     "of a localization: walls, rooms, furniture and stairs of its plan as `report.html` draws them, m in W", false},
    {"reference.tum",
     "with `score --reference`: the reference as it was compared, in its own world frame, its axes those of the robot",
     false, true},
    {"score.json",
     "with `score`: path, share of the scans at which the method reported LOST, errors by a reference, and how soon it "
     "reported LOST; under `localization` and `verdict` what a reference in the plan's frame (`frame=W`) says",
     true, true},
    {"<method>.tum", "the causal trajectory; X_MR of SLAM, X_WR of a localization", false},
    {"<method>.final.tum", "the trajectory after the last optimisation", false},
    {"<method>.map.ply", "the map: x, y, z as float32, m; in M of SLAM, in W of a localization", false},
    {"<method>.map.pcd", "the same map in PCD format", false},
    {"<method>.estimate.json", "planes, rooms, floors, loop closures and the planes of some scans", false},
    {"<method>.hypotheses.jsonl", "of a localization: pose hypotheses after each scan", false},
    {"<method>.graph.json", "of a graph method: keyframes, planes, rooms, floors and factors", false},
    {"digests.csv", "a digest for each stage and scan"},
    {"timings.json", "CPU time of each stage"},
}};

constexpr std::array<FileRow, 7> sweep_files = {{
    {"runs.csv", "a row for each run and method"},
    {"table.txt", "a row for each scenario, variant, start and method, over all seeds"},
    {"table.csv", "the same rows for programs"},
    {"table.html", "the same rows as a page"},
    {"sweep.sqlite", "runs and rows as tables of a database"},
    {"results", "a file for each run; a sweep that continues keeps them"},
    {"pages", "with --page: a run directory for each run asked for", false},
}};

constexpr std::array<FileRow, 5> shrink_files = {{
    {"scenario.yaml", "the smallest scenario that fails the same way", false},
    {"building.*", "the building that it names", false},
    {"run", "the run directory of that scenario; not after an interruption", false},
    {"shrink.json",
     "`failure`: what fails; `before` and `after`: sizes of the run; `needs` and `does_not_need`: its ingredients; "
     "`steps`: what was tried, in order, and whether it was kept; `end`: `smallest`, `max_runs` or `interrupted`"},
    {manifest_name, "a digest of every file as it was written", false},
}};

constexpr std::array<FileRow, 4> hunt_files = {{
    {"hunt.csv", "a row for each run and method: what was drawn, verdict, whose fault and why, badness"},
    {"hunt.json",
     "`findings`: kinds of failure that are a method's fault, the severest first; `not_the_methods_fault`: counts of "
     "others by reason"},
    {"failures", "for each finding a folder NN with scenario.yaml and building; with `--shrink` also run and small",
     false},
    {manifest_name, "a digest of every file as it was written", false},
}};

/// Which names a directory may hold.
struct DirectoryNames {
  std::string_view what;
  std::span<const FileRow> rows;

  /// True for a name that makes the directory one of this kind.
  [[nodiscard]] bool names(std::string_view name) const {
    return std::any_of(rows.begin(), rows.end(), [&](const FileRow& row) { return row.mark && row.name == name; });
  }
  [[nodiscard]] bool may_hold(std::string_view name) const {
    const auto fits = [&](const FileRow& row) {
      if (row.name.starts_with(method_name)) return ends_with(name, row.name.substr(method_name.size()));
      return row.name == name || (row.name.starts_with(building_start) && name.starts_with(building_start));
    };
    return name == staging_name || names(name) || std::any_of(rows.begin(), rows.end(), fits);
  }
};

DirectoryNames names_of(DirectoryKind kind) {
  static constexpr std::array<std::string_view, 6> whats = {"run", "recording", "estimate", "sweep", "shrink", "hunt"};
  return {whats[static_cast<std::size_t>(kind)], files_of(kind)};
}

}  // namespace

std::span<const FileRow> files_of(DirectoryKind kind) {
  static constexpr std::array<std::span<const FileRow>, 6> rows = {run_files,   recording_files, estimate_files,
                                                                   sweep_files, shrink_files,    hunt_files};
  return rows[static_cast<std::size_t>(kind)];
}

std::vector<std::string> derived_files() {
  std::vector<std::string> names;
  for (const DirectoryKind kind : {DirectoryKind::run, DirectoryKind::estimate})
    for (const FileRow& row : files_of(kind))
      if (row.derived && std::find(names.begin(), names.end(), row.name) == names.end()) names.emplace_back(row.name);
  return names;
}

bool is_file_of(DirectoryKind kind, std::string_view name) {
  return name.find('/') == std::string_view::npos && names_of(kind).may_hold(name);
}

std::vector<std::string> make_folders(const std::string& path, const std::string& named) {
  std::vector<std::string> missing, made;
  std::error_code error;
  for (fs::path p = fs::path(path); !p.empty() && !fs::exists(p, error); p = p.parent_path()) {
    if (fs::is_symlink(fs::symlink_status(p, error)))
      throw InputError({p.string(), 0, 0}, "is a link to '" + fs::read_symlink(p, error).string() +
                                               "', which does not exist; name another --out");
    missing.push_back(p.string());
  }
  std::reverse(missing.begin(), missing.end());
  for (const std::string& folder : missing) {
    if (!fs::create_directory(folder, error) && error) {
      for (auto it = made.rbegin(); it != made.rend(); ++it) ::rmdir(it->c_str());
      fail(named, "cannot be created", error.value());
    }
    made.push_back(folder);
  }
  return made;
}

namespace {

std::string staging_of(const std::string& path) { return (fs::path(path) / staging_name).string(); }

std::string lock_in(const std::string& staging) { return staging + "/lock"; }

}  // namespace

bool remove_abandoned(const std::string& directory) noexcept {
  try {
    const std::string staging = staging_of(directory);
    std::error_code error;
    if (!fs::is_regular_file(lock_in(staging), error)) return false;
    const std::optional<FolderLock> lock = FolderLock::take(lock_in(staging), directory);
    if (lock) fs::remove_all(staging, error);
    return lock && !error;
  } catch (const std::exception&) {  // no place of ours to tidy
    return false;
  }
}

std::vector<std::string> unfinished_in(const std::string& folder) {
  std::vector<std::string> found;
  std::error_code error;
  if (fs::is_regular_file(lock_in(staging_of(folder)), error)) found.push_back(folder);
  constexpr auto skip = fs::directory_options::skip_permission_denied;
  for (fs::recursive_directory_iterator at(folder, skip, error), end; !error && at != end; at.increment(error)) {
    if (at->path().filename() != staging_name || !at->is_directory(error)) continue;
    at.disable_recursion_pending();
    const std::string directory = at->path().parent_path().string();
    if (directory != folder && fs::is_regular_file(lock_in(at->path().string()), error)) found.push_back(directory);
  }
  std::sort(found.begin(), found.end());
  return found;
}

RunDirectory::RunDirectory(const std::string& path, DirectoryKind kind, bool force)
    : path_(path), staging_(staging_of(path)) {
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  const Mark mark{path_, 0, 0};
  if (fs::exists(status)) {
    if (!fs::is_directory(status)) throw InputError(mark, "is a file; --out must name a directory");
    const DirectoryNames known = names_of(kind);
    const std::string what(known.what);
    bool occupied = false, ours = false;
    for (const std::string& name : names_in(path_)) {
      if (!known.may_hold(name))
        throw InputError(mark, "holds '" + name + "', which no " + what + " writes; name another --out");
      occupied = occupied || name != staging_name;
      ours = ours || known.names(name);
    }
    if (occupied && !ours) throw InputError(mark, "is not empty and holds no " + what + "; name another --out");
    if (occupied && !force) {
      remove_abandoned(path_);
      throw InputError(mark, "exists and is not empty; name another --out or add --force");
    }
  }
  try {
    create();
  } catch (...) {
    discard();
    throw;
  }
}

void RunDirectory::create() {
  created_ = make_folders(staging_, path_);
  lock_ = FolderLock::take(lock_in(staging_), path_);
  if (!lock_) throw InputError({path_, 0, 0}, "another run is writing here; name another --out");
  for (const std::string& name : names_in(staging_))  // what an interrupted run left
    if (name != "lock") fs::remove_all(fs::path(staging_) / name);
}

void RunDirectory::commit() {
  const fs::path target(path_);
  std::error_code error;
  write_manifest(staging_);
  fs::remove(target / "results.json", error);
  for (const std::string& name : names_in(path_))
    if (name != staging_name) fs::remove_all(target / name, error);
  std::vector<std::string> names = names_in(staging_);
  std::stable_partition(names.begin(), names.end(), [](const std::string& name) { return name != "results.json"; });
  for (const std::string& name : names) {
    if (name == "lock") continue;
    fs::rename(fs::path(staging_) / name, target / name, error);
    if (error) fail((target / name).string(), "cannot be moved into place", error.value());
  }
  fs::remove_all(staging_, error);
  sync_directory(path_);
  committed_ = true;
}

void RunDirectory::discard() noexcept {
  std::error_code error;
  if (lock_) fs::remove_all(staging_, error);
  lock_.reset();
  for (auto it = created_.rbegin(); it != created_.rend(); ++it) fs::remove(*it, error);  // empty ones only
}

RunDirectory::~RunDirectory() {
  if (!committed_) discard();
}

}  // namespace plumbline::scenarios
