// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ios>
#include <string>

namespace plumbline::bim {

/// During its lifetime IFC++ and Carve write to no stream and read numbers with a decimal point, and what they set is
/// put back: streams' buffers and the C locale are the process's, so only one may live at a time.
class ScopedSilence {
 public:
  ScopedSilence();
  ~ScopedSilence();
  ScopedSilence(const ScopedSilence&) = delete;
  ScopedSilence& operator=(const ScopedSilence&) = delete;

 private:
  std::string locale_;
  std::streambuf* out_;
  std::streambuf* error_;
  std::wstreambuf* wide_out_;
};

}  // namespace plumbline::bim
