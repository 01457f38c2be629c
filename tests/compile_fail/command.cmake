# SPDX-License-Identifier: MIT
#
# The command that precompiles and that compiles a case: they must be alike.
set(command "${COMPILER}" -std=c++17 -fmessage-length=0 -fno-diagnostics-color
  "-I${INCLUDE_DIR}" -isystem "${EIGEN_INCLUDE_DIR}")
