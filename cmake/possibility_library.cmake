# One set of compile options for every target, and one library per folder.

function(possibility_compile_options target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Werror)
  # GCC 12 reports overlapping copies inside std::string that are not there (GCC bug 105329).
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
  if(POSSIBILITY_NATIVE)
    # With AVX-512 GCC 12 warns of Eigen's and its own intrinsics' headers.
    target_compile_options(${target} PRIVATE -march=native -Wno-error=array-bounds
                                             -Wno-error=maybe-uninitialized)
  endif()
  if(POSSIBILITY_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${POSSIBILITY_SANITIZE}
                                             -fno-omit-frame-pointer)
    target_link_options(${target} PRIVATE -fsanitize=${POSSIBILITY_SANITIZE})
  endif()
endfunction()

# possibility_uses_regex(<file>...): with sanitizers GCC 12 finds members of std::regex uninitialised
# that are not (GCC bug 105616).
function(possibility_uses_regex)
  if(POSSIBILITY_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS -Wno-maybe-uninitialized)
  endif()
endfunction()

# possibility_library(<folder>): a static library of all sources in the folder,
# exported as possibility::<folder>.
function(possibility_library name)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  file(GLOB headers CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.h)
  add_library(possibility_${name} STATIC ${sources})
  add_library(possibility::${name} ALIAS possibility_${name})
  set_target_properties(possibility_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(possibility_${name} PUBLIC
      $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/possibility>)
  target_compile_features(possibility_${name} PUBLIC cxx_std_20)
  possibility_compile_options(possibility_${name})
  install(TARGETS possibility_${name} EXPORT possibilityTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/possibility/${name})
endfunction()
