// SPDX-License-Identifier: Apache-2.0
#include "scenarios/report/page.h"

#include "scenarios/report/palette.h"
#include "scenarios/report/svg.h"

namespace plumbline::scenarios {

std::string open_page(const std::string& title) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; "
         "style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'\">"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\"><title>" +
         svg::escape(title) + " · Plumbline</title><style>" + palette_css() + std::string(page_style()) +
         "</style></head>\n<body><main>";
}

}  // namespace plumbline::scenarios
