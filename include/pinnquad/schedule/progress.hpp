// SPDX-License-Identifier: MIT
// Where training stands, for whoever's weight or rate changes on the way.
#pragma once

namespace pinnquad {

/// Where training stands.
struct Progress {
  int epoch = 0;  ///< from 0
  int epochs = 1;
};

}  // namespace pinnquad
