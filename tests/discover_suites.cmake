# SPDX-License-Identifier: Apache-2.0
# Writes the tests of an executable for ctest, a process a suite: starting one costs more than most cases do.
# Usage: cmake -D TEST=EXECUTABLE -D MODULE=NAME -D OUT=FILE -D RESULTS=FOLDER -D LAUNCHER=COMMAND -D PROPERTIES=LIST
#              -D COSTLY=SUITES -D APART=FILTERS -P discover_suites.cmake
# Costly suites start first. Cases that fit a filter of APART are left out: they are tests of their own.
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND ${LAUNCHER} ${TEST} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" lines "${listed}")
list(JOIN APART ":" apart)
list(JOIN PROPERTIES " " properties)
list(TRANSFORM LAUNCHER REPLACE "^(.+)$" "[==[\\1]==]")
list(JOIN LAUNCHER " " launcher)
set(text "")
foreach(line IN LISTS lines)
  if(NOT line MATCHES "^([A-Za-z0-9_/]+)\\.( *#.*)?$")
    continue()
  endif()
  set(suite ${CMAKE_MATCH_1})
  if("${suite}.*" IN_LIST APART OR "*${suite}.*" IN_LIST APART)
    continue()
  endif()
  string(REPLACE "/" "." file "${MODULE}.${suite}")
  set(cost 0)
  if(suite IN_LIST COSTLY)
    set(cost 5)
  endif()
  set(name "[==[${MODULE}.${suite}]==]")
  string(APPEND text "add_test(${name} ${launcher} [==[${TEST}]==] [==[--gtest_filter=${suite}.*-${apart}]==] "
    "[==[--gtest_output=xml:${RESULTS}/${file}.xml]==])\n"
    "set_tests_properties(${name} PROPERTIES COST ${cost} ${properties})\n")
endforeach()
file(WRITE ${OUT} "${text}")
