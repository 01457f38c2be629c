// SPDX-License-Identifier: MIT
// See declarations.hpp.
#include "declarations.hpp"
