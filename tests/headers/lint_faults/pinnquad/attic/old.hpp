// SPDX-License-Identifier: MIT
#pragma once
// FAULT 'attic' is no room
