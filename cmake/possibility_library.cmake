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
    # Checks of every pointer take three quarters of the compile time of Eigen's inlined code, and
    # the address sanitizer finds what they would.
    target_compile_options(${target} PRIVATE -fsanitize=${POSSIBILITY_SANITIZE}
        -fno-sanitize=null,alignment,object-size,vptr,pointer-overflow -fno-omit-frame-pointer)
    # With sanitizers GCC 12 finds members of std::optional and std::regex uninitialised that are not
    # (GCC bug 105616); the release build still warns.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
    target_link_options(${target} PRIVATE -fsanitize=${POSSIBILITY_SANITIZE})
  endif()
endfunction()

# What most files include, compiled once for all libraries.
set(possibility_precompiled_headers
    <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits>
    <map> <memory> <mutex> <numbers> <numeric> <optional> <set> <sstream> <stdexcept> <string>
    <string_view> <thread> <tuple> <unordered_map> <utility> <variant> <vector>
    <Eigen/Cholesky> <Eigen/Core> <Eigen/Geometry>)

# possibility_precompile(<target>): the headers above and <fmt/format.h>, compiled for all targets that
# reuse them.
function(possibility_precompile target)
  file(WRITE ${PROJECT_BINARY_DIR}/precompiled.cpp "")
  add_library(${target} STATIC ${PROJECT_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(${target} PRIVATE Eigen3::Eigen fmt::fmt)
  target_precompile_headers(${target} PRIVATE ${possibility_precompiled_headers} <fmt/format.h>)
  possibility_compile_options(${target})
endfunction()

# possibility_library(<target> <folder>): a static library of all sources in the folder but main.cpp,
# called possibility::<target>. Several files compile at a time: most of their time goes into templates
# of Eigen, JSON and fmt that their neighbours need too. The debug preset compiles each file by itself
# and so detects missing #include lines.
function(possibility_library target folder)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "main\\.cpp$")
  add_library(possibility_${target} STATIC ${sources})
  add_library(possibility::${target} ALIAS possibility_${target})
  if(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
    set_target_properties(possibility_${target} PROPERTIES
        UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${POSSIBILITY_FILES_AT_A_TIME})
  endif()
  target_include_directories(possibility_${target} PUBLIC
      $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/possibility>)
  target_compile_features(possibility_${target} PUBLIC cxx_std_20)
  possibility_compile_options(possibility_${target})
endfunction()

# possibility_install(<target> [<folder>]): the target and the folder's headers, for find_package.
function(possibility_install target)
  set_target_properties(possibility_${target} PROPERTIES EXPORT_NAME ${target})
  install(TARGETS possibility_${target} EXPORT possibilityTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  foreach(folder ${ARGN})
    file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.h)
    install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/possibility/${folder})
  endforeach()
endfunction()

# possibility_part(<folder> <link>...): the library of a folder inside a floor. <link>: a room or
# floor that it includes from (as a folder), or a target.
function(possibility_part folder)
  string(REPLACE / _ target ${folder})
  possibility_library(${target} ${folder})
  set(links ${ARGN})
  list(TRANSFORM links REPLACE "^([a-z]+)/([a-z]+)$" "possibility::\\1_\\2")
  list(TRANSFORM links REPLACE "^common$" possibility::common)
  target_link_libraries(possibility_${target} PUBLIC Eigen3::Eigen fmt::fmt Threads::Threads ${links})
  target_precompile_headers(possibility_${target} REUSE_FROM possibility_precompiled)
endfunction()

# possibility_room(<folder> <link>...): the same, installed.
function(possibility_room folder)
  possibility_part(${folder} ${ARGN})
  string(REPLACE / _ target ${folder})
  possibility_install(${target} ${folder})
endfunction()

# possibility_floor(<floor> <room>...): all rooms of a floor together, as possibility::<floor>.
function(possibility_floor floor)
  set(rooms ${ARGN})
  list(TRANSFORM rooms PREPEND possibility::${floor}_)
  add_library(possibility_${floor} INTERFACE)
  add_library(possibility::${floor} ALIAS possibility_${floor})
  target_link_libraries(possibility_${floor} INTERFACE ${rooms})
  possibility_install(${floor})
endfunction()
