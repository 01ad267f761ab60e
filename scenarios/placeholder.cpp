// SPDX-License-Identifier: Apache-2.0
#include "slam/planes/detect.h"
