// SPDX-License-Identifier: MIT
#pragma once
// FAULT a header has at most 14
//
//
//
//
//
//
//
//
//
//
//
//
