/* SPDX-License-Identifier: MIT */
#include "firmware.h"
