// SPDX-License-Identifier: Apache-2.0
#include "bim/load/foreign_file.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "tests/input_error.h"

namespace plumbline::bim {
namespace {

std::string refusal(const std::string& bytes, const std::string& path = "house.ifc") {
  return input_error([&] { refuse_foreign_file(bytes, path); });
}

std::string wide(const std::string& text, bool low_byte_first) {
  std::string bytes;
  for (const char c : text) bytes += low_byte_first ? std::string{c, '\0'} : std::string{'\0', c};
  return bytes;
}

TEST(ForeignFile, SaysWhatItIsAndWhatToDo) {
  const std::vector<std::pair<std::string, std::string>> rows = {
      {"PK\x03\x04 and more", "is a zip archive, such as ifcZIP; unpack it and give the .ifc that is in it"},
      {"\x1f\x8b\x08", "is packed by gzip; unpack it and give the file that is in it"},
      {"\xff\xfeI", "is text in UTF-16; save it as UTF-8"},
      {wide("ISO-10303-21;", true), "is text in UTF-16"},
      {wide("ISO-10303-21;", false), "is text in UTF-16"},
      {"<?xml version=\"1.0\"?>\n<ifcXML/>", "is ifcXML; export the building as IFC in STEP text (.ifc)"},
      {"\xEF\xBB\xBF\n<ifc:IfcProject/>", "is ifcXML"},
      {"<!DOCTYPE html><html>", "is a web page and not the file"},
      {"{\"type\": \"ifcJSON\", \"data\": []}", "is IFC as JSON"},
      {"{\"asset\": {\"version\": \"2.0\"}}", "is a glTF mesh as JSON; save it as .glb"},
      {"\xd0\xcf\x11\xe0\xa1", "is a project of a CAD program"},
      {"version https://git-lfs.github.com/spec/v1\n", "is a pointer of Git LFS"},
  };
  for (const auto& [bytes, text] : rows)
    EXPECT_EQ(refusal(bytes).rfind("house.ifc: " + text, 0), 0U) << text << ", but: " << refusal(bytes);
}

TEST(ForeignFile, WhatMayBeABuildingPasses) {
  for (const char* text : {"ISO-10303-21;\nHEADER;", "plan: 1\n", "{\"plan\": 1, \"name\": \"an ifc\"}", "levels:\n",
                           "{scenario: 1, building: a.ifc}", "{\"building\": \"a.ifc\", \"scenario\": 1}", "",
                           "Dear Sir or Madam", "[1, 2]"})
    EXPECT_EQ(refusal(text), "no error") << text;
}

/// Their readers know what is wrong with them; an archive is none of any ending.
TEST(ForeignFile, MeshesHaveTheirOwnHeads) {
  EXPECT_EQ(refusal("<?xml version=\"1.0\"?><COLLADA/>", "house.dae"), "no error");
  EXPECT_EQ(refusal("glTF\x02", "house.glb"), "no error");
  EXPECT_EQ(refusal("ply\nformat", "HOUSE.PLY"), "no error");
  EXPECT_NE(refusal("glTF\x02", "house.bin").find("let its name end in .glb"), std::string::npos);
  EXPECT_NE(refusal("PK\x03\x04", "house.obj").find("is a zip archive"), std::string::npos);
}

}  // namespace
}  // namespace plumbline::bim
