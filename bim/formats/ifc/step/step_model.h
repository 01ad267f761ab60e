// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bim/formats/ifc/step/shape.h"
#include "bim/formats/ifc/step/step_class.h"
#include "bim/formats/ifc/step/step_text.h"

namespace plumbline::bim {

/// IfcMaterialLayerSetUsage across the wall: layers from offset to offset + sense * thickness along the wall's y axis.
struct StepLayers {
  double offset_m = 0.0;
  int sense = 1;
  double thickness_m = 0.0;
};

/// What the file says that a space is.
enum class SpaceUse {
  room,
  gross,   ///< an area that is counted, with the rooms and walls in it
  outside  ///< a terrace, a balcony, a garden
};

/// A product as the file has it: relations resolved, geometry uncut, in W.
struct StepProduct {
  std::int64_t step_id = 0;
  StepClass kind = StepClass::obstacle;
  std::string type;  ///< IFC class, such as IfcWallStandardCase
  std::string id;    ///< GlobalId
  std::string name;
  bool placed = true;                                  ///< the file gives it a placement
  Eigen::Affine3d X_WP = Eigen::Affine3d::Identity();  ///< placement
  std::int64_t storey = 0;                             ///< STEP number of the storey it belongs to, 0 for none
  std::int64_t host = 0;                               ///< opening: the element it voids; door or window: its opening
  std::int64_t whole = 0;                              ///< STEP number of the product it is a part of, 0 for none
  bool has_body = false;                               ///< the file gives a body, whether or not it was read
  SpaceUse space_use = SpaceUse::room;
  bool ceiling = false;                  ///< a covering that the file calls a ceiling
  std::int64_t building = 0;             ///< storey: STEP number of its IfcBuilding, 0 for none
  std::string building_name;             ///< storey: of its IfcBuilding
  std::optional<double> elevation_m;     ///< storey: its Elevation
  double width_m = 0.0, height_m = 0.0;  ///< door or window: what it says it is overall, 0 for nothing
  std::optional<StepLayers> layers;
  std::string material;                  ///< of the thickest layer
  std::vector<Eigen::Vector3d> axis_W;   ///< points of the Axis representation
  std::vector<Shape> body;               ///< items of the Body in its own frame (openings: Body or Reference)
  std::vector<Eigen::Vector3d> outline;  ///< space without a body: corners of its FootPrint, or its Box, in its frame
  std::vector<std::string> diagnostics;  ///< messages of the geometry reader
};

struct StepModel {
  std::string name;                        ///< of the project
  double unit_m = 1.0;                     ///< length of the file's unit
  std::vector<StepProduct> products;       ///< by GlobalId
  std::map<std::string, Material> optics;  ///< what the file says about light, by material name
  int out_of_reach = 0;                    ///< products that are left out since they are too large or too far out
  std::vector<Warning> skipped;            ///< products whose placement cannot be resolved
  std::optional<Eigen::Vector3d> move;     ///< from the file's world to W, where it stands in map coordinates
};

/// Reads checked STEP text through IFC++: entity graph, placements and uncut solids. Its booleans are never used.
/// A file without a unit of length is in metres, or in millimetres where its extent says so.
/// Throws InputError with the line of the entity where the file does not make sense.
[[nodiscard]] StepModel read_step_model(const std::string& text, const StepText& checked, const std::string& file);

}  // namespace plumbline::bim
