// SPDX-License-Identifier: MIT
// Makes the one file that WatchPage fills: style, body with the licence of three.js, and the script with three.js.
//   node bundle.mjs <folder that holds node_modules> <file to write>
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
const sheets = ['style.css', 'small_screens.css'].map((sheet) => readFileSync(join(source, sheet), 'utf8'));
const style = transformSync(sheets.join('\n'), {
  loader: 'css',
  minify: true,
  legalComments: 'none',
}).code;
const licence = readFileSync(join(packages, 'node_modules/three/LICENSE'), 'utf8');
const escaped = licence.replace(/&/g, '&amp;').replace(/</g, '&lt;');

if (/<\/script|<!--/i.test(script)) throw new Error('the script would end its own element');
if (!/Permission is hereby granted/.test(licence)) throw new Error('three.js came without its licence');

const body = readFileSync(join(source, 'body.html'), 'utf8').replace('@LICENCE@', () => escaped.trim());
const bundle = JSON.stringify({ style: style.trim(), body, script: script.trim() });
writeFileSync(`${out}.partial`, bundle);
renameSync(`${out}.partial`, out);
console.log(`${out}: ${Math.round(bundle.length / 1024)} KiB before a flight`);
