// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/estimate/page_file.h"

#include "scenarios/host/files.h"
#include "scenarios/report/estimate/estimate_builder.h"

namespace plumbline::scenarios {

std::string estimate_page(const std::string& dir, const std::vector<std::string>& altered,
                          const std::optional<NewScore>& fresh) {
  EstimatePage page = read_estimate_page(dir, fresh);
  page.altered = altered;
  return render_estimate(page);
}

void write_estimate_page(const std::string& dir) {
  write_file(dir + "/" + std::string(estimate_page_name), estimate_page(dir));
}

}  // namespace plumbline::scenarios
