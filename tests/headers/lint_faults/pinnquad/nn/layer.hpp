// SPDX-License-Identifier: MIT
#pragma once
// FAULT write <pinnquad/...>
#include "dense.hpp"
