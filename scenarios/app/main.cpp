// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/program.h"

int main(int argc, char** argv) { return plumbline::scenarios::run_program(argc, argv); }
