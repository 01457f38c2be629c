// SPDX-License-Identifier: MIT
// Speed as a colour: the trail, the profile and the legend share this one ramp. Its stops brighten and turn from cold
// to warm, so that fast parts stand out on the dark ground.

const stops = [
  [52, 88, 224],
  [28, 160, 222],
  [66, 204, 150],
  [242, 201, 76],
  [255, 128, 60],
  [255, 66, 86],
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
