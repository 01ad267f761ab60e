// SPDX-License-Identifier: Apache-2.0
#include "slam/process/shortened.h"

namespace plumbline::slam {

std::string shortened(const std::string& text, std::size_t most) {
  const auto begins = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
  std::size_t characters = 0, end = text.size();
  for (std::size_t i = 0; i < text.size(); ++i)
    if (begins(text[i]) && characters++ == most) end = i;
  if (characters <= most) return text;
  return text.substr(0, end) + "... (" + std::to_string(characters) + " characters in all)";
}

}  // namespace plumbline::slam
