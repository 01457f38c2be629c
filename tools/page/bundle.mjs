// SPDX-License-Identifier: MIT
// Makes what the program puts into its pages: <folder>/watch.json, which WatchPage fills, and charts.json, which draws the
// charts; style, body with the licences of what is in the script, and the script each.
//   node bundle.mjs <folder that holds node_modules> <folder to write to>
import { readdirSync, readFileSync, renameSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const [packages, out] = process.argv.slice(2).map((path) => resolve(path));
const here = dirname(fileURLToPath(import.meta.url));
// the packages are in the build tree, away from this file
const { buildSync, transformSync } = createRequire(join(packages, 'package.json'))('esbuild');

/** The licences of the packages that a bundle has parts of, each once. */
function licences(inputs) {
  const names = Object.keys(inputs).map((path) => /node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(path)?.[1]);
  return [...new Set(names.filter(Boolean))].map((name) => {
    const folder = join(packages, 'node_modules', name);
    const text = readFileSync(join(folder, readdirSync(folder).find((file) => /^licen[cs]e/i.test(file))), 'utf8');
    if (!/Permission is hereby granted/.test(text)) throw new Error(`${name} came without its licence`);
    return `${name}\n\n${text.trim()}`;
  });
}

function bundle(name, folder, sheets) {
  const source = join(here, folder);
  const { outputFiles, metafile } = buildSync({
    entryPoints: [join(source, 'main.js')],
    nodePaths: [join(packages, 'node_modules')],
    bundle: true,
    minify: true,
    write: false,
    metafile: true,
    format: 'iife',
    target: 'es2022',
    charset: 'utf8',
    legalComments: 'none', // the licences are in the page as a whole, for its reader
  });
  const script = outputFiles[0].text.trim();
  if (/<\/script|<!--/i.test(script)) throw new Error(`the script of ${name} would end its own element`);
  const style = transformSync(sheets.map((sheet) => readFileSync(join(source, sheet), 'utf8')).join('\n'), {
    loader: 'css',
    minify: true,
    legalComments: 'none',
  }).code.trim();
  const licence = licences(metafile.inputs).join('\n\n\n').replace(/&/g, '&amp;').replace(/</g, '&lt;');
  const body = readFileSync(join(source, 'body.html'), 'utf8').replace('@LICENCE@', () => licence);
  const file = join(out, `${name}.json`);
  const text = JSON.stringify({ style, body, script });
  writeFileSync(`${file}.partial`, text);
  renameSync(`${file}.partial`, file);
  console.log(`${file}: ${Math.round(text.length / 1024)} KiB before its data`);
}

bundle('watch', 'watch/src', ['style.css', 'small_screens.css']);
bundle('charts', 'charts', ['style.css']);
