# SPDX-License-Identifier: MIT
#
# find_package(kainjow_mustache): Debian's libkainjow-mustache-dev is one header without package files. Target kainjow::mustache.
find_path(PINNQUAD_MUSTACHE kainjow/mustache.hpp DOC "Folder of kainjow/mustache.hpp, for the pages of the programs")
mark_as_advanced(PINNQUAD_MUSTACHE)
if(NOT PINNQUAD_MUSTACHE)
  set(kainjow_mustache_FOUND FALSE)
  return()
endif()
if(NOT TARGET kainjow::mustache)
  add_library(kainjow::mustache INTERFACE IMPORTED GLOBAL)
  target_include_directories(kainjow::mustache INTERFACE "${PINNQUAD_MUSTACHE}")
endif()
