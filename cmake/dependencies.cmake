# Every third-party package, all from Debian 12. Headers of each are SYSTEM.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(yaml-cpp REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)
find_package(Simbody REQUIRED)
find_package(CLI11 REQUIRED)
pkg_check_modules(urdfdom REQUIRED IMPORTED_TARGET urdfdom)
pkg_check_modules(tinyxml2 REQUIRED IMPORTED_TARGET tinyxml2)
# find_package(Bullet) would give the single-precision build.
pkg_check_modules(bullet REQUIRED IMPORTED_TARGET bullet-float64)
pkg_check_modules(muparser REQUIRED IMPORTED_TARGET muparser)
pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET libxxhash)
# Only its C++ interface: libSimTKmath exports the names of the C interface.
pkg_check_modules(ipopt REQUIRED IMPORTED_TARGET ipopt)
# The static CVODE: libSimTKmath exports symbols of its own, older copy (dynamics/CMakeLists.txt).
find_path(SUNDIALS_INCLUDE_DIR cvode/cvode.h REQUIRED)
find_library(SUNDIALS_CVODE_STATIC_LIBRARY libsundials_cvode.a REQUIRED)
if(BUILD_TESTING)
  find_package(GTest REQUIRED)
endif()
