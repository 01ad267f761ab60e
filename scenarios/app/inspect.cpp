// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/inspect/inspect.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "bim/errors.h"
#include "bim/formats/ifc/write/write_ifc.h"
#include "bim/formats/mesh/mesh_file.h"
#include "bim/formats/plan_yaml/plan_schema.h"
#include "bim/load/load.h"
#include "bim/mesh/export.h"
#include "scenarios/app/commands.h"
#include "scenarios/host/files.h"
#include "scenarios/host/terminal.h"
#include "scenarios/report/walk_page.h"
#include "scenarios/spec/run_site.h"

namespace plumbline::scenarios {

namespace {

struct InspectOptions {
  std::string building;
  std::string mesh;
  std::string ifc;
  std::string walk;
  bool json = false;
  bool as_built = false;
  bool schema = false;
  bool force = false;
};

/// Throws InputError where a file to write is the one that is read, or is there and may not be replaced.
void check_output(const std::string& path, const InspectOptions& options) {
  std::error_code unknown;  // a file that is not there is no building either
  if (std::filesystem::equivalent(path, options.building, unknown))
    throw InputError({path, 0, 0}, "this would overwrite the building that is read; give another name");
  if (std::filesystem::exists(path, unknown) && !options.force)
    throw InputError({path, 0, 0}, "exists already; --force replaces it");
}

/// Writes the page on where a robot can walk, and prints the same in short.
int inspect_walk(const InspectOptions& options) {
  if (std::filesystem::path(options.walk).extension() != ".html")
    throw InputError({options.walk, 0, 0}, "must be a page; name a file that ends in .html");
  if (bim::is_mesh_path(options.building))
    throw InputError({options.building, 0, 0}, "is a mesh, of which no rooms are known; name a plan or an .ifc");
  const bim::PlannedAndBuilt site = load_site(options.building, Scenario());  // as `run` has it
  const WalkPage page = walk_page(site, std::filesystem::path(options.building).filename().string());
  write_file(options.walk, page.html);
  if (options.json) {
    print(write_json(Tree::map().set("storeys", page.storeys)) + "\n");
    return 0;
  }
  for (const std::string& line : page.lines) print(line + "\n");
  print("page: " + options.walk + "\n");
  return 0;
}

int inspect(const InspectOptions& options) {
  if (options.schema) {
    std::fputs(bim::plan_page().c_str(), stdout);
    return 0;
  }
  if (options.building.empty())
    throw InputError({"BUILDING", 0, 0}, "is required: a plan, .ifc or mesh; see plumbline inspect --help");
  std::optional<bim::MeshFormat> format;
  if (!options.mesh.empty()) format = bim::mesh_format(options.mesh);
  for (const std::string& output : {options.mesh, options.ifc, options.walk})
    if (!output.empty()) check_output(output, options);
  if (!options.ifc.empty() && options.ifc == options.mesh)
    throw InputError({"--ifc", 0, 0}, "names the file that --mesh does");
  if (!options.walk.empty()) return inspect_walk(options);
  const bim::PlannedAndBuilt site =
      options.as_built ? bim::load_planned_and_built(options.building) : bim::PlannedAndBuilt{};
  const bim::Building building = options.as_built ? site.as_built : bim::load_building(options.building);
  const bim::BuildingMesh mesh = bim::build_mesh(building);
  if (format) write_file(options.mesh, bim::write_mesh(building, mesh, *format));
  if (!options.ifc.empty()) write_file(options.ifc, bim::write_ifc(building));
  const std::string text =
      options.json ? write_json(inspect_json(building, mesh)) + "\n" : inspect_text(building, mesh, site.changes);
  print(text);
  return 0;
}

}  // namespace

Command add_inspect(CommandLine& program) {
  const auto options = std::make_shared<InspectOptions>();
  CommandLine line =
      program.add_command("inspect", "Lists what a building holds: storeys, rooms, walls, volumes, symmetry, warnings");
  line.option("BUILDING", options->building,
              "plan or traffic-editor plan (.yaml), .ifc, or mesh (.glb, .obj, .dae, .ply, .stl)");
  line.flag("--json", options->json, "as JSON, every element; with --walk the rooms out of reach and why");
  line.flag("--as-built", options->as_built, "with its deviations, closed doors and window panes");
  line.option("--mesh", options->mesh, "writes the cut building as .glb, .obj or .ply");
  line.option("--walk", options->walk,
              "writes instead a page (.html) on where a robot can walk, room by room, and what stops it");
  line.flag("--schema", options->schema, "prints instead every key of plan files, with examples");
  line.option("--ifc", options->ifc, "writes the building as IFC4");
  line.flag("--force", options->force, "replaces the files that are there");
  line.footer(
      "Examples: plumbline inspect house.ifc --mesh house.glb\n"
      "          plumbline inspect site.plan.yaml --as-built --ifc built.ifc");
  return {line, [options] { return inspect(*options); }};
}

}  // namespace plumbline::scenarios
