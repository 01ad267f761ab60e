# SPDX-License-Identifier: Apache-2.0
# cmake -DOUT=FILE.cpp -DFOLDER=FOLDER -P embed.cmake
# Writes the files of the folder as the functions that page.h declares.
cmake_minimum_required(VERSION 3.25)

set(source "// SPDX-License-Identifier: Apache-2.0\n#include \"scenarios/report/page.h\"\n\nnamespace plumbline::scenarios {\n\n")
foreach(pair page_style=style.css page_script=report.js sort_script=sort.js map_script=maps.js copy_script=copy.js
    estimate_style=estimate.css estimate_script=estimate.js)
  string(REPLACE "=" ";" pair ${pair})
  list(GET pair 0 name)
  list(GET pair 1 file)
  file(READ ${FOLDER}/${file} text)
  foreach(forbidden "</script" "</style" "<!--" ")~embed~")
    string(FIND "${text}" "${forbidden}" at)
    if(NOT at EQUAL -1)
      message(FATAL_ERROR "${file} holds ${forbidden}, which would end it")
    endif()
  endforeach()
  string(APPEND source "std::string_view ${name}() {\n  return R\"~embed~(\n${text})~embed~\";\n}\n\n")
endforeach()
file(WRITE ${OUT} "${source}}  // namespace plumbline::scenarios\n")
