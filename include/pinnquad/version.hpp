// SPDX-License-Identifier: MIT
// The version of the library, and the only place that states one: CMake reads the three numbers below for the project
// and for the package's version file. Nothing else may repeat them.
#pragma once

#define PINNQUAD_VERSION_MAJOR 0
#define PINNQUAD_VERSION_MINOR 3
#define PINNQUAD_VERSION_PATCH 0

#define PINNQUAD_DETAIL_TEXT_OF(number) #number
#define PINNQUAD_DETAIL_VERSION_TEXT(major, minor, patch) \
  PINNQUAD_DETAIL_TEXT_OF(major) "." PINNQUAD_DETAIL_TEXT_OF(minor) "." PINNQUAD_DETAIL_TEXT_OF(patch)

/// The version as text, "major.minor.patch".
#define PINNQUAD_VERSION \
  PINNQUAD_DETAIL_VERSION_TEXT(PINNQUAD_VERSION_MAJOR, PINNQUAD_VERSION_MINOR, PINNQUAD_VERSION_PATCH)
