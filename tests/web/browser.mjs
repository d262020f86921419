// The browser and the page, for the tests beside this file.
import { createRequire } from 'node:module';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

// The packages live in web/, which alone has a lock file.
export const requireFromWeb = createRequire(new URL('../../web/package.json', import.meta.url));
const { chromium } = requireFromWeb('playwright-core');

const kFlags = [
  '--no-sandbox',
  '--disable-gpu',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];
// A software renderer beside a busy compiler needs this long for its first picture.
export const kPatienceMs = 60_000;

/** Starts Debian's chromium with an empty profile; resolves to { context, close }. */
export async function startBrowser(options = {}) {
  const profile = mkdtempSync(join(tmpdir(), 'limn-chromium-'));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath: process.env.LIMN_CHROMIUM ?? '/usr/bin/chromium',
    headless: true,
    args: kFlags,
    viewport: { width: 1280, height: 800 },
    ...options,
  });
  context.setDefaultTimeout(kPatienceMs);
  return {
    context,
    close: async () => {
      await context.close();
      rmSync(profile, { recursive: true, force: true });
    },
  };
}

/**
 * Opens the page and waits for its first picture, `page.firstPictureMs` after the call, and for the scene, without which
 * nothing can be edited. Errors of the page are collected in `page.errors`.
 */
export async function openPage(context, url) {
  const openedMs = performance.now();
  const page = await context.newPage();
  page.errors = [];
  page.on('pageerror', (error) => page.errors.push(error.message));
  page.on('console', (message) => {
    // While a server is down the browser itself reports every refused connection.
    if (
      message.type() === 'error' &&
      !/ERR_CONNECTION_REFUSED|WebSocket connection to|Failed to load resource/.test(message.text())
    )
      page.errors.push(message.text());
  });
  await page.goto(url);
  await waitFor(page, () => window.limn?.frame != null);
  page.firstPictureMs = performance.now() - openedMs;
  await waitFor(page, () => window.limn.model.connected());
  return page;
}

/** Waits until `condition` is true in the page. */
export const waitFor = (page, condition, argument) =>
  page.waitForFunction(condition, argument, { timeout: kPatienceMs, polling: 50 });

/** The newest presented frame's header. */
export const frameHeader = (page) => page.evaluate(() => window.limn.frame.header);

/** Waits for a picture that holds all that was edited in the page and has at least `steps` passes. */
export const settle = (page, steps) =>
  waitFor(page, (least) => window.limn.settled() && window.limn.frame.header.steps >= least, steps);

/** Waits for the lossless picture of all that was edited in the page, after which nothing more comes. */
export const atRest = (page) =>
  waitFor(page, () => window.limn.settled() && (window.limn.frame.header.flags & 6) === 6);

/** Types into a number field of a panel and waits until a picture shows it. */
export async function typeNumber(page, panel, label, value) {
  const field = page.locator(panel).getByLabel(label, { exact: true });
  await field.fill(String(value));
  await field.press('Enter');
  await settle(page, 0);
}

/** Chooses in a list of a panel and waits until a picture shows it. */
export async function choose(page, panel, label, value) {
  await page.locator(panel).getByLabel(label, { exact: true }).selectOption(value);
  await settle(page, 0);
}

/** Mean colours of a grid of areas over the canvas: what changes when the picture changes, and not with its noise. */
export const meanGrid = (page, columns = 8, rows = 6) =>
  page.evaluate(
    async ([columns, rows]) => {
      const { fullWidth, fullHeight } = window.limn.frame.header;
      const [width, height] = [Math.floor(fullWidth / columns), Math.floor(fullHeight / rows)];
      const cells = [];
      for (let i = 0; i < columns * rows; i++) {
        cells.push(
          await window.limn.mean({ x: (i % columns) * width, y: Math.floor(i / columns) * height, width, height }),
        );
      }
      return cells;
    },
    [columns, rows],
  );

/** Largest difference of two grids, in sRGB steps of 255. */
export const gridDifference = (a, b) => Math.max(...a.flatMap((cell, i) => cell.map((c, k) => Math.abs(c - b[i][k]))));

/** The window's point over a pixel of the picture given in shares of its width and height. */
export const pointInPicture = (page, u, v) =>
  page.evaluate(
    ([u, v]) => {
      const box = document.getElementById('stage').getBoundingClientRect();
      const { fullWidth, fullHeight } = window.limn.frame.header;
      const scale = Math.min(box.width / fullWidth, box.height / fullHeight);
      return {
        x: box.left + box.width / 2 + (u - 0.5) * fullWidth * scale,
        y: box.top + box.height / 2 + (v - 0.5) * fullHeight * scale,
      };
    },
    [u, v],
  );

/** Drags with the mouse over shares of the picture. */
export async function drag(page, from, to, options = {}) {
  const start = await pointInPicture(page, ...from);
  const end = await pointInPicture(page, ...to);
  await page.mouse.move(start.x, start.y);
  await page.mouse.down(options);
  await page.mouse.move(end.x, end.y, { steps: 12 });
  await page.mouse.up(options);
}

/** Clicks the picture and resolves to what was picked. */
export async function pick(page, u, v) {
  const before = await page.evaluate(() => window.limn.picks.length);
  const { x, y } = await pointInPicture(page, u, v);
  await page.mouse.click(x, y);
  await waitFor(page, (count) => window.limn.picks.length > count, before);
  return page.evaluate(() => window.limn.picks.at(-1));
}

/** What the page's model holds of the scene. */
export const sceneOf = (page) => page.evaluate(() => window.limn.model.scene);
