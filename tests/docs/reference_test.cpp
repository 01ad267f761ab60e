// SPDX-License-Identifier: Apache-2.0
#include "tests/docs/reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "bim/config/tree.h"
#include "bim/model/warning.h"
#include "scenarios/metrics/metrics.h"

namespace plumbline::docs {
namespace {

namespace fs = std::filesystem;

constexpr const char* renew = "renew it with: build/release/tests/plumbline_reference docs/reference";

std::string source() {
  const char* folder = std::getenv("PLUMBLINE_SOURCE");
  return folder == nullptr ? "." : folder;
}

/// Cells of a table's row.
std::size_t cells(const std::string& line) {
  std::size_t count = 0;
  for (std::size_t i = 1; i < line.size(); ++i)
    if (line[i] == '|' && line[i - 1] != '\\') ++count;
  return count;
}

TEST(Reference, ThePagesAreThoseOfThisProgram) {
  for (const Page& page : reference_pages()) {
    const std::string path = source() + "/docs/reference/" + page.file;
    ASSERT_TRUE(fs::exists(path)) << path << ": " << renew;
    EXPECT_TRUE(read_text_file(path) == page.text) << path << ": " << renew;
  }
}

TEST(Reference, NoOtherPageIsThere) {
  const std::vector<Page> pages = reference_pages();
  for (const fs::directory_entry& entry : fs::directory_iterator(source() + "/docs/reference")) {
    const std::string file = entry.path().filename().string();
    EXPECT_TRUE(std::any_of(pages.begin(), pages.end(), [&](const Page& page) { return page.file == file; })) << file;
  }
}

TEST(Reference, EveryRowOfATableHasTheCellsOfItsHead) {
  for (const Page& page : reference_pages()) {
    std::istringstream lines(page.text);
    std::size_t head = 0;
    for (std::string line; std::getline(lines, line);) {
      if (line.empty() || line[0] != '|') {
        head = 0;
        continue;
      }
      if (head == 0) head = cells(line);
      EXPECT_EQ(cells(line), head) << page.file << ": " << line;
    }
  }
}

TEST(Reference, EveryMetricAndWarningIsDescribed) {
  for (const scenarios::score::MetricRow& row : scenarios::score::metrics()) EXPECT_FALSE(row.doc.empty()) << row.name;
  for (const bim::WarningRow& row : bim::warning_rows) EXPECT_FALSE(row.doc.empty()) << row.kind;
}

/// The compiler refuses a warning of an unknown kind; this finds kinds that nothing gives.
TEST(Reference, EveryKindOfWarningIsGivenSomewhere) {
  std::string sources;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(source() + "/bim"))
    if (entry.path().extension() == ".cpp") sources += read_text_file(entry.path().string());
  for (const bim::WarningRow& row : bim::warning_rows)
    EXPECT_NE(sources.find('"' + std::string(row.kind) + '"'), std::string::npos) << row.kind;
}

}  // namespace
}  // namespace plumbline::docs
