// SPDX-License-Identifier: MIT
#pragma once
// FAULT include each other in a circle
#include <pinnquad/schedule/circle_b.hpp>
