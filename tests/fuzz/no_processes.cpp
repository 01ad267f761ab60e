// SPDX-License-Identifier: Apache-2.0
// What readers of sweeps name of processes. A fuzzer reads their entries and starts none.
#include "bim/errors.h"
#include "scenarios/host/interrupt.h"
#include "slam/process/process_method.h"

namespace plumbline {

namespace slam {

std::unique_ptr<Method> make_process_method(const ProcessCommand& /*command*/, const MethodInput& /*input*/) {
  throw InternalError("a fuzzer starts no process");
}

}  // namespace slam

namespace scenarios {

void check_interrupt() {}

}  // namespace scenarios

}  // namespace plumbline
