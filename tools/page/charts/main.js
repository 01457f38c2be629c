// SPDX-License-Identifier: MIT
// Draws every .chart of a page, in place of its table, from the JSON beside it (page/chart.cpp) once it comes into view.
import {
  CategoryScale,
  Chart,
  LinearScale,
  LineElement,
  LogarithmicScale,
  PointElement,
  ScatterController,
  Tooltip,
} from 'chart.js';
import zoom from 'chartjs-plugin-zoom';

Chart.defaults.locale = 'en'; // as the rest of the page
Chart.register(
  CategoryScale,
  LinearScale,
  LineElement,
  LogarithmicScale,
  PointElement,
  ScatterController,
  Tooltip,
  zoom,
);

const axisWidth = 58;
/** Names of rows: each above its line, however long. */
const above = { autoSkip: false, mirror: true, labelOffset: -13, padding: 0 };
const marks = { dots: 'circle', pluses: 'cross', squares: 'rect', strokes: 'line' };

const palette = getComputedStyle(document.documentElement);
/** A colour of the palette as it is just now, or one that is the same in light and dark. */
const ink = (colour, opacity = 1) =>
  (palette.getPropertyValue(`--${colour}`).trim() || colour) +
  Math.round(255 * opacity)
    .toString(16)
    .padStart(2, '0');
const shown = (value) => Number(value.toPrecision(4)).toString().replace('-', '\u2212');

const element = (name, className, text = '') =>
  Object.assign(document.createElement(name), { className, textContent: text });

function dataset({ name, shape, colour, x, y, width, opacity, dashed }, i) {
  const line = shape === 'line';
  const full = () => ink(colour, opacity);
  return {
    label: name,
    data: x.map((value, i) => ({ x: value, y: y[i] })),
    order: -i, // the last on top
    showLine: line,
    borderColor: full,
    borderWidth: width,
    borderDash: dashed ? [5, 4] : [],
    backgroundColor: full,
    pointStyle: marks[shape] ?? 'circle',
    pointRotation: shape === 'strokes' ? 90 : 0,
    pointRadius: line ? 0 : shape === 'dots' ? width / 2 : shape === 'pluses' ? 2.5 : 7,
    pointBorderWidth: shape === 'dots' ? 0 : width,
    pointHoverRadius: 4,
  };
}

function scale({ name, least, most, logarithmic, rows }, isX, values, ticks) {
  const known = values.filter((value) => value !== null);
  return {
    type: rows.length > 0 ? 'category' : logarithmic ? 'logarithmic' : 'linear',
    labels: rows,
    offset: rows.length > 0,
    min: least ?? (known.length > 0 ? Math.min(...known) : undefined),
    max: most ?? (known.length > 0 ? Math.max(...known) : undefined),
    title: { display: name !== '', text: name, color: () => ink('muted'), align: 'end', padding: 2 },
    border: { display: false },
    grid: { color: () => ink('line') },
    ticks: { color: () => ink('muted'), maxRotation: 0, autoSkipPadding: 12, includeBounds: false, maxTicksLimit: rows.length || ticks, ...(rows.length > 0 && above) },
    afterBuildTicks: (axis) => {
      if (logarithmic) axis.ticks = axis.ticks.filter(({ value }) => /^[125]e/.test(value.toExponential()));
    },
    afterFit: (axis) => {
      if (isX) axis.height = 46;
      else axis.width = rows.length > 0 ? 0 : axisWidth; // plots below each other begin together
    },
  };
}

/** One finger scrolls the page over a whole chart, and moves a spread one. */
function takeFingers({ chart }) {
  chart.canvas.style.touchAction = chart.isZoomedOrPanned() ? 'none' : 'pan-y';
}

/** A panel as a chart: hover by the nearest instant, or by the nearest point where x is no time. */
function plot(panel) {
  const overX = panel.height > 0 && panel.y.rows.length === 0;
  const place = element('div', panel.height > 0 ? 'plot' : 'square plot');
  if (panel.height > 0) place.style.height = `${60 + (panel.y.rows.length > 0 ? 40 * panel.y.rows.length : panel.height)}px`;
  const canvas = place.appendChild(element('canvas', ''));
  const chart = new Chart(canvas, {
    type: 'scatter',
    data: { datasets: panel.series.map(dataset) },
    options: {
      animation: false,
      maintainAspectRatio: false,
      parsing: false,
      layout: { padding: { top: axisWidth - 46 + 12, right: 12 } }, // a square plot is square without its axes
      scales: {
        x: scale(panel.x, true, overX ? panel.series.flatMap(({ x }) => x) : [], 11),
        y: scale(panel.y, false, [], panel.height > 0 ? Math.max(3, Math.floor(panel.height / 28)) : 11),
      },
      interaction: { mode: 'nearest', axis: overX ? 'x' : 'xy', intersect: false },
      plugins: {
        tooltip: {
          filter: ({ dataset: { label }, parsed }, i, all) =>
            label !== '' && i === all.findIndex((one) => one.dataset.label === label && one.parsed.y === parsed.y),
          callbacks: {
            title: (items) => (items.length > 0 && overX ? `${panel.x.name}: ${shown(items[0].parsed.x)}` : ''),
            label: ({ dataset: { label }, parsed: { x, y } }) =>
              `${label}: ${overX ? shown(y) : `${shown(x)}, ${panel.y.rows[y] ?? shown(y)}`}`,
          },
        },
        zoom: {
          limits: { x: { min: 'original', max: 'original' }, y: { min: 'original', max: 'original' } },
          zoom: {
            mode: 'xy',
            drag: { enabled: true, backgroundColor: () => ink('accent', 0.2) },
            pinch: { enabled: true },
            onZoomComplete: takeFingers,
          },
          pan: { enabled: true, onPanStart: ({ chart, event }) => event.pointerType !== 'mouse' && chart.isZoomedOrPanned() },
        },
      },
    },
  });
  takeFingers({ chart });
  canvas.addEventListener('dblclick', () => chart.resetZoom('none'));
  return { place, chart };
}

/** A button for each name, which shows and hides what has it in all panels. */
function legend(panels, charts) {
  const bar = element('p', 'legend');
  const named = new Map(panels.flatMap(({ series }) => series).map((one) => [one.name, one]));
  for (const [name, { colour, shape, width, dashed, opacity }] of named) {
    if (name === '') continue;
    const button = element('button', '', name);
    button.type = 'button';
    button.ariaPressed = 'true';
    const sample = button.insertBefore(element('i', `${shape}${dashed ? ' dashed' : ''}`), button.firstChild);
    sample.style.borderColor = `var(--${colour}, ${colour})`;
    sample.style.borderTopWidth = `${shape === 'line' ? width : 6}px`;
    sample.style.opacity = opacity;
    button.addEventListener('click', () => {
      button.ariaPressed = String(button.ariaPressed !== 'true');
      for (const chart of charts) {
        for (const one of chart.data.datasets) if (one.label === name) one.hidden = button.ariaPressed !== 'true';
        chart.update();
      }
    });
    bar.append(button);
  }
  bar.append(element('span', 'by_mouse', 'Drag to zoom, double-click to go back'));
  bar.append(element('span', 'by_finger', 'Spread two fingers to zoom, drag to move, double-tap to go back'));
  return bar;
}

function draw(figure) {
  watcher.unobserve(figure);
  const json = figure.querySelector('script');
  if (!json) return;
  const { description, columns, panels } = JSON.parse(json.textContent);
  const plots = element('div', 'plots');
  plots.role = 'img';
  plots.ariaLabel = description;
  plots.style.setProperty('--columns', columns);
  figure.replaceChildren(plots);
  const charts = panels.map((panel) => {
    const part = plots.appendChild(element('div', ''));
    part.append(element('b', '', panel.title), ' ', element('small', '', panel.note));
    const { place, chart } = plot(panel);
    part.append(place);
    return chart;
  });
  figure.prepend(legend(panels, charts));
}

const figures = [...document.querySelectorAll('.chart')];
const watcher = new IntersectionObserver(
  (entries) => entries.filter((entry) => entry.isIntersecting).forEach((entry) => draw(entry.target)),
  { rootMargin: '300px' },
);
figures.forEach((figure) => watcher.observe(figure));
addEventListener('beforeprint', () => figures.forEach(draw));
for (const query of ['print', '(prefers-color-scheme: dark)'])
  matchMedia(query).addEventListener('change', () => Object.values(Chart.instances).forEach((chart) => chart.update()));
window.chartOf = Chart.getChart; // of a canvas
