// SPDX-License-Identifier: Apache-2.0
#include "bim/formats/ifc/step/scoped_silence.h"

#include <clocale>
#include <iostream>

namespace plumbline::bim {

ScopedSilence::ScopedSilence()
    : locale_(std::setlocale(LC_ALL, nullptr)),
      out_(std::cout.rdbuf(nullptr)),
      error_(std::cerr.rdbuf(nullptr)),
      wide_out_(std::wcout.rdbuf(nullptr)) {
  std::setlocale(LC_ALL, "C");
}

ScopedSilence::~ScopedSilence() {
  std::setlocale(LC_ALL, locale_.c_str());
  // rdbuf() also clears the error state that writing to no buffer has left.
  std::cout.rdbuf(out_);
  std::cerr.rdbuf(error_);
  std::wcout.rdbuf(wide_out_);
}

}  // namespace plumbline::bim
