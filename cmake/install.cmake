# find_package(possibility) in somebody else's project.
include(CMakePackageConfigHelpers)
# The installed program finds the installed libpossibility_ode wherever the tree is moved to.
file(RELATIVE_PATH from_bin_to_lib ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
set_target_properties(possibility PROPERTIES INSTALL_RPATH "$ORIGIN/${from_bin_to_lib}")
install(EXPORT possibilityTargets NAMESPACE possibility::
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/possibility)
configure_package_config_file(cmake/possibilityConfig.cmake.in
    ${PROJECT_BINARY_DIR}/possibilityConfig.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/possibility)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/possibilityConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/possibilityConfig.cmake
              ${PROJECT_BINARY_DIR}/possibilityConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/possibility)
install(DIRECTORY models/drchubo1 DESTINATION ${CMAKE_INSTALL_DATADIR}/possibility/models)
install(DIRECTORY experiments/scenarios DESTINATION ${CMAKE_INSTALL_DATADIR}/possibility/experiments)
