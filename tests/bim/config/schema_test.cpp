// SPDX-License-Identifier: Apache-2.0
#include "bim/config/schema.h"

#include <gtest/gtest.h>

#include "bim/config/markdown.h"

namespace plumbline {
namespace {

struct Inner {
  double share = 0.5;
  double step_m = 0.1;
  template <class V>
  void visit(V& v) {
    v("share", share, Field{.doc = "a | b", .min = 0.0, .max = 1.0});
    v("step_m", step_m, Field{.doc = "step", .min = 0.0, .basic = true});
  }
};

struct Outer {
  int count = 100000;
  double drift_per_m = 0.01;
  Inner inner;
  template <class V>
  void visit(V& v) {
    v("count", count, Field{.doc = "count", .min = 1.0, .max = 100000.0, .basic = true});
    v("drift_per_m", drift_per_m, Field{.doc = "drift", .unit = "rad/m"});
    v("inner", inner);
  }
};

std::vector<SchemaField> fields() { return SchemaVisitor::sections_of<Outer>().front().fields; }

TEST(Schema, UnitsAreTheFieldsOwnOrThoseOfTheEnding) {
  EXPECT_EQ(fields()[0].unit, "-");  // a count
  EXPECT_EQ(fields()[1].unit, "rad/m");
  EXPECT_EQ(fields()[2].unit, "");
  EXPECT_EQ(fields()[3].unit, "m");
  EXPECT_EQ(schema_field("drift_per_m", "number", {}).unit, "");
}

TEST(Schema, BasicFieldsAreShownAloneWhereThereAreSome) {
  const std::vector<SchemaField> basic = basic_fields(fields());
  ASSERT_EQ(basic.size(), 2U);
  EXPECT_EQ(basic[1].key, "inner.step_m");
  EXPECT_EQ(basic_fields({fields()[1], fields()[2]}).size(), 2U);
  EXPECT_EQ(schema_yaml(basic),
            "count: 100000  # count (1 to 100000)\ninner:\n  step_m: 0.1  # step (m, at least 0)\n");
}

struct Holder {
  Inner turned;
  Inner hidden;
  template <class V>
  void visit(V& v) {
    v("turned", turned);
    v("hidden", hidden, Field{.advanced = true});
  }
};

TEST(Schema, AnAdvancedStructHasNoBasicKeys) {
  const std::vector<SchemaField> basic = basic_fields(SchemaVisitor::sections_of<Holder>().front().fields);
  ASSERT_EQ(basic.size(), 1U);
  EXPECT_EQ(basic[0].key, "turned.step_m");
}

TEST(Schema, TablesEscapeWhatWouldEndACell) {
  EXPECT_NE(schema_table(fields()).find("| `inner.share` | number | | 0 to 1 | `0.5` | a \\| b |\n"),
            std::string::npos);
  MarkdownTable table({"a", "b"});
  table.add({"x < y", markdown_code("<method>")});
  EXPECT_EQ(table.text(), "| a | b |\n|---|---|\n| x \\< y | `<method>` |\n");
}

}  // namespace
}  // namespace plumbline
