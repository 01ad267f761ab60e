// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_class.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace plumbline::bim {
namespace {

struct ClassName {
  std::string_view type;
  StepClass kind;
};

/// Subtypes stand by themselves.
constexpr std::array<ClassName, 32> class_names{{
    {"IfcBuildingElementPart", StepClass::part},
    {"IfcBuildingStorey", StepClass::storey},
    {"IfcColumn", StepClass::column},
    {"IfcColumnStandardCase", StepClass::column},
    {"IfcCurtainWall", StepClass::curtain_wall},
    {"IfcDoor", StepClass::door},
    {"IfcDoorStandardCase", StepClass::door},
    {"IfcFastener", StepClass::hidden},
    {"IfcGeographicElement", StepClass::hidden},
    {"IfcMechanicalFastener", StepClass::hidden},
    {"IfcOpeningElement", StepClass::opening},
    {"IfcOpeningStandardCase", StepClass::opening},
    {"IfcReinforcingBar", StepClass::hidden},
    {"IfcReinforcingMesh", StepClass::hidden},
    {"IfcRoof", StepClass::roof},
    {"IfcSite", StepClass::hidden},
    {"IfcSlab", StepClass::slab},
    {"IfcSlabElementedCase", StepClass::slab},
    {"IfcSlabStandardCase", StepClass::slab},
    {"IfcSpace", StepClass::space},
    {"IfcStair", StepClass::stair},
    {"IfcStairFlight", StepClass::stair_flight},
    {"IfcTendon", StepClass::hidden},
    {"IfcTendonAnchor", StepClass::hidden},
    {"IfcVirtualElement", StepClass::hidden},
    {"IfcVoidingFeature", StepClass::opening},
    {"IfcWall", StepClass::wall},
    {"IfcWallElementedCase", StepClass::wall},
    {"IfcWallStandardCase", StepClass::wall},
    {"IfcWindow", StepClass::window},
    {"IfcWindowStandardCase", StepClass::window},
    {"IfcProxy", StepClass::obstacle},
}};

struct KindName {
  std::string_view type;
  std::string_view kind;
};
constexpr std::array<KindName, 9> kind_names{{
    {"IfcBeamStandardCase", "beam"},
    {"IfcBuildingElementProxy", "proxy"},
    {"IfcFurnishingElement", "furniture"},
    {"IfcMemberStandardCase", "member"},
    {"IfcPlateStandardCase", "plate"},
    {"IfcRampFlight", "ramp"},
    {"IfcStairFlight", "stair"},
    {"IfcSystemFurnitureElement", "furniture"},
    {"IfcBuildingElementPart", "part"},
}};

}  // namespace

std::optional<StepClass> class_of(std::string_view type) {
  for (const ClassName& name : class_names)
    if (name.type == type) return name.kind;
  return std::nullopt;
}

std::string obstacle_kind(std::string_view type) {
  const auto known =
      std::find_if(kind_names.begin(), kind_names.end(), [&](const KindName& name) { return name.type == type; });
  if (known != kind_names.end()) return std::string(known->kind);
  std::string kind;
  for (const char c : type.substr(type.starts_with("Ifc") ? 3 : 0)) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isupper(letter) != 0 && !kind.empty()) kind += '_';
    kind += static_cast<char>(std::tolower(letter));
  }
  return kind;
}

}  // namespace plumbline::bim
