// SPDX-License-Identifier: Apache-2.0
// What was read before in the same process makes no difference.
#include <gtest/gtest.h>

#include "bim/config/tree.h"
#include "bim/formats/ifc/read/ifc.h"
#include "tests/bim/formats/ifc/fixture.h"
#include "tests/data.h"

namespace plumbline::bim {
namespace {

TEST(Order, OfReadingDoesNotShowInTheHash) {
  std::vector<std::string> texts = {small_ifc({})};
  for (const char* name : {"twin_flats", "gable_house", "workshop", "walls_only"})
    texts.push_back(read_text_file(data_path(std::string("ifc/") + name + ".ifc")));
  // What others made belongs in when it is there.
  for (const char* name : {"ManySimpleWalls", "IfcOpenHouse_IFC4", "AC20-FZK-Haus", "duplex"}) {
    const std::string file = std::string("ifc/") + name + ".ifc";
    if (data_missing(file).empty()) texts.push_back(read_text_file(data_path(file)));
  }
  std::vector<std::uint64_t> forward;
  for (const std::string& text : texts) forward.push_back(read_ifc_text(text, "file.ifc").hash());
  for (std::size_t i = texts.size(); i-- > 0;) EXPECT_EQ(read_ifc_text(texts[i], "file.ifc").hash(), forward[i]) << i;
}

}  // namespace
}  // namespace plumbline::bim
