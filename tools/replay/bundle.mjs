// SPDX-License-Identifier: MIT
// Makes the one file that ReplayPage fills: page, style, three.js with its licence, and the replay.
//   node bundle.mjs <folder that holds node_modules> <page to write>
import { readFileSync, renameSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const [packages, out] = process.argv.slice(2).map((path) => resolve(path));
const source = join(dirname(fileURLToPath(import.meta.url)), 'src');
// the packages are in the build tree, away from this file
const { buildSync, transformSync } = createRequire(join(packages, 'package.json'))('esbuild');

const script = buildSync({
  entryPoints: [join(source, 'main.js')],
  nodePaths: [join(packages, 'node_modules')],
  bundle: true,
  minify: true,
  write: false,
  format: 'iife',
  target: 'es2022',
  charset: 'utf8',
  legalComments: 'none', // the licence is in the page as a whole, for its reader
}).outputFiles[0].text;
const palette = join(source, '../../pictures/page.css'); // shared with the report
const sheets = [palette, join(source, 'style.css'), join(source, 'small_screens.css')].map((sheet) =>
  readFileSync(sheet, 'utf8'),
);
const style = transformSync(sheets.join('\n'), {
  loader: 'css',
  minify: true,
  legalComments: 'none',
}).code;
const licence = readFileSync(join(packages, 'node_modules/three/LICENSE'), 'utf8');
const escaped = licence.replace(/&/g, '&amp;').replace(/</g, '&lt;');

if (/<\/script|<!--/i.test(script)) throw new Error('the script would end its own element');
if (!/Permission is hereby granted/.test(licence)) throw new Error('three.js came without its licence');

const parts = { STYLE: style.trim(), LICENCE: escaped.trim(), SCRIPT: script.trim() };
const page = readFileSync(join(source, 'page.html'), 'utf8').replace(
  /@PINNQUAD_(\w+)@/g,
  (marker, name) => parts[name] ?? marker,
);
for (const marker of ['@PINNQUAD_TITLE@', '@PINNQUAD_FLIGHT@']) {
  if (page.split(marker).length !== 2) throw new Error(`${marker} must be in the page once`);
}
writeFileSync(`${out}.partial`, page);
renameSync(`${out}.partial`, out);
console.log(`${out}: ${Math.round(page.length / 1024)} KiB before a flight`);
