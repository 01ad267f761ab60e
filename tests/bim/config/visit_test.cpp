// SPDX-License-Identifier: Apache-2.0
#include "bim/config/visit.h"

#include <gtest/gtest.h>

#include "tests/input_error.h"

namespace plumbline {

enum class Colour { red, green };
[[nodiscard]] constexpr std::array<std::string_view, 2> names_of(Colour) { return {"red", "green"}; }

namespace {

struct Part {
  double size_m = 1.5;
  Colour colour = Colour::red;
  template <class V>
  void visit(V& v) {
    v("size_m", size_m, Field{.doc = "edge", .min = 0.1, .max = 10.0});
    v("colour", colour);
  }
};

struct Whole {
  std::string name;
  int count = 2;
  bool flag = false;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  std::optional<double> yaw_deg;
  std::vector<Part> parts;
  template <class V>
  void visit(V& v) {
    v("name", name, Field{.required = true});
    v("count", count, Field{.min = 0});
    v("flag", flag);
    v("at", at);
    v("yaw_deg", yaw_deg);
    v("parts", parts);
  }
};

std::string error_of(const std::string& yaml) {
  return input_error([&] { (void)from_tree<Whole>(read_yaml(yaml, "f.yaml")); });
}

TEST(Visit, ReadsEveryKindOfField) {
  const auto whole = from_tree<Whole>(read_yaml(
      "{name: x, count: 3, flag: true, at: [1, 2.5], yaw_deg: 90, parts: [{size_m: 2, colour: green}, {}]}", "f.yaml"));
  EXPECT_EQ(whole.count, 3);
  EXPECT_TRUE(whole.flag);
  EXPECT_EQ(whole.at.y(), 2.5);
  EXPECT_EQ(whole.yaw_deg, 90.0);
  ASSERT_EQ(whole.parts.size(), 2U);
  EXPECT_EQ(whole.parts[0].colour, Colour::green);
  EXPECT_EQ(whole.parts[1].size_m, 1.5);
}

TEST(Visit, RoundTrips) {
  const Tree tree = to_tree(from_tree<Whole>(read_yaml("{name: x, yaw_deg: 1, parts: [{}]}", "f")));
  EXPECT_EQ(write_yaml(to_tree(from_tree<Whole>(tree))), write_yaml(tree));
}

TEST(Visit, NamesEveryMistake) {
  EXPECT_EQ(error_of("name: x\ncuont: 3\n"), "f.yaml:2:8: unknown key 'cuont'; did you mean 'count'?");
  EXPECT_EQ(error_of("count: 3\n"), "f.yaml:1:1: the key 'name' is missing");
  EXPECT_EQ(error_of("nmae: x\n"), "f.yaml:1:7: the key 'name' is missing; is 'nmae' meant to be it?");
  EXPECT_EQ(error_of("cuont: 3\n"), "f.yaml:1:1: the key 'name' is missing");
  EXPECT_EQ(error_of("name: x\ncount: -1\n"), "f.yaml:2:8: 'count': -1 is out of range; it must be at least 0");
  EXPECT_EQ(error_of("name: x\ncount: 1.5\n"), "f.yaml:2:8: 'count': found '1.5' where a whole number is expected");
  EXPECT_EQ(error_of("name: x\nparts: [{colour: gren}]\n"),
            "f.yaml:2:18: 'colour': 'gren' is not one of red, green; did you mean 'green'?");
  EXPECT_EQ(error_of("name: x\nat: [1]\n"), "f.yaml:2:5: 'at': two numbers [x, y] are expected");
  EXPECT_EQ(error_of("name: x\nparts: 3\n"), "f.yaml:2:8: found '3' where a list is expected");
}

/// A file's version: a range of one number.
struct Version {
  int version = 1;
  template <class V>
  void visit(V& v) {
    v("version", version, Field{.min = 1, .max = 1});
  }
};

TEST(Visit, SaysPlainlyWhatMustBeOneNumber) {
  EXPECT_EQ(input_error([] { (void)from_tree<Version>(read_yaml("version: 3", "f.yaml")); }),
            "f.yaml:1:10: 'version': 3 is out of range; it must be 1");
}

TEST(Visit, NamesAnOptionOfTheCommandLineOnce) {
  Tree count("x");
  count.mark = {"--version", 0, 0};
  EXPECT_EQ(input_error([&] { (void)from_tree<Version>(Tree::map().set("version", count)); }),
            "--version: found 'x' where a whole number is expected");
}

}  // namespace
}  // namespace plumbline
