// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "slam/io/records.h"

namespace plumbline::slam {

/// Puts something before what a scan saw: share_to(x, y, z) is the share of a ray to a return at that point of L after
/// which it meets the thing; 1 or more where it does not.
template <class ShareTo>
void shorten_rays(Scan& scan, const ShareTo& share_to) {
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const double* const p = scan.point_L[i].data();
    const double share = share_to(p[0], p[1], p[2]);
    if (share >= 1.0) continue;
    scan.range_m[i] *= share;
    scan.point_L[i] *= share;
  }
}

}  // namespace plumbline::slam
