# SPDX-License-Identifier: MIT
#
# Headers, exported targets, and a version file. While the major version is 0 a minor version may break users.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_DATADIR}/cmake/pinnquad")

install(DIRECTORY include/pinnquad DESTINATION include FILES_MATCHING PATTERN "*.hpp")
install(TARGETS pinnquad pinnquad_flight EXPORT pinnquadTargets)
install(EXPORT pinnquadTargets NAMESPACE pinnquad:: DESTINATION "${package_dir}")

if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(compatibility SameMinorVersion)
else()
  set(compatibility SameMajorVersion)
endif()
configure_package_config_file(cmake/pinnquadConfig.cmake.in
  "${PROJECT_BINARY_DIR}/pinnquadConfig.cmake" INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/pinnquadConfigVersion.cmake"
  COMPATIBILITY ${compatibility} ARCH_INDEPENDENT)
install(FILES
  "${PROJECT_BINARY_DIR}/pinnquadConfig.cmake"
  "${PROJECT_BINARY_DIR}/pinnquadConfigVersion.cmake"
  DESTINATION "${package_dir}")
