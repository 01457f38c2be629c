// SPDX-License-Identifier: MIT
// What this header is about is no subject.
#pragma once

// A line may be 120 columns long, as this one is ......................................................................
// A line of 121 columns is too long, as this one is ....................................................................
int a = 0;  ///< Who knows, behind code.
/// Which one is asked?
int b = 0;  // a comment that says what it is
