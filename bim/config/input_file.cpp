// SPDX-License-Identifier: Apache-2.0
#include "bim/config/input_file.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "bim/errors.h"

namespace plumbline {

namespace {

[[noreturn]] void fail_to_read(const Mark& mark, int error) {
  if (error == ENOENT || error == ENOTDIR) throw InputError(mark, "no such file");
  throw InputError(mark, std::string("cannot be read: ") + std::strerror(error));
}

}  // namespace

InputFile open_input_file(const std::string& path, std::uint64_t most_bytes) {
  const Mark mark{path, 0, 0};
  InputFile file;
  file.stream.reset(std::fopen(path.c_str(), "rbe"));
  if (!file.stream) fail_to_read(mark, errno);
  struct stat status {};
  if (::fstat(::fileno(file.stream.get()), &status) != 0) fail_to_read(mark, errno);
  if (S_ISDIR(status.st_mode)) throw InputError(mark, "is a directory; a file is expected");
  file.regular = S_ISREG(status.st_mode);
  if (file.regular) file.bytes = static_cast<std::uint64_t>(status.st_size);
  if (file.bytes > most_bytes)
    throw InputError(
        mark, "holds " + std::to_string(file.bytes) + " bytes; at most " + std::to_string(most_bytes) + " are read");
  return file;
}

std::string read_text_file(const std::string& path, std::uint64_t most_bytes) {
  const Mark mark{path, 0, 0};
  const InputFile file = open_input_file(path, most_bytes);
  std::string text;
  text.reserve(static_cast<std::size_t>(file.bytes));
  std::vector<char> buffer(std::size_t{1} << 16U);
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), file.stream.get())) {
    if (text.size() + n > most_bytes)
      throw InputError(mark, "larger than the " + std::to_string(most_bytes) + " bytes that are read at most");
    text.append(buffer.data(), n);
  }
  if (std::ferror(file.stream.get()) != 0) fail_to_read(mark, errno);
  if (text.empty()) throw InputError(mark, "the file is empty");
  return text;
}

}  // namespace plumbline
