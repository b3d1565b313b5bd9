# Writes a C++ source that holds the viewer's files and the three.js library as strings.
#   cmake -D THREE_DIR=... -D OUTPUT=... -P embed.cmake
# THREE_DIR: the folder of the Debian package libjs-three that has build/ and examples/.
set(resources
    page ${CMAKE_CURRENT_LIST_DIR}/page.html
    style ${CMAKE_CURRENT_LIST_DIR}/style.css
    kinematics ${CMAKE_CURRENT_LIST_DIR}/kinematics.js
    barrier ${CMAKE_CURRENT_LIST_DIR}/barrier.js
    drawing ${CMAKE_CURRENT_LIST_DIR}/drawing.js
    jumps ${CMAKE_CURRENT_LIST_DIR}/jumps.js
    balance ${CMAKE_CURRENT_LIST_DIR}/balance.js
    timeline ${CMAKE_CURRENT_LIST_DIR}/timeline.js
    curves ${CMAKE_CURRENT_LIST_DIR}/curves.js
    plots ${CMAKE_CURRENT_LIST_DIR}/plots.js
    player ${CMAKE_CURRENT_LIST_DIR}/player.js
    three ${THREE_DIR}/build/three.min.js
    convex_hull ${THREE_DIR}/examples/js/math/ConvexHull.js
    convex_geometry ${THREE_DIR}/examples/js/geometries/ConvexGeometry.js
    orbit_controls ${THREE_DIR}/examples/js/controls/OrbitControls.js)

set(delimiter "resource_text")
set(source "#include \"experiments/viewer/viewer_resources.h\"\n\n")
string(APPEND source "namespace possibility::experiments::viewer_resources {\n")
while(resources)
  list(POP_FRONT resources name path)
  if(NOT EXISTS "${path}")
    message(FATAL_ERROR "${path} is missing (three.js comes with the Debian package libjs-three)")
  endif()
  file(READ "${path}" text)
  string(FIND "${text}" ")${delimiter}\"" clash)
  if(NOT clash EQUAL -1)
    message(FATAL_ERROR "${path} contains the raw-string delimiter ${delimiter}")
  endif()
  string(APPEND source "extern const std::string_view ${name} = ")
  string(APPEND source "R\"${delimiter}(" "${text}" ")${delimiter}\";\n")
endwhile()
string(APPEND source "}  // namespace possibility::experiments::viewer_resources\n")
file(WRITE "${OUTPUT}" "${source}")
