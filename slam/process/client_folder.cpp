// SPDX-License-Identifier: Apache-2.0
#include "slam/process/client_folder.h"

#include "bim/config/installed_folder.h"

namespace plumbline::slam {

std::string client_folder() {
  return installed_folder({"../share/plumbline/client", "../../slam/process/client", "../../../slam/process/client"},
                          "plumbline_client.py");
}

}  // namespace plumbline::slam
