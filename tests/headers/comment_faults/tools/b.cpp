// SPDX-License-Identifier: MIT
/* Whose is it? */
// CASE a pattern may be long, for it is matched as it stands, and that is not a comment which anybody reads as a sentence of ours
int c = 0;
  //< Whatever it is, it is its own subject.
