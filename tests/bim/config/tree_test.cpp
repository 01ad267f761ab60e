// SPDX-License-Identifier: Apache-2.0
#include "bim/config/tree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bim/random/stream.h"
#include "tests/input_error.h"

namespace plumbline {
namespace {

TEST(Tree, YamlKeepsPlaces) {
  const Tree tree = read_yaml("a: 1\nb:\n  - x\n  - {c: 2.5}\n", "f.yaml");
  EXPECT_EQ(tree.find("a")->as_int(), 1);
  const Tree& inner = tree.find("b")->as_list()[1];
  EXPECT_DOUBLE_EQ(inner.find("c")->as_double(), 2.5);
  EXPECT_EQ(inner.find("c")->mark.line, 4);
  EXPECT_EQ(inner.find("c")->mark.col, 9);
}

TEST(Tree, YamlRefusesDuplicateKeys) {
  EXPECT_EQ(input_error([] { (void)read_yaml("a: 1\na: 2\n", "f.yaml"); }),
            "f.yaml:2:1: duplicate key 'a'; each key may stand once");
}

TEST(Tree, YamlRefusesWhatItCannotKeep) {
  EXPECT_NE(input_error([] { (void)read_yaml("a: &x 1\nb: *x\n", "f"); }).find("aliases"), std::string::npos);
  EXPECT_NE(input_error([] { (void)read_yaml("a: [1, 2\n", "f"); }).find("f:"), std::string::npos);
  EXPECT_NE(input_error([] { (void)read_yaml(std::string(100, '[') + std::string(100, ']'), "f"); }).find("64"),
            std::string::npos);
  EXPECT_FALSE(input_error([] { (void)read_yaml(std::string(100000, '['), "f"); }).empty());
  EXPECT_NE(input_error([] { (void)read_yaml("a: 1\n---\nb: 2\n", "f"); }).find("more than one"), std::string::npos);
}

TEST(Tree, ConversionsNameTheirPlace) {
  const Tree tree = read_yaml("a: five\n", "f.yaml");
  EXPECT_EQ(input_error([&] { (void)tree.find("a")->as_double(); }),
            "f.yaml:1:4: found 'five' where a number is expected");
  EXPECT_FALSE(input_error([] { (void)read_yaml("nan", "f").as_double(); }).empty());
  EXPECT_FALSE(input_error([] { (void)read_yaml("1e400", "f").as_double(); }).empty());
}

Tree sample() {
  Tree inner = Tree::map();
  inner.set("text", "a \"b\"\\ : #\n").set("empty", Tree::list()).set("number-like", "12");
  Tree tree = Tree::map();
  tree.set("i", 3).set("d", 0.1).set("flag", true);
  tree.set("list", Tree(Tree::List{inner, Tree(Tree::List{Tree(1), Tree(2.5)}), Tree("x")}));
  return tree;
}

TEST(Tree, JsonRoundTrips) {
  const std::string text = write_json(sample());
  EXPECT_EQ(write_json(read_json(text, "f")), text);
  EXPECT_EQ(write_json(read_json(write_json(sample(), 0), "f")), text);
}

TEST(Tree, YamlRoundTripsAsText) {
  const std::string text = write_yaml(sample());
  EXPECT_EQ(write_yaml(read_yaml(text, "f")), text);
}

// A scenario that is read and written again, as by shrink, keeps its numbers.
TEST(Yaml, NegativeNumbersStayPlainAndOtherDashesDoNot) {
  const std::string text = "at: [-2.525, 4.875]\nname: \"-a\"\nlist: \"-\"\n";
  EXPECT_EQ(write_yaml(read_yaml(text, "f")), text);
}

TEST(Tree, NumbersRoundTrip) {
  const Stream stream(1, "bim.generate");
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const double value = stream.gauss(i) * std::pow(10.0, 20.0 * stream.gauss(i, 1));
    EXPECT_EQ(read_yaml(format_number(value), "f").as_double(), value);
  }
  EXPECT_EQ(format_number(-0.0), "0");
  EXPECT_THROW((void)format_number(std::nan("")), InternalError);
}

TEST(Tree, SuggestsTheClosestName) {
  EXPECT_EQ(did_you_mean("sped_mps", {"seed", "speed_mps", "start"}), "speed_mps");
  EXPECT_EQ(did_you_mean("zzzzzz", {"seed", "start"}), "");
}

TEST(Yaml, TextThatIsNotUtf8IsRefusedWhereItStands) {
  for (const std::string bad : {"\xe9", "\xc0\xaf", "\xe0\x80\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80",
                                "\xf5\x80\x80\x80", "\xe2\x82", "\x80"}) {
    try {
      static_cast<void>(read_yaml("a: 1\nb: caf" + bad + "\n", "x.yaml"));
      ADD_FAILURE() << "taken";
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).rfind("x.yaml:2:7: no UTF-8", 0), 0U) << error.what();
    }
  }
  for (const std::string good : {"caf\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\x98\x80", "\xed\x9f\xbf", "\xf4\x8f\xbf\xbd"})
    EXPECT_EQ(read_yaml("a: " + good, "x.yaml").find("a")->as_string(), good);
}

TEST(Json, WhatATreeCannotHoldIsRefused) {
  EXPECT_EQ(write_json(read_json("9223372036854775807", "f")), "9223372036854775807");
  EXPECT_THROW(static_cast<void>(read_json("{\"a\": 9223372036854775808}", "f")), InputError);
  EXPECT_THROW(static_cast<void>(read_json("18446744073709551615", "f")), InputError);
}

TEST(Json, AKeyStandsOnceInAMap) {
  EXPECT_EQ(write_json(read_json(R"({"a":{"a":1},"b":[{"a":1},{"a":2}]})", "f"), 0),
            R"({"a":{"a":1},"b":[{"a":1},{"a":2}]})");
  EXPECT_THROW(static_cast<void>(read_json(R"({"a":1,"b":2,"a":3})", "f")), InputError);
  EXPECT_THROW(static_cast<void>(read_json(R"([{"c":{"a":1,"a":1}}])", "f")), InputError);
}

/// "k0: 0", "k1: 1", ... a line each.
std::string many_keys(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += "k" + std::to_string(i) + ": " + std::to_string(i) + "\n";
  return text;
}

// Each map of 200000 keys would take minutes if a key were sought among all before it.
TEST(Yaml, AMapMayHoldManyKeysEachOnce) {
  constexpr int count = 200'000;
  const std::string text = many_keys(count);
  const Tree tree = read_yaml(text, "f.yaml");
  ASSERT_EQ(tree.as_map().size(), std::size_t{count});
  EXPECT_EQ(tree.as_map().back().first, "k199999");
  EXPECT_EQ(tree.as_map().back().second.as_int(), count - 1);
  EXPECT_EQ(input_error([&] { (void)read_yaml(text + "k77: 1\n", "f.yaml"); }),
            "f.yaml:200001:1: duplicate key 'k77'; each key may stand once");
}

TEST(Json, AMapMayHoldManyKeysEachOnce) {
  constexpr int count = 200'000;
  std::string text = "{";
  for (int i = 0; i < count; ++i) text += "\"k" + std::to_string(i) + "\":" + std::to_string(i) + ",";
  const Tree tree = read_json(text + "\"last\":-1}", "f.json");
  ASSERT_EQ(tree.as_map().size(), std::size_t{count + 1});
  EXPECT_EQ(tree.as_map().front().first, "k0");
  EXPECT_EQ(tree.as_map()[count - 1].second.as_int(), count - 1);
  EXPECT_EQ(input_error([&] { (void)read_json(text + "\"k77\":1}", "f.json"); }),
            "f.json: duplicate key 'k77'; each key may stand once");
}

TEST(Json, KeepsKindsPlacesOfErrorsAndBounds) {
  const std::string text = R"({"a":[1,-2,0.5,1e3,true,false,null,"x",[],{}],"b":{"c":{}}})";
  EXPECT_EQ(write_json(read_json(text, "f"), 0), R"({"a":[1,-2,0.5,1000,true,false,null,"x",[],{}],"b":{"c":{}}})");
  EXPECT_EQ(input_error([] { (void)read_json("{\"a\":\n 1,}", "f"); }), "f:2:4: no valid JSON");
  EXPECT_EQ(input_error([] { (void)read_json("", "f"); }), "f:1:1: no valid JSON");
  EXPECT_NE(input_error([] { (void)read_json("[1] 2", "f"); }).find("no valid JSON"), std::string::npos);
  EXPECT_NE(input_error([] { (void)read_json("[1e400]", "f"); }).find("no valid JSON"), std::string::npos);
  const auto nested = [](std::size_t n) { return std::string(n, '[') + std::string(n, ']'); };
  EXPECT_EQ(write_json(read_json(nested(65), "f"), 0), nested(65));
  EXPECT_EQ(input_error([&] { (void)read_json(nested(66), "f"); }), "f: nested deeper than 64 levels");
}

TEST(Yaml, EveryByteOfTextSurvivesWriting) {
  for (int byte = 1; byte < 0x80; ++byte) {
    const char c = static_cast<char>(byte);
    for (const std::string& text :
         {std::string(1, c), std::string("a") + c + "b", std::string("a") + c, c + std::string("b")}) {
      Tree tree = Tree::map();
      tree.set(text, Tree::list().push(text).push("x")).set("value of " + text, text);
      const std::string written = write_yaml(tree);
      for (const char w : written) EXPECT_TRUE(w == '\n' || static_cast<unsigned char>(w) >= 0x20U) << byte;
      const Tree read = read_yaml(written, "f");
      ASSERT_EQ(read.as_map().size(), 2U) << byte;
      EXPECT_EQ(read.as_map()[0].first, text) << byte;
      EXPECT_EQ(read.as_map()[0].second.as_list()[0].as_string(), text) << byte;
      EXPECT_EQ(read.as_map()[1].second.as_string(), text) << byte;
    }
  }
}

}  // namespace
}  // namespace plumbline
