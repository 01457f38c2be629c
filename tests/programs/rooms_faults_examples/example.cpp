// SPDX-License-Identifier: MIT
// A fault: an example that includes the program.
#include "low/first.hpp"
