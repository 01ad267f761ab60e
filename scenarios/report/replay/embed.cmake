# SPDX-License-Identifier: Apache-2.0
# cmake -DOUT=FILE.cpp -DSTYLE=FILE -DLIBRARY=FILE -DSCRIPTS=FILE,FILE,... -P embed.cmake
# Writes the files as the string literals that assets.h declares.
cmake_minimum_required(VERSION 3.25)

set(source "// SPDX-License-Identifier: Apache-2.0\n#include \"scenarios/report/replay/assets.h\"\n\nnamespace plumbline::scenarios {\n\n")

function(embed name)
  set(text "\n")
  foreach(file IN LISTS ARGN)
    file(READ ${file} one)
    foreach(forbidden "</script" "<!--" ")~embed~")
      string(FIND "${one}" "${forbidden}" at)
      if(NOT at EQUAL -1)
        message(FATAL_ERROR "${file} holds ${forbidden}, which would end it")
      endif()
    endforeach()
    string(APPEND text "${one}")
  endforeach()
  string(SHA256 hash "${text}")
  set(source "${source}const ReplayAsset ${name} = {R\"~embed~(${text})~embed~\", \"${hash}\"};\n" PARENT_SCOPE)
endfunction()

string(REPLACE "," ";" scripts "${SCRIPTS}")
embed(replay_style ${STYLE})
embed(replay_library ${LIBRARY})
embed(replay_script ${scripts})
file(WRITE ${OUT} "${source}\n}  // namespace plumbline::scenarios\n")
