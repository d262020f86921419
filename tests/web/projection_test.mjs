// Point projection in the page, against a real limnd: its first picture, its views, and an object that is dragged.
// Needs LIMND and LIMN_SCENE, the Cornell box.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { after, before, test } from 'node:test';
import {
  atRest,
  choose,
  frameHeader,
  gridDifference,
  meanGrid,
  openPage,
  pick,
  pointInPicture,
  sceneOf,
  settle,
  startBrowser,
  typeNumber,
} from './browser.mjs';
import { freePort, startDaemon } from './daemon.mjs';
import { withTranslation } from './glb.mjs';
import { Peer } from './peer.mjs';

const kSize = ['--size', '160x120'];
const kTechnique = 'point-projection';
const kStartGrid = 16; // [pixel] between the first gathered pixels
// Few passes, so that the picture comes to rest in seconds and before every pixel has gathered for itself.
const kMaxSamples = 6;
// Places in shares of the picture's width and height.
const kTallBlock = [0.43, 0.6];
const kBesideTallBlock = [0.62, 0.6];
const kLamp = { u: 0.46, v: 0.13, width: 0.06, height: 0.02 };
const kCeiling = { u: 0.25, v: 0.08, width: 0.1, height: 0.05 };
// Floor and walls that the tall block hides neither before it is dragged nor after: more light comes to the left ones,
// from where it stood, and less to the right ones, where its shadow is then.
const kUncovered = { u: 0.19, v: 0.67, width: 0.12, height: 0.2 };
const kShadowed = { u: 0.69, v: 0.67, width: 0.06, height: 0.16 };

let browser;
let daemon;
let port;
let page;
const folder = mkdtempSync(join(tmpdir(), 'limn-moved-'));

before(async () => {
  port = await freePort();
  daemon = await startDaemon(port, kSize);
  browser = await startBrowser();
  page = await openPage(browser.context, `http://127.0.0.1:${port}/`);
});

after(async () => {
  await browser?.close();
  await daemon?.kill('SIGKILL');
  rmSync(folder, { recursive: true, force: true });
});

const hash = () => page.evaluate(() => window.limn.hash());

/** Latencies from input to pixels of the edits with this label, oldest first [ms]. */
const latenciesOf = (label) =>
  page.evaluate(
    (label) =>
      window.limn.outcomes.filter((o) => o.label === label && o.latencyMs !== undefined).map((o) => o.latencyMs),
    label,
  );

/** Mean of all channels of a part of the canvas that is given in shares of the picture, 0..255. */
async function brightness({ u, v, width, height }) {
  const { fullWidth, fullHeight } = await frameHeader(page);
  const across = (share) => Math.round(share * fullWidth);
  const down = (share) => Math.round(share * fullHeight);
  const area = { x: across(u), y: down(v), width: across(width), height: down(height) };
  const rgb = await page.evaluate((a) => window.limn.mean(a), area);
  return rgb.reduce((sum, c) => sum + c, 0) / rgb.length;
}

const brightnesses = async () => ({ uncovered: await brightness(kUncovered), shadowed: await brightness(kShadowed) });

/** Colours of the pixels whose coordinates are `offset` beyond multiples of the start grid. */
const pixelsOfGrid = (offset) =>
  page.evaluate(
    async ([stride, begin]) => {
      const { fullWidth, fullHeight } = window.limn.frame.header;
      const colors = [];
      for (let y = begin; y < fullHeight; y += stride)
        for (let x = begin; x < fullWidth; x += stride)
          colors.push(await window.limn.mean({ x, y, width: 1, height: 1 }));
      return colors;
    },
    [kStartGrid, offset],
  );
// The lamp, which gathers nothing, is nearly white.
const kLeastTint = 24;
const isGreen = ([r, g]) => g > r + kLeastTint;
const isOrange = ([r, g]) => r > g + kLeastTint;

test('the technique is chosen, shows a first picture and refines it', async () => {
  await settle(page, 8);
  const traced = await meanGrid(page);
  await choose(page, '#render', 'Technique', kTechnique);
  const first = await frameHeader(page);
  const [latencyMs] = await latenciesOf('Technique');
  console.log(`from choosing the technique to its first picture: ${Math.round(latencyMs)} ms`);
  assert.ok((await hash()).distinct > 16, 'the first picture is empty');

  await settle(page, first.steps + 2);
  const refined = await frameHeader(page);
  assert.ok(refined.meanSamples > first.meanSamples, `${refined.meanSamples} samples after ${first.meanSamples}`);
  const difference = gridDifference(traced, await meanGrid(page));
  assert.ok(difference < 16, `the techniques differ by ${difference}`);
  assert.equal(await page.locator('#render').getByLabel('Technique', { exact: true }).inputValue(), kTechnique);
  const peer = await Peer.connect(port);
  assert.equal((await peer.describe()).technique, kTechnique);
  peer.close();
});

test('each view shows its part of the light', async () => {
  await typeNumber(page, '#render', 'Max samples', kMaxSamples);
  await atRest(page);
  const shown = [(await hash()).sha256];
  for (const view of ['direct', 'indirect']) {
    await choose(page, '#render', 'View', view);
    await atRest(page);
    shown.push((await hash()).sha256);
    const [lamp, ceiling] = [await brightness(kLamp), await brightness(kCeiling)];
    // The lamp hangs below the ceiling and shines downwards: no light comes there but from floor and walls.
    if (view === 'direct') assert.ok(lamp > 200 && ceiling < 2, `lamp ${lamp}, ceiling ${ceiling}`);
    else assert.ok(lamp < 2 && ceiling > 20, `lamp ${lamp}, ceiling ${ceiling}`);
  }

  await choose(page, '#render', 'View', 'placement');
  await atRest(page);
  shown.push((await hash()).sha256);
  assert.equal(new Set(shown).size, shown.length, 'two views are alike');
  const first = (await pixelsOfGrid(0)).filter((color) => isGreen(color) || isOrange(color));
  assert.ok(first.length >= 12, `${first.length} pixels of the start grid see the box`);
  assert.ok(first.every(isGreen), JSON.stringify(first));
  const between = (await pixelsOfGrid(kStartGrid / 2 - 3)).filter((color) => isGreen(color) || isOrange(color));
  assert.ok(between.filter(isOrange).length > between.length / 2, JSON.stringify(between));
});

test('indirect light follows an object while it is dragged', async () => {
  await choose(page, '#render', 'View', 'indirect');
  await atRest(page);
  const old = await brightnesses();
  const { node } = await pick(page, ...kTallBlock);
  assert.equal((await sceneOf(page)).nodes[node].name, 'Tall block');

  const start = await pointInPicture(page, ...kTallBlock);
  const end = await pointInPicture(page, ...kBesideTallBlock);
  await page.keyboard.down('Control');
  await page.mouse.move(start.x, start.y);
  await page.mouse.down();
  await page.mouse.move(end.x, end.y, { steps: 8 });
  await settle(page, 0);
  const first = await brightnesses();
  const latencies = await latenciesOf('Tall block, translation');
  console.log(`from the edits of a drag to their first pictures: ${latencies.map(Math.round).join(', ')} ms`);
  await page.mouse.up();
  await page.keyboard.up('Control');

  await atRest(page);
  const moved = await brightnesses();
  assert.ok(moved.uncovered > old.uncovered + 6, `uncovered: ${old.uncovered}, then ${moved.uncovered}`);
  assert.ok(moved.shadowed < old.shadowed - 6, `shadowed: ${old.shadowed}, then ${moved.shadowed}`);
  for (const place of ['uncovered', 'shadowed']) {
    const [toOld, toMoved] = [first[place] - old[place], first[place] - moved[place]].map(Math.abs);
    assert.ok(toMoved < toOld, `${place}: ${old[place]}, first ${first[place]}, then ${moved[place]}`);
  }
});

test('at rest the canvas is that of a fresh load of the scene as it was left', async () => {
  await choose(page, '#render', 'View', 'beauty');
  await atRest(page);
  const shown = await hash();
  const { node } = await page.evaluate(() => window.limn.model.selection);
  const { translation } = (await sceneOf(page)).nodes[node];
  const peer = await Peer.connect(port);
  const left = await peer.describe();
  peer.close();
  assert.deepEqual(left.nodes[node].translation, translation, 'the server holds what the page shows');

  const file = join(folder, basename(process.env.LIMN_SCENE));
  writeFileSync(file, withTranslation(readFileSync(process.env.LIMN_SCENE), node, translation));
  const freshPort = await freePort();
  const fresh = await startDaemon(freshPort, [...kSize, '--technique', kTechnique], file);
  const other = await Peer.connect(freshPort);
  try {
    other.send({ op: 'set', target: 'technique', parameters: { maxSamples: kMaxSamples } });
    const picture = await other.finalPicture();
    assert.equal((await other.describe()).hash, left.hash, 'the scenes are not the same');
    assert.equal(shown.sha256, picture.sha256, 'something of the old scene is left');
  } finally {
    other.close();
    await fresh.kill('SIGKILL');
  }
});

test('nothing went wrong in the page', async () => {
  assert.deepEqual(page.errors, []);
  assert.deepEqual(await page.evaluate(() => window.limn.faults), []);
});
