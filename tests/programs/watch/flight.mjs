// SPDX-License-Identifier: MIT
// The flight that the browser test watches: its own rows, which did not go through the page.
import { readFileSync } from 'node:fs';

import { given } from './opened_page.mjs';

const [csv, givenTitle] = given;
export const title = givenTitle;
export const rows = readFileSync(csv, 'utf8')
  .trim()
  .split('\n')
  .slice(1)
  .map((line) => {
    const [t, north, east, down, vNorth, vEast, vDown, w, x, y, z, ...commands] = line.split(',').map(Number);
    return { t, north, east, down, velocity: [vNorth, vEast, vDown], q: [w, x, y, z], commands };
  });
