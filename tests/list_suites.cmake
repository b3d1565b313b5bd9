# Writes a ctest file with one entry for each test suite of a GoogleTest program.
#   cmake -D program=PROGRAM -D file=FILE -P list_suites.cmake
execute_process(COMMAND ${program} --gtest_list_tests OUTPUT_VARIABLE listed
                COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "[][;]" "_" listed "${listed}")
string(REPLACE "\n" ";" lines "${listed}")
set(entries "")
foreach(line IN LISTS lines)
  # Tests are indented; suites of types end in a comment.
  if(NOT line MATCHES "^([^ ]+)\\.( |$)")
    continue()
  endif()
  set(suite ${CMAKE_MATCH_1})
  set(properties "TIMEOUT 600")
  if(suite MATCHES "Long(/|$)")
    set(properties "TIMEOUT 5400 LABELS long")
  endif()
  if(suite MATCHES "^Documents/")  # the longest ones begin early
    string(APPEND properties " COST 90")
  endif()
  string(APPEND entries "add_test([==[${suite}]==] [==[${program}]==] [==[--gtest_filter=${suite}.*]==])\n"
                        "set_tests_properties([==[${suite}]==] PROPERTIES ${properties})\n")
endforeach()
file(WRITE ${file} "${entries}")
