// SPDX-License-Identifier: MIT
// Speed as a colour: the trail, the profile and the legend share this one ramp, viridis (Smith, van der Walt and
// Firing, matplotlib, CC0), whose lightness rises evenly from slow to fast. The pictures have the same anchors
// (tools/page/viridis.hpp).

const stops = [
  [68, 1, 84],
  [72, 40, 120],
  [62, 74, 137],
  [49, 104, 142],
  [38, 130, 142],
  [31, 158, 137],
  [53, 183, 121],
  [109, 205, 89],
  [180, 222, 44],
  [253, 231, 37],
];

/** Colour at `share` of the range (0 to 1) as [r, g, b], each 0 to 255. */
export function rampColour(share) {
  const place = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(place), stops.length - 2);
  return stops[i].map((low, channel) => low + (stops[i + 1][channel] - low) * (place - i));
}

export const rampGradient = `linear-gradient(90deg, ${stops.map((stop) => `rgb(${stop})`).join(', ')})`;

/** The upper end of the scale: the fastest speed, rounded up to a whole number of ticks. */
export function scaleEnd(maxSpeed) {
  const tick = maxSpeed > 12 ? 5 : maxSpeed > 4 ? 2 : maxSpeed > 1.5 ? 1 : 0.5;
  return { end: Math.max(1, Math.ceil(maxSpeed / tick - 1e-6)) * tick, tick };
}
