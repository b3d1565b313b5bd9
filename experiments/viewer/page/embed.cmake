# Writes a C++ source that holds the viewer's files and the three.js library as strings.
#   cmake -D THREE_DIR=... -D OUTPUT=... -P embed.cmake
# THREE_DIR: the folder of the Debian package libjs-three that has build/ and examples/.
set(viewer ${CMAKE_CURRENT_LIST_DIR})
# The page's own scripts, in the order in which they use each other.
set(scripts kinematics merging meshes routes barrier drawing jumps balance curves timeline margin_plots plots plan_view
    legend keys player)
set(resources
    page ${viewer}/page.html
    style ${viewer}/style.css
    three ${THREE_DIR}/build/three.min.js
    convex_hull ${THREE_DIR}/examples/js/math/ConvexHull.js
    convex_geometry ${THREE_DIR}/examples/js/geometries/ConvexGeometry.js
    orbit_controls ${THREE_DIR}/examples/js/controls/OrbitControls.js)

set(delimiter "resource_text")
set(source "#include \"experiments/viewer/viewer_resources.h\"\n\n")
string(APPEND source "namespace possibility::experiments::viewer_resources {\n")

# append_resource(<name> <text>)
function(append_resource name text)
  string(FIND "${text}" ")${delimiter}\"" clash)
  if(NOT clash EQUAL -1)
    message(FATAL_ERROR "${name} contains the raw-string delimiter ${delimiter}")
  endif()
  string(APPEND source "extern const std::string_view ${name} = ")
  string(APPEND source "R\"${delimiter}(" "${text}" ")${delimiter}\";\n")
  set(source "${source}" PARENT_SCOPE)
endfunction()

while(resources)
  list(POP_FRONT resources name path)
  if(NOT EXISTS "${path}")
    message(FATAL_ERROR "${path} is missing (three.js comes with the Debian package libjs-three)")
  endif()
  file(READ "${path}" text)
  append_resource(${name} "${text}")
endwhile()
set(joined "")
foreach(script ${scripts})
  file(READ ${viewer}/${script}.js text)
  string(APPEND joined "${text}")
endforeach()
append_resource(scripts "${joined}")
string(APPEND source "}  // namespace possibility::experiments::viewer_resources\n")
file(WRITE "${OUTPUT}" "${source}")
