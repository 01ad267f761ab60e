// SPDX-License-Identifier: Apache-2.0
#include "sim/world.h"

#include "sim/route/route.h"
