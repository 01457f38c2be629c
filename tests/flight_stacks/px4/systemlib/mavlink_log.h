// SPDX-License-Identifier: MIT
#pragma once
#include "px4.hpp"
