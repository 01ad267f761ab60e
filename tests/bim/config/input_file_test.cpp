// SPDX-License-Identifier: Apache-2.0
#include "bim/config/input_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>

#include "bim/errors.h"
#include "tests/folder.h"
#include "tests/input_error.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

class InputFileTest : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  static std::string complaint(const std::string& path, std::uint64_t most = 100) {
    return input_error([&] { static_cast<void>(read_text_file(path, most)); });
  }

  Folder folder_;
};

TEST_F(InputFileTest, GivesEveryByte) {
  const std::string text("a\0\r\n\xff", 5);
  EXPECT_EQ(read_text_file(write("a", text)), text);
  const std::string large(300'000, 'x');
  EXPECT_EQ(read_text_file(write("large", large), large.size()), large);
  const InputFile file = open_input_file(folder_ / "a");
  EXPECT_TRUE(file.regular);
  EXPECT_EQ(file.bytes, text.size());
}

TEST_F(InputFileTest, SaysWhatIsWrong) {
  EXPECT_EQ(complaint(folder_ / "none"), (folder_ / "none") + ": no such file");
  EXPECT_EQ(complaint(write("a", "x") + "/b"), (folder_ / "a/b") + ": no such file");
  EXPECT_EQ(complaint(folder_.path()), folder_.path() + ": is a directory; a file is expected");
  EXPECT_EQ(complaint(write("empty", "")), (folder_ / "empty") + ": the file is empty");
  EXPECT_NE(complaint(folder_ / std::string(300, 'n')).find("cannot be read: "), std::string::npos);
  EXPECT_EQ(complaint(write("long", std::string(101, 'x'))),
            (folder_ / "long") + ": holds 101 bytes; at most 100 are read");
  EXPECT_NE(complaint("/dev/zero").find("larger than the 100 bytes"), std::string::npos);
}

/// Of 20 GB that are nothing but a hole no byte is read.
TEST_F(InputFileTest, ASparseFileIsRefusedByItsSize) {
  const std::string path = write("sparse", "");
  std::error_code error;
  fs::resize_file(path, std::uintmax_t{20} << 30U, error);
  if (error) GTEST_SKIP() << "no file of 20 GB here: " << error.message();
  rusage before{}, after{};
  ::getrusage(RUSAGE_SELF, &before);
  EXPECT_EQ(input_error([&] { static_cast<void>(read_text_file(path)); }),
            path + ": holds 21474836480 bytes; at most 1073741824 are read");
  ::getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 10'000);  // kB
}

}  // namespace
}  // namespace plumbline
