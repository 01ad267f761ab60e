// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "bim/config/tree.h"
#include "bim/formats/traffic_editor/traffic_editor.h"

namespace plumbline::bim {

struct TrafficVertex {
  Eigen::Vector2d p_W = Eigen::Vector2d::Zero();
  std::string name;
};

/// Walls, doors and measurements join two vertices.
struct TrafficEdge {
  std::size_t a = 0, b = 0;
  std::string name;
  double distance_m = 0.0;  ///< of a measurement
  Mark mark;
};

struct TrafficFiducial {
  Eigen::Vector2d p_W = Eigen::Vector2d::Zero();
  std::string name;
};

/// One level of the file. Coordinates are those of the file with y up until align_levels has run, then W.
struct TrafficLevel {
  std::string name;
  double elevation_m = 0.0;
  std::vector<TrafficVertex> vertices;
  std::vector<TrafficEdge> walls, doors, measurements;
  std::vector<std::vector<std::size_t>> floors, holes;  ///< vertices around
  std::vector<TrafficFiducial> fiducials;
  std::size_t models = 0;
  Mark mark;
};

struct TrafficFile {
  std::string name;
  bool metres = false;               ///< coordinates are metres with y up, not pixels with y down
  std::vector<TrafficLevel> levels;  ///< by elevation, then name
  std::vector<std::string> lifts;
};

/// The parts of the file that say what stands in the building, checked: references exist, numbers are in range.
[[nodiscard]] TrafficFile read_traffic_file(const Tree& tree, const TrafficEditorConfig& config);

/// Scales each level by its measurements (else by fiducials) to metres and lays it on the lowest one. Levels that
/// agree badly get a warning; one without any scale is an InputError.
void align_levels(TrafficFile& file, const TrafficEditorConfig& config, std::vector<Warning>& warnings);

}  // namespace plumbline::bim
