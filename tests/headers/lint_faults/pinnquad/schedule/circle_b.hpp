// SPDX-License-Identifier: MIT
#pragma once
#include <pinnquad/schedule/circle_a.hpp>
