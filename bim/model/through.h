// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bim/model/building.h"

namespace plumbline::bim {

struct ThroughConfig {
  double depth_m = 2e-3;   ///< an opening that stops this much before a face still goes through
  double short_m = 0.06;   ///< a door's opening that ends up to this short of the faces is meant to go through
  double behind_m = 0.3;   ///< material this near behind an opening closes it; cavities have up to 0.2 m (assumed)
  double widest_deg = 75;  ///< between the way through a curved wall and the normal of its reference line
};

/// False for a niche: what the opening leaves of its wall closes it. Plain rectangles always go through.
[[nodiscard]] bool goes_through(const Opening& opening, const Wall& wall, const ThroughConfig& config = {});

/// Whether the opening is open on a side of its wall (0: left of a to b): a niche is on one, or on none.
[[nodiscard]] bool opens_on(const Opening& opening, const Wall& wall, int side, const ThroughConfig& config = {});

/// Extends an opening that ends a little before a face of its wall to that face. Returns how much it was short, m; 0
/// where nothing changed.
double extend_through(Opening& opening, const Wall& wall, const ThroughConfig& config = {});

}  // namespace plumbline::bim
