// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/mesh/ply_check.h"

#include <gtest/gtest.h>

#include "bim/errors.h"
#include "bim/formats/mesh/mesh_file.h"
#include "tests/input_error.h"

namespace plumbline::bim {
namespace {

constexpr const char* triangle = "0 0 0\n1 0 0\n1 1 0\n3 0 1 2";

std::string header(const std::string& vertices = "3", const std::string& faces = "1",
                   const std::string& format = "ascii") {
  return "ply\nformat " + format + " 1.0\ncomment made here\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

std::string complaint(const std::string& bytes) {
  return input_error([&] { check_ply(bytes, "a.ply"); });
}

TEST(PlyCheck, WhatFitsPasses) {
  EXPECT_EQ(complaint(header() + triangle), "no error");
  EXPECT_EQ(complaint(header() + triangle + "\n"), "no error");
  EXPECT_EQ(complaint(with(header(), "float", "float32") + triangle), "no error");
  EXPECT_EQ(complaint(with(header(), "comment", "obj_info") + triangle), "no error");
  std::string windows = header() + triangle;
  for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2) windows.insert(at, "\r");
  EXPECT_EQ(complaint(windows), "no error");
  const std::string three_points(36, '\0'), face(13, '\0');
  for (const char* format : {"binary_little_endian", "binary_big_endian"})
    EXPECT_EQ(complaint(header("3", "1", format) + three_points + face), "no error");
  EXPECT_EQ(complaint(header("0", "0")), "no error");
  EXPECT_EQ(read_mesh_parts(header() + triangle, "a.ply").size(), 1U);
}

TEST(PlyCheck, CountsThatTheFileCannotHoldAreRefused) {
  for (const char* count : {"5", "50000000", "4294967295", "18446744073709551615"}) {
    EXPECT_EQ(complaint(header(count) + triangle).rfind("a.ply:4: " + std::string(count) + " elements 'vertex'", 0), 0U)
        << complaint(header(count) + triangle);
    EXPECT_EQ(complaint(header(count, "1", "binary_little_endian") + std::string(36, '\0')).rfind("a.ply:4: ", 0), 0U);
  }
  EXPECT_EQ(complaint(header("3", "50000000") + triangle).rfind("a.ply:8: 50000000 elements 'face'", 0), 0U);
  EXPECT_EQ(complaint(header("3", "2", "binary_big_endian") + std::string(37, '\0')).rfind("a.ply:8: ", 0), 0U);
  EXPECT_EQ(complaint("ply\nformat ascii 1.0\nelement vertex 3000000000\nend_header\n"),
            "a.ply:3: element 'vertex' has no property");
}

TEST(PlyCheck, LinesThatAreNoneOfAHeaderAreRefused) {
  EXPECT_EQ(complaint(""), "a.ply:1: the header does not end; its last line must be 'end_header'");
  EXPECT_EQ(complaint("plx\n"), "a.ply:1: a .ply file begins with 'ply'");
  EXPECT_EQ(complaint(with(header(), "ascii", "text") + triangle).rfind("a.ply:2: the format must be", 0), 0U);
  EXPECT_EQ(complaint(with(header(), "end_header\n", "") + triangle).rfind("a.ply:10: a line of the header", 0), 0U);
  EXPECT_EQ(complaint(with(header(), "end_header", "end_haader") + triangle).rfind("a.ply:10: a line of", 0), 0U);
  EXPECT_EQ(complaint(with(header(), "float y", "flaot y") + triangle).rfind("a.ply:6: 'flaot' is no type", 0), 0U);
  EXPECT_EQ(complaint(with(header(), "uchar", "byte") + triangle).rfind("a.ply:9: 'byte' is no type", 0), 0U);
  EXPECT_EQ(complaint(header("-1") + triangle).rfind("a.ply:4: '-1' is no number", 0), 0U);
  EXPECT_EQ(complaint(with(header(), "element vertex 3\n", "") + triangle).rfind("a.ply:4: a property before", 0), 0U);
  EXPECT_EQ(complaint("ply\nformat ascii 1.0\nelement vertex 1\n").rfind("a.ply:4: the header does not end", 0), 0U);
}

/// Cut or changed anywhere, it is read or refused at once: the child process never has to be ended. One that spins is
/// refused with the limit of its time in the message.
TEST(PlyCheck, NoBrokenHeaderReachesAReaderThatSpins) {
  const std::string whole = header() + triangle, head = header();
  for (std::size_t i = 0; i < head.size(); i += 3) {
    for (const std::string& bytes : {whole.substr(0, i), std::string(whole).replace(i, 1, "a")}) {
      const std::string text = input_error([&] { static_cast<void>(read_mesh_parts(bytes, "a.ply")); });
      EXPECT_EQ(text.find("reading it "), std::string::npos) << i << ": " << text;
    }
  }
}

}  // namespace
}  // namespace plumbline::bim
