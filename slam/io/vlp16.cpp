// SPDX-License-Identifier: Apache-2.0
#include "slam/io/vlp16.h"
