// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/methods_page.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "slam/methods.h"

namespace plumbline::docs {
namespace {

SchemaField field(const std::string& key, const std::string& standard) {
  SchemaField made;
  made.key = key;
  made.standard = standard;
  return made;
}

std::vector<SchemaField> ten_fields(const std::string& first) {
  std::vector<SchemaField> fields{field("key_0", first)};
  for (int i = 1; i < 10; ++i) fields.push_back(field("key_" + std::to_string(i), "1"));
  return fields;
}

TEST(MethodsPage, AMethodLikeAnotherShowsWhatDiffers) {
  std::vector<SchemaField> fewer = ten_fields("2");
  fewer.pop_back();
  const std::vector<KeysShown> shown = keys_shown({{"near", false, fewer},
                                                   {"base", true, ten_fields("1")},
                                                   {"far", false, {field("key_0", "1"), field("other", "1")}}});
  EXPECT_EQ(shown[0].like, "base");
  ASSERT_EQ(shown[0].fields.size(), 1u);
  EXPECT_EQ(shown[0].fields[0].standard, "2");
  EXPECT_EQ(shown[0].without, std::vector<std::string>{"key_9"});
  EXPECT_EQ(shown[1].like, "");
  EXPECT_EQ(shown[1].fields.size(), 10u);
  EXPECT_EQ(shown[2].like, "");
}

TEST(MethodsPage, EveryKeyOfEveryMethodCanBeFound) {
  std::vector<MethodKeys> methods;
  for (const slam::MethodRow& row : slam::methods())
    if (row.config_schema) methods.push_back({std::string(row.name), row.standard, row.config_schema().front().fields});
  const std::vector<KeysShown> shown = keys_shown(methods);
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const auto base = std::find_if(methods.begin(), methods.end(),
                                   [&](const MethodKeys& method) { return method.name == shown[i].like; });
    if (base != methods.end())
      EXPECT_EQ(shown[static_cast<std::size_t>(base - methods.begin())].like, "") << methods[i].name;
    std::vector<SchemaField> found = shown[i].fields;
    for (const SchemaField& inherited : base == methods.end() ? std::vector<SchemaField>{} : base->fields) {
      const auto overridden = [&](const SchemaField& own) { return own.key == inherited.key; };
      const auto absent = std::find(shown[i].without.begin(), shown[i].without.end(), inherited.key);
      if (absent == shown[i].without.end() && std::none_of(shown[i].fields.begin(), shown[i].fields.end(), overridden))
        found.push_back(inherited);
    }
    EXPECT_EQ(found.size(), methods[i].fields.size()) << methods[i].name;
    for (const SchemaField& wanted : methods[i].fields)
      EXPECT_TRUE(
          std::any_of(found.begin(), found.end(),
                      [&](const SchemaField& f) { return f.key == wanted.key && f.standard == wanted.standard; }))
          << methods[i].name << ": " << wanted.key;
  }
}

}  // namespace
}  // namespace plumbline::docs
