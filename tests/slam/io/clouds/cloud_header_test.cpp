// SPDX-License-Identifier: Apache-2.0
#include "slam/io/clouds/cloud_header.h"

#include <gtest/gtest.h>

#include <string>

#include "bim/errors.h"

namespace plumbline::slam {
namespace {

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::logic_error("the test's own text has no '" + what + "'");
  return text.replace(at, what.size(), by);
}

const std::string pcd =
    "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z ring normal\nSIZE 4 4 8 2 4\nTYPE F F F U "
    "F\n"
    "COUNT 1 1 1 1 3\nWIDTH 3\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 6\nDATA binary\n";
const std::string ply =
    "ply\r\nformat binary_little_endian 1.0\ncomment by hand\nobj_info num_cols 3\nobj_info num_rows 2\n"
    "element vertex 6\nproperty float x\nproperty float32 y\nproperty double z\nproperty uchar intensity\n"
    "element camera 1\nproperty float view_px\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n";

CloudHeader read(const std::string& bytes, CloudFormat format) { return read_cloud_header(bytes, format, "c"); }

/// The message of the refusal.
std::string refusal(const std::string& bytes, CloudFormat format) {
  try {
    (void)read(bytes, format);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(CloudHeader, SaysWhatAPcdHolds) {
  const CloudHeader header = read(pcd + std::string(180, '\1'), CloudFormat::pcd);
  EXPECT_EQ(header.width, 3U);
  EXPECT_EQ(header.height, 2U);
  EXPECT_EQ(header.step, 4U + 4 + 8 + 2 + 12);
  EXPECT_EQ(header.numbers, 7U);
  EXPECT_EQ(header.data, CloudData::binary);
  EXPECT_EQ(header.size, pcd.size());
}

TEST(CloudHeader, SaysWhatAPlyHolds) {
  const CloudHeader header = read(ply + std::string(102, '\1'), CloudFormat::ply);
  EXPECT_EQ(header.points(), 6U);
  EXPECT_EQ(header.step, 17U);
  EXPECT_EQ(header.numbers, 4U);
  EXPECT_EQ(header.size, ply.size());
}

TEST(CloudHeader, AFileIsNotShorterThanItsPoints) {
  EXPECT_EQ(refusal(pcd + std::string(180, 'x'), CloudFormat::pcd), "none");
  EXPECT_NE(refusal(pcd + std::string(179, 'x'), CloudFormat::pcd).find("179 bytes for 6 points"), std::string::npos);
  EXPECT_EQ(refusal(ply + std::string(102, 'x'), CloudFormat::ply), "none");
  EXPECT_NE(refusal(ply + std::string(101, 'x'), CloudFormat::ply).find("101 bytes for 6 points"), std::string::npos);
  const std::string ascii = replaced(pcd, "binary", "ascii");
  EXPECT_EQ(refusal(ascii + "1 2 3 4 5 6 7\n1 2 3 4 5 6 7\n1 2 3 4 5 6 7\n1 2 3 4 5 6 7\n1 2 3 4 5 6 7\n1 2 3 4 5 6 7",
                    CloudFormat::pcd),
            "none");
  EXPECT_NE(refusal(ascii + "1 2 3 4 5 6 7\n", CloudFormat::pcd).find("7 numbers for 6 points of 7"),
            std::string::npos);
}

TEST(CloudHeader, WhatIsPackedIsNotMoreThanItsHeaderSays) {
  const std::string packed = replaced(pcd, "binary", "binary_compressed");
  const auto with = [&](std::uint32_t compressed, std::uint32_t unpacked, std::size_t there) {
    std::string bytes = packed;
    bytes.append(reinterpret_cast<const char*>(&compressed), 4);
    bytes.append(reinterpret_cast<const char*>(&unpacked), 4);
    return refusal(bytes + std::string(there, '\0'), CloudFormat::pcd);
  };
  EXPECT_EQ(with(20, 180, 20), "none");
  EXPECT_NE(with(20, 180, 19), "none");
  EXPECT_NE(with(20, 181, 20), "none");
  EXPECT_NE(with(1, 180, 20), "none") << "nothing packs so well";
  EXPECT_NE(with(0xffffffff, 180, 20), "none");
  EXPECT_NE(refusal(packed, CloudFormat::pcd), "none");
}

TEST(CloudHeader, RefusesHostilePcd) {
  const auto refuse = [](const std::string& what, const std::string& by) {
    EXPECT_NE(refusal(replaced(pcd, what, by) + std::string(180, '\1'), CloudFormat::pcd), "none") << by;
  };
  refuse("POINTS 6", "POINTS 7");
  refuse("WIDTH 3", "WIDTH 4294967295");
  refuse("WIDTH 3\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 6", "WIDTH 4000001\nHEIGHT 1\nPOINTS 4000001");
  refuse("WIDTH 3", "WIDTH -3");
  refuse("WIDTH 3", "WIDTH 3.0");
  refuse("WIDTH 3", "WIDTH");
  refuse("POINTS 6\n", "");
  refuse("SIZE 4 4 8 2 4", "SIZE 4 4 8 2");
  refuse("SIZE 4 4 8 2 4", "SIZE 4 4 3 2 4");
  refuse("SIZE 4 4 8 2 4", "SIZE 4 4 8 2 4294967295");
  refuse("TYPE F F F U F", "TYPE F F F X F");
  refuse("TYPE F F F U F", "TYPE F F F F F");  // of 2 bytes
  refuse("COUNT 1 1 1 1 3", "COUNT 1 1 1 1 0");
  refuse("COUNT 1 1 1 1 3", "COUNT 1 1 1 1 4294967295");
  refuse("x y z", "a b c");
  refuse("FIELDS x y z ring normal", "FIELDS");
  refuse("VERSION 0.7", "FIELDS x y z ring normal");
  refuse("VERSION 0.7", "SIZE 4 4 8 2 4");
  refuse("VERSION 0.7", "NONSENSE 0.7");
  refuse("DATA binary", "DATA base64");
  refuse("DATA binary\n", "DATA binary");
  std::string many = "FIELDS x y z";
  for (int k = 0; k < 64; ++k) many += " f" + std::to_string(k);
  refuse("FIELDS x y z ring normal", many);
  for (std::size_t n = 0; n < pcd.size(); ++n) EXPECT_NE(refusal(pcd.substr(0, n), CloudFormat::pcd), "none") << n;
  EXPECT_NE(refusal(std::string(100'000, 'x'), CloudFormat::pcd), "none");
  EXPECT_NE(refusal(std::string(100'000, '\n'), CloudFormat::pcd), "none");
  EXPECT_NE(refusal("", CloudFormat::pcd), "none");
}

TEST(CloudHeader, RefusesHostilePly) {
  const auto refuse = [](const std::string& what, const std::string& by) {
    EXPECT_NE(refusal(replaced(ply, what, by) + std::string(102, '\1'), CloudFormat::ply), "none") << by;
  };
  refuse("ply", "plz");
  refuse("binary_little_endian", "binary_big_endian");
  refuse("comment by hand", "format ascii 1.0");
  refuse("comment by hand", "element face 1");
  refuse("comment by hand", "property float w");
  refuse("num_cols 3", "num_cols 4");
  refuse("num_cols 3", "num_cols 4294967295");
  refuse("obj_info num_rows 2\n", "");
  refuse("element face 0", "obj_info num_rows 2");
  refuse("element vertex 6", "element vertex 4000001");
  refuse("element vertex 6", "element vertex");
  refuse("element camera 1", "element camera 2");
  refuse("element face 0", "element vertex 0");
  refuse("element face 0", "element range_grid 6");
  refuse("property double z", "property list uchar int z");
  refuse("property double z", "property half z");
  refuse("property double z", "property double y");
  refuse("property uchar intensity", "property uchar alpha");
  refuse("float x", "float a");
  for (std::size_t n = 0; n < ply.size(); ++n) EXPECT_NE(refusal(ply.substr(0, n), CloudFormat::ply), "none") << n;
}

TEST(CloudHeader, TheEndingSaysTheFormat) {
  EXPECT_EQ(cloud_format_of("a/b.pcd"), CloudFormat::pcd);
  EXPECT_EQ(cloud_format_of("b.ply"), CloudFormat::ply);
  EXPECT_THROW((void)cloud_format_of("b.las"), InputError);
  EXPECT_FALSE(is_cloud_file("pcd"));
}

}  // namespace
}  // namespace plumbline::slam
