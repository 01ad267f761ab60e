// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>

#include "bim/errors.h"
#include "slam/io/clouds/cloud_file.h"
#include "slam/io/packets/point_cloud.h"
#include "tests/folder.h"

/// The first byte chooses the format of a file of points; it can be read, or is an InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const plumbline::Folder folder;
  if (size == 0) return 0;
  const std::string file = folder / (data[0] % 2 == 0 ? "fuzz.pcd" : "fuzz.ply");
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data + 1), static_cast<std::streamsize>(size - 1));
  try {
    const plumbline::slam::PointCloud cloud = plumbline::slam::read_cloud_file(file);
    (void)plumbline::slam::points_of(cloud, {});
    (void)plumbline::slam::scan_of(cloud);
  } catch (const plumbline::InputError&) {
  }
  return 0;
}
