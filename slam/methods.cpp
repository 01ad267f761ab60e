// SPDX-License-Identifier: Apache-2.0
#include "slam/methods.h"
