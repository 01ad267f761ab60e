// SPDX-License-Identifier: Apache-2.0
#include "bim/load/load.h"

#include <string_view>
#include <utility>

#include "bim/config/file_ending.h"
#include "bim/config/tree.h"
#include "bim/config/utf8.h"
#include "bim/errors.h"
#include "bim/formats/ifc/read/ifc.h"
#include "bim/formats/mesh/mesh_file.h"
#include "bim/formats/mesh/mesh_world.h"
#include "bim/formats/plan_yaml/plan_yaml.h"
#include "bim/formats/traffic_editor/traffic_editor.h"
#include "bim/load/foreign_file.h"
#include "bim/model/fillings.h"

namespace plumbline::bim {

namespace {

bool starts_with(std::string_view text, std::string_view head) { return text.substr(0, head.size()) == head; }

/// The text from its first line that is neither blank nor a YAML comment.
std::string_view first_content(std::string_view text) {
  text = without_byte_order_mark(text);
  while (!text.empty()) {
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) return {};
    text.remove_prefix(begin);
    if (text.front() != '#') return text;
    const std::size_t end = text.find('\n');
    text.remove_prefix(end == std::string_view::npos ? text.size() : end);
  }
  return {};
}

/// True when a line begins with the key, which then is a key of the file's outermost map.
bool has_top_key(std::string_view text, const std::string& key) {
  return starts_with(text, key) || text.find("\n" + key) != std::string_view::npos;
}

/// A building of any kind, from its text.
PlannedAndBuilt read_planned_and_built(const std::string& text, const std::string& path) {
  const std::string_view content = first_content(text);
  const bool yaml = has_ending(path, ".yaml") || has_ending(path, ".yml");
  PlannedAndBuilt both;
  if (is_mesh_path(path)) {
    both.as_planned = read_mesh_world(text, path);
    both.as_built = both.as_planned;
    both.has_plan = false;
  } else if (has_ending(path, ".ifc") || starts_with(content, "ISO-10303-21")) {
    both.as_planned = read_ifc_text(text, path);
    both.as_built = both.as_planned;
  } else if (!starts_with(content, "plan:") && has_top_key(text, "levels:")) {
    both.as_planned = read_traffic_editor_text(text, path);
    both.as_built = both.as_planned;
  } else if (yaml || starts_with(content, "plan:")) {
    PlanWithDeviations plan = read_plan_with_deviations(text, path);
    both.as_planned = std::move(plan.as_planned);
    both.as_built = std::move(plan.as_built.building);
    both.changes = std::move(plan.as_built.changes);
  } else {
    throw InputError({path, 0, 0},
                     "this is no building; a plan begins with 'plan: 1', an IFC file with 'ISO-10303-21;', a "
                     "traffic-editor plan has 'levels:', a mesh ends in .obj, .dae, .glb, .ply or .stl");
  }
  return both;
}

}  // namespace

std::string read_building_file(const std::string& path) {
  std::string bytes = is_mesh_path(path) ? read_text_file(path, MeshFileConfig().most_bytes) : read_text_file(path);
  refuse_foreign_file(bytes, path);
  return bytes;
}

PlannedAndBuilt load_planned_and_built(const std::string& path, const BuildingOptions& options) {
  PlannedAndBuilt both = read_planned_and_built(read_building_file(path), path);
  for (Building* building : {&both.as_planned, &both.as_built}) {
    apply_options(*building, options);
    add_fillings(*building);
  }
  return both;
}

Building load_building(const std::string& path) {
  return read_planned_and_built(read_building_file(path), path).as_planned;
}

}  // namespace plumbline::bim
