// SPDX-License-Identifier: Apache-2.0
// What readers of sweeps name of methods and processes. A fuzzer reads their entries, and neither builds nor starts
// one.
#include <string>
#include <vector>

#include "bim/errors.h"
#include "scenarios/host/interrupt.h"
#include "scenarios/spec/resolve.h"
#include "slam/methods.h"
#include "slam/process/process_method.h"

namespace plumbline {

namespace slam {

MethodTable methods() { return {}; }

std::unique_ptr<Method> make_process_method(const ProcessCommand& /*command*/, const MethodInput& /*input*/) {
  throw InternalError("a fuzzer starts no process");
}

}  // namespace slam

namespace scenarios {

void check_interrupt() {}

void check_methods(const std::vector<std::string>& names, const std::vector<Mark>& marks, slam::MethodTable /*table*/) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i].empty()) throw InputError(marks.at(i), "no method");
}

}  // namespace scenarios

}  // namespace plumbline
