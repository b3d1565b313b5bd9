# Writes a ctest file with one entry for each test suite of a GoogleTest program.
#   cmake -D program=PROGRAM -D file=FILE -D seconds=SECONDS -P list_suites.cmake
# SECONDS is what a suite may take; those of minutes may take nine times as long.
execute_process(COMMAND ${program} --gtest_list_tests OUTPUT_VARIABLE listed
                COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "[][;]" "_" listed "${listed}")
string(REPLACE "\n" ";" lines "${listed}")
set(entries "")
math(EXPR long_seconds "9 * ${seconds}")
foreach(line IN LISTS lines)
  # Tests are indented; suites of types end in a comment.
  if(NOT line MATCHES "^([^ ]+)\\.( |$)")
    continue()
  endif()
  set(suite ${CMAKE_MATCH_1})
  set(properties "TIMEOUT ${seconds}")
  if(suite MATCHES "Long(/|$)")
    set(properties "TIMEOUT ${long_seconds} LABELS long")
  endif()
  if(suite MATCHES "^Documents/")  # the longest ones begin early
    string(APPEND properties " COST 90")
  endif()
  string(APPEND entries "add_test([==[${suite}]==] [==[${program}]==] [==[--gtest_filter=${suite}.*]==])\n"
                        "set_tests_properties([==[${suite}]==] PROPERTIES ${properties})\n")
endforeach()
file(WRITE ${file} "${entries}")
