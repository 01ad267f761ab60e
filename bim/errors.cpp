// SPDX-License-Identifier: Apache-2.0
#include "bim/errors.h"

namespace plumbline {

std::string to_string(const Mark& mark) {
  std::string text = mark.file;
  if (mark.line > 0) text += ":" + std::to_string(mark.line);
  if (mark.line > 0 && mark.col > 0) text += ":" + std::to_string(mark.col);
  return text;
}

InputError::InputError(const Mark& mark, const std::string& message)
    : std::runtime_error(mark.file.empty() ? message : to_string(mark) + ": " + message) {}

}  // namespace plumbline
