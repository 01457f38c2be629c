// SPDX-License-Identifier: MIT
#pragma once
// Clean: what may not fly may allocate, and schedule comes before loss.
#include <pinnquad/schedule/constant.hpp>

#include <vector>
