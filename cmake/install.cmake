# find_package(possibility) in somebody else's project.
include(CMakePackageConfigHelpers)
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
