# SPDX-License-Identifier: MIT
#
# Headers, exported targets, and a version file; for pkg-config; as a Debian package (cpack). While the major version is 0 a minor version may break users.
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
  cmake/pinnquadCompiled.cmake
  DESTINATION "${package_dir}")

configure_file(cmake/pinnquad.pc.in "${PROJECT_BINARY_DIR}/pinnquad.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/pinnquad.pc" DESTINATION "${CMAKE_INSTALL_DATADIR}/pkgconfig")

# `cpack` in a build tree: a .deb of what it would install, the program too where it is built
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "pinnquad")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
if(PINNQUAD_BUILD_TOOLS)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
else()
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE all)
endif()
include(CPack)
