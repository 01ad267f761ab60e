// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bim/formats/ifc/step/step_text.h"

namespace plumbline::bim {

/// The text without references that lead nowhere: left out of lists, a $ elsewhere. Lines stay where they are.
[[nodiscard]] std::string without_dangling(const std::string& text, const StepText& checked, const std::string& file);

/// The text with classes that are new in IFC4X3 as those of IFC4 that come nearest: built elements of all kinds as
/// proxies, facilities and their parts as buildings.
[[nodiscard]] std::string with_known_classes(const std::string& text, const StepText& checked, const std::string& file);

/// The schema that the entities are of: a header that says IFC4 over the eight attributes of IFC2X3's walls, doors and
/// slabs, or IFC2X3 over the nine of IFC4's walls, is not believed.
[[nodiscard]] std::string schema_of_entities(const std::string& text, const StepText& checked, const std::string& file);

}  // namespace plumbline::bim
