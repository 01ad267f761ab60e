// SPDX-License-Identifier: Apache-2.0
// The readers of tests/fuzz with their seeds, as they are and altered at random: each is read or refused. ci/fuzz looks
// for longer, by what an input reaches, and with sanitizers.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "bim/random/stream.h"
#include "tests/data.h"
#include "tests/malformed/readers.h"
#include "tests/sanitized.h"

namespace plumbline {
namespace {

namespace fs = std::filesystem;

using Bytes = std::string;

std::vector<Bytes> seeds_of(const std::string& reader) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(project_file("tests/fuzz/seeds/" + reader))) files.push_back(entry);
  std::sort(files.begin(), files.end());
  std::vector<Bytes> seeds;
  for (const fs::path& file : files) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    seeds.push_back(text.str());
  }
  return seeds;
}

/// Draws in order, from one stream.
class Dice {
 public:
  explicit Dice(std::uint64_t variant) : variant_(variant) {}
  /// In [0, n).
  std::size_t below(std::size_t n) { return stream_.bits(variant_, 0, draw_++) % n; }

 private:
  Stream stream_{1, "bim.generate"};
  std::uint64_t variant_;
  std::uint32_t draw_ = 0;
};

void put(Bytes& bytes, std::size_t at, const Bytes& what) {
  bytes.replace(at, std::min(what.size(), bytes.size() - at), what);
}

/// One to four alterations: bytes set, lengths and numbers made extreme, a piece cut off, left out, doubled or
/// another's.
Bytes altered(Bytes bytes, const Bytes& other, Dice& dice) {
  static const std::array<Bytes, 4> lengths = {Bytes(4, '\xff'), Bytes("\xff\xff\xff\x7f"), Bytes(4, '\0'),
                                               Bytes(8, '\xff')};
  static const std::array<Bytes, 7> words = {"-1", "1e308", "nan", "99999999999999999999", "0", "{", "'"};
  for (std::size_t left = 1 + dice.below(4); left > 0 && !bytes.empty(); --left) {
    const std::size_t at = dice.below(bytes.size()),
                      length = 1 + dice.below(std::min<std::size_t>(64, bytes.size() - at));
    switch (dice.below(8)) {
      case 0:
        bytes.resize(at);
        break;
      case 1:
        bytes.erase(at, length);
        break;
      case 2:
        bytes.insert(at, Bytes(bytes, at, length));
        break;
      case 3:
        put(bytes, at, lengths.at(dice.below(lengths.size())));
        break;
      case 4: {
        const std::size_t digit = bytes.find_first_of("0123456789", at);
        if (digit == Bytes::npos) break;
        const std::size_t end = std::min(bytes.find_first_not_of("0123456789.eE+-", digit), bytes.size());
        bytes.replace(digit, end - digit, words.at(dice.below(words.size())));
        break;
      }
      case 5:
        if (!other.empty()) put(bytes, at, other.substr(dice.below(other.size()), length));
        break;
      case 6:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << dice.below(8)));
        break;
      default:
        bytes[at] = static_cast<char>(dice.below(256));
    }
  }
  return bytes;
}

class Malformed : public ::testing::TestWithParam<MalformedReader> {
 protected:
  /// A length that is believed ends as an exception, not as a machine without memory. Sanitizers map more than that.
  void SetUp() override {
    const rlimit limit{rlim_t{4} << 30U, rlim_t{4} << 30U};
    if (!is_sanitized) ASSERT_EQ(setrlimit(RLIMIT_AS, &limit), 0);
  }

  /// What ends the process stays behind in a file, for ci/fuzz.
  void read(const Bytes& bytes) {
    std::ofstream(last_, std::ios::binary) << bytes;
    EXPECT_EQ(GetParam().read(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()), 0);
  }

  void TearDown() override {
    if (!HasFailure()) fs::remove(last_);
  }

  std::string last_ = (fs::temp_directory_path() / (std::string("plumbline_malformed_") + GetParam().name)).string();
};

TEST_P(Malformed, SeedsAreReadOrRefused) {
  const std::vector<Bytes> seeds = seeds_of(GetParam().name);
  ASSERT_FALSE(seeds.empty());
  for (const Bytes& seed : seeds) ASSERT_NO_THROW(read(seed)) << last_;
}

TEST_P(Malformed, AlteredSeedsAreReadOrRefused) {
  const std::vector<Bytes> seeds = seeds_of(GetParam().name);
  for (std::uint64_t variant = 0; variant < static_cast<std::uint64_t>(GetParam().variants); ++variant) {
    Dice dice(variant);
    const Bytes &seed = seeds.at(dice.below(seeds.size())), &other = seeds.at(dice.below(seeds.size()));
    ASSERT_NO_THROW(read(altered(seed, other, dice))) << "variant " << variant << ": " << last_;
  }
}

INSTANTIATE_TEST_SUITE_P(Readers, Malformed, ::testing::ValuesIn(malformed_readers),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace plumbline
