// SPDX-License-Identifier: MIT
// In place of hammerjs, with which chartjs-plugin-zoom takes fingers: they scroll the page and spread it as everywhere.
export default null;
