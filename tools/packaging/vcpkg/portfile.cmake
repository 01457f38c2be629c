# An overlay port beside a clone: vcpkg install pinnquad --overlay-ports=OUT, with PINNQUAD_SOURCE_DIR in the environment.
set(SOURCE_PATH "$ENV{PINNQUAD_SOURCE_DIR}")
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}" OPTIONS
  -DPINNQUAD_BUILD_TESTS=OFF -DPINNQUAD_BUILD_EXAMPLES=OFF -DPINNQUAD_BUILD_TOOLS=OFF -DPINNQUAD_BUILD_LOGS=OFF -DPINNQUAD_BUILD_BENCH=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH share/cmake/pinnquad)
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
set(VCPKG_POLICY_EMPTY_INCLUDE_FOLDER disabled)
