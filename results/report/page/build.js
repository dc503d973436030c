// build.js SOURCES PAGE: one HTML file of the page's sources and the libraries they import.
import * as esbuild from 'esbuild';
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const [sources, page] = process.argv.slice(2);
const modules = join(dirname(fileURLToPath(import.meta.url)), 'node_modules');

const bundle = (file, options) =>
  esbuild.buildSync({
    entryPoints: [join(sources, file)],
    bundle: true,
    minify: true,
    write: false,
    charset: 'utf8',
    legalComments: 'inline',
    target: 'es2022',
    nodePaths: [modules],
    ...options,
  }).outputFiles[0].text;

// Libraries whose code is in the page; esbuild only builds it.
const licences = ['plotly.js-cartesian-dist-min', 'three'].map((name) => {
  const { version } = JSON.parse(readFileSync(join(modules, name, 'package.json'), 'utf8'));
  return `${name} ${version}\n\n${readFileSync(join(modules, name, 'LICENSE'), 'utf8').trim()}\n`;
});

const parts = {
  STYLE: bundle('page.css'),
  SCRIPT: bundle('main.js', { format: 'iife' }),
  LICENCES: licences.join('\n\n').replace(/[&<]/g, (c) => (c === '&' ? '&amp;' : '&lt;')),
};
const html = readFileSync(join(sources, 'page.html'), 'utf8');
writeFileSync(
  page,
  html.replace(/%(STYLE|SCRIPT|LICENCES)%/g, (_, name) => parts[name]),
);
