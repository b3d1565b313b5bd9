# `cmake --build ... --target reference`: the pages of the public headers, by Debian's doxygen. Left
# out without it.
find_program(POSSIBILITY_DOXYGEN doxygen)
mark_as_advanced(POSSIBILITY_DOXYGEN)
if(POSSIBILITY_DOXYGEN)
  configure_file(docs/Doxyfile ${PROJECT_BINARY_DIR}/Doxyfile @ONLY)
  add_custom_target(reference COMMAND ${POSSIBILITY_DOXYGEN} ${PROJECT_BINARY_DIR}/Doxyfile
                    COMMENT "Writing ${PROJECT_BINARY_DIR}/reference/html/index.html" VERBATIM)
else()
  message(STATUS "doxygen is not installed: the target reference is left out")
endif()
