// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/write/write_ifc.h"

#include "bim/formats/ifc/write/write_document.h"
#include "bim/formats/ifc/write/write_elements.h"

namespace plumbline::bim {

std::string write_ifc(const Building& building, const IfcWriteConfig& config) {
  IfcDocument document(building);
  ElementWriter writer(building, config, document);
  writer.add_rooms();
  writer.add_walls();
  writer.add_boundaries();
  writer.add_openings();
  writer.add_slabs();
  writer.add_columns();
  writer.add_stairs();
  writer.add_obstacles();
  writer.add_fillings();
  return document.finish(config.signature);
}

}  // namespace plumbline::bim
