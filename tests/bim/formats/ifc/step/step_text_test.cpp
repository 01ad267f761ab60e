// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/step_text.h"

#include <gtest/gtest.h>

#include "bim/errors.h"
#include "tests/input_error.h"

namespace plumbline::bim {
namespace {

const std::string header =
    "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
    "FILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n";  // lines 1 to 7
const std::string footer = "ENDSEC;\nEND-ISO-10303-21;\n";

std::string message_of(const std::string& text) {
  return input_error([&] { (void)check_step_text(text, "f.ifc"); });
}

TEST(StepText, FindsSchemaAndLines) {
  const StepText text =
      check_step_text(header + "#2=IFCA('x;)#9',(1.,2.));\n#1= IFCB(#2,\n$,*);\n#30 =IFCC();\n" + footer, "f.ifc");
  EXPECT_EQ(text.schema, "IFC4");
  EXPECT_EQ(text.line(2), 8);
  EXPECT_EQ(text.line(1), 9);
  EXPECT_EQ(text.line(30), 11);
  EXPECT_EQ(text.line(3), 0);
}

TEST(StepText, CommentsAreBlankedAndLinesStay) {
  EXPECT_EQ(without_comments("a/* x\n'*/b '/*c*/' /**/"), "a    \n   b '/*c*/'     ");
  EXPECT_EQ(without_comments("\xEF\xBB\xBFISO"), "ISO");
  EXPECT_EQ(without_comments("a /* ; */\n ;b' ;';; ; "), "a;       \n  b' ;';;;  ");
}

TEST(StepText, CommentsBeginOutsideOfStringsOnly) {
  for (const char* text : {"a('/*');", "a('''/*');", "a('*/','/*');", "a('/*','*/');", "a('it''s /* ''*/');"})
    EXPECT_EQ(without_comments(text), text);
  EXPECT_EQ(without_comments("a('''') /* it's\n'/* */ b('/*')"), "a('''')        \n       b('/*')");
}

TEST(StepText, ACommentThatDoesNotEndIsNamedWhereItBegins) {
  const auto open = [](const std::string& text) { return message_of(without_comments(text)); };
  EXPECT_EQ(open(header + "#1=IFCA();\n/* #2=IFCB();\n" + footer), "f.ifc:9: a comment begins here and does not end");
  EXPECT_EQ(open(header + "#1=IFCA(1.,\n/*/2.);\n" + footer), "f.ifc:9: a comment begins here and does not end");
  EXPECT_EQ(open("\n/* by hand\n" + header + footer), "f.ifc:2: a comment begins here and does not end");
  EXPECT_EQ(open(header + footer + "/* the end"), "no error");
}

TEST(StepText, BlanksMayStandBeforeASemicolon) {
  std::string spaced = header + "#2=IFCA('a ;')\n;\n#1=IFCB(#2) \t;\n" + footer;
  for (std::size_t at = 0; (at = spaced.find(";\n", at)) != std::string::npos; at += 3) spaced.insert(at, " ");
  const StepText text = check_step_text(without_comments(spaced), "f.ifc");
  EXPECT_EQ(text.schema, "IFC4");
  EXPECT_EQ(text.line(2), 8);
  EXPECT_EQ(text.line(1), 10);
}

TEST(StepText, SaysWhereTheTextIsWrong) {
  const auto wrong = [](const std::string& data) { return message_of(header + data + footer); };
  EXPECT_EQ(wrong("#1=IFCA();\n#1=IFCB();\n"), "f.ifc:9: #1 is defined twice");
  EXPECT_EQ(wrong("#1=IFCA(#2);\n#2=IFCB(#1);\n"), "f.ifc:9: #2 refers to itself by way of #1");
  EXPECT_EQ(wrong("#1=IFCA(#1);\n"), "f.ifc:8: #1 refers to itself by way of #1");
  EXPECT_EQ(wrong("#1=IFCA((1.);\n"), "f.ifc:8: a semicolon within brackets");
  EXPECT_EQ(wrong("#1=IFCA(1.));\n"), "f.ifc:8: a closing bracket without its opening one");
  EXPECT_EQ(wrong("IFCA(1.);\n"), "f.ifc:8: expected an entity such as #1=IFCWALL(...);, not 'IFCA(1.)'");
  EXPECT_EQ(message_of("Dear Sir,\n"),
            "f.ifc:1: not an IFC file: it should begin with ISO-10303-21;, not with 'Dear Sir,?'");
  EXPECT_EQ(message_of(" \n"), "f.ifc: the file is empty; an IFC file begins with ISO-10303-21;");
  EXPECT_EQ(message_of("ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('AP214'));\nENDSEC;\n"),
            "f.ifc:4: schema 'AP214' is not IFC; IFC2X3 and IFC4 are read");
}

TEST(StepText, ListsReferencesThatLeadNowhereAndWhatDependsOnThem) {
  const StepText text = check_step_text(
      header + "#1=IFCA(#2,#9);\n#2=IFCOWNERHISTORY(#8);\n#3=IFCB(#1);\n#4=IFCC(#2);\n" + footer, "f.ifc");
  const std::vector<std::pair<std::int64_t, std::int64_t>> dangling = {{1, 9}, {2, 8}};
  EXPECT_EQ(text.dangling, dangling);
  EXPECT_EQ(text.missing(1), 9);
  EXPECT_EQ(text.missing(3), 9);
  EXPECT_EQ(text.missing(2), 0);
  EXPECT_EQ(text.missing(4), 0);
}

TEST(StepText, RefusesWhatWouldExhaustTheStack) {
  const std::string deep = "#1=IFCA(" + std::string(100000, '(') + std::string(100000, ')') + ");\n";
  EXPECT_EQ(message_of(header + deep + footer), "f.ifc:8: brackets nested deeper than 64");
  std::string chain = "#1=IFCA();\n";
  for (int i = 2; i <= 2000; ++i) chain += "#" + std::to_string(i) + "=IFCA(#" + std::to_string(i - 1) + ");\n";
  EXPECT_EQ(message_of(header + chain + footer), "f.ifc:1009: #1002 refers through more than 1000 entities in a row");
}

TEST(StepText, EveryCutIsNoticedAndItsLineNamed) {
  const std::string whole = header + "#1=IFCA('a\nb',(1.,#2));\n#2=IFCB();\n" + footer;
  EXPECT_NO_THROW((void)check_step_text(whole, "f.ifc"));
  // Without its last line break the file is still whole.
  for (std::size_t length = 1; length + 1 < whole.size(); ++length) {
    const std::string cut = whole.substr(0, length);
    const auto line = 1 + std::count(cut.begin(), cut.end(), '\n');
    const std::string where = cut.back() == '\n' ? "before" : "in the middle of";
    EXPECT_EQ(message_of(cut), "f.ifc:" + std::to_string(line) + ": the file ends " + where + " line " +
                                   std::to_string(line) + "; an IFC file ends with END-ISO-10303-21;")
        << length;
  }
}

}  // namespace
}  // namespace plumbline::bim
