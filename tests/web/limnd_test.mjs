// The page in Chromium against a real limnd. Needs LIMND and LIMN_SCENE.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';
import { after, before, test } from 'node:test';
import {
  atRest,
  drag,
  frameHeader,
  gridDifference,
  meanGrid,
  openPage,
  pick,
  sceneOf,
  settle,
  startBrowser,
  typeNumber,
  waitFor,
} from './browser.mjs';
import { freePort, startDaemon } from './daemon.mjs';
import { Peer } from './peer.mjs';

const kSize = ['--size', '160x120'];
// Few samples, so that a software renderer comes to rest in seconds.
const kSamplesAtRest = 24;
const kEnoughSteps = 4;

let browser;
let daemon;
let port;
let page;
let firstView;

before(async () => {
  port = await freePort();
  daemon = await startDaemon(port, kSize);
  browser = await startBrowser();
  page = await openPage(browser.context, `http://127.0.0.1:${port}/`);
  console.log(`from opening the page to its first picture: ${Math.round(page.firstPictureMs)} ms`);
});

after(async () => {
  await browser?.close();
  await daemon?.kill('SIGKILL');
});

const hash = () => page.evaluate(() => window.limn.hash());

test('the picture appears', async () => {
  const picture = await hash();
  assert.equal(`${picture.width}x${picture.height}`, '160x120');
  assert.ok(picture.distinct > 16, `only ${picture.distinct} colours`);
  assert.equal(await page.locator('#connection').textContent(), 'Connected');
});

test('the statistics tell about the picture', async () => {
  await settle(page, kEnoughSteps);
  await page.waitForFunction(() => /\d/.test(document.querySelector('#stats dl').textContent));
  const text = await page.locator('#stats').textContent();
  const { device } = await page.evaluate(() => window.limn.model.hello);
  assert.ok(text.includes(device), `${device} is not in: ${text}`);
  await page.waitForFunction(() =>
    /^Estimated error over time: \d[\d.e-]* after \d[\d.]* seconds$/.test(
      document.querySelector('#stats canvas.plot').getAttribute('aria-label'),
    ),
  );
});

test('dragging turns the camera and changes the picture', async () => {
  await settle(page, kEnoughSteps);
  const gridBefore = await meanGrid(page);
  const { viewRevision } = await frameHeader(page);
  firstView = (await sceneOf(page)).view;
  await drag(page, [0.35, 0.5], [0.65, 0.4]);
  await waitFor(page, (revision) => window.limn.frame.header.viewRevision > revision, viewRevision);
  await settle(page, kEnoughSteps);
  await page.waitForFunction(() =>
    /Edit to pixels\d[\d.]* m?s \(p95 \d[\d.]* m?s\)/.test(document.querySelector('#stats dl').textContent),
  );
  const difference = gridDifference(gridBefore, await meanGrid(page));
  assert.ok(difference > 6, `the picture changed by ${difference} only`);
  const pose = await page.evaluate(() => window.limn.rig.current());
  const peer = await Peer.connect(port);
  const told = await peer.next((m) => m.op === 'scene');
  peer.close();
  assert.notDeepEqual(told.view.eye, firstView.eye);
  for (let i = 0; i < 3; i++)
    assert.ok(Math.abs(told.view.eye[i] - pose.eye[i]) < 1e-5, "the server holds the page's camera");
});

test('keys turn the camera back to the first view', async () => {
  await page.locator('#stage').focus();
  await page.keyboard.press('r');
  await waitFor(page, (eye) => JSON.stringify(window.limn.rig.current().eye) === JSON.stringify(eye), firstView.eye);
  await settle(page, 1);
});

test('the material panel changes a colour in the canvas', async () => {
  const spot = await pickDiffuse();
  await settle(page, kEnoughSteps);
  const area = await areaAround(spot);
  const greenBefore = greenShare(await page.evaluate((a) => window.limn.mean(a), area));
  const outcomes = await page.evaluate(() => window.limn.outcomes.length);
  await page
    .locator('#inspector')
    .getByLabel(/^Base color/)
    .first()
    .fill('#10f020');
  await waitFor(page, (count) => window.limn.outcomes.slice(count).some((o) => o.latencyMs !== undefined), outcomes);
  const line = await page.locator('#ledger').textContent();
  assert.match(line, /(relight|re-gather|rebuild), \d+\.\d\d s to first pixels/);
  await settle(page, kEnoughSteps);
  const greenAfter = greenShare(await page.evaluate((a) => window.limn.mean(a), area));
  assert.ok(greenAfter > greenBefore + 0.08, `green went from ${greenBefore} to ${greenAfter}`);
});

test('the canvas at rest equals the pixels of the server', async () => {
  await typeNumber(page, '#render', 'Max samples', kSamplesAtRest);
  await atRest(page);
  assert.equal((await frameHeader(page)).phase, 'converged');
  const shown = await hash();
  const header = await frameHeader(page);
  const peer = await Peer.connect(port);
  const told = await peer.finalPicture();
  peer.close();
  assert.deepEqual([told.sceneRevision, told.viewRevision], [header.sceneRevision, header.viewRevision]);
  assert.deepEqual([told.width, told.height], [shown.width, shown.height]);
  assert.equal(shown.sha256, told.sha256);
});

test('exposure changes the picture without a restart', async () => {
  const { steps } = await frameHeader(page);
  const shown = await hash();
  const gridBefore = await meanGrid(page);
  await typeNumber(page, '#render', 'Exposure', 1.5);
  await atRest(page);
  assert.equal(await page.evaluate(() => window.limn.acks.at(-1).cost), 'display-only');
  assert.ok((await frameHeader(page)).steps >= steps, 'sampling was restarted');
  assert.ok(gridDifference(gridBefore, await meanGrid(page)) > 6);
  assert.notEqual((await hash()).sha256, shown.sha256);
});

test('the film is saved as an OpenEXR file', async () => {
  const waiting = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Save EXR' }).click();
  const download = await waiting;
  assert.match(download.suggestedFilename(), /\.exr$/);
  const bytes = readFileSync(await download.path());
  assert.equal(bytes.readUInt32LE(0), 20000630, 'the magic number of OpenEXR');
});

test('a file that is not there is told, and the scene stays', async () => {
  const { hash: before } = await sceneOf(page);
  await page.getByLabel('Scene file under the asset root').fill('no-such-file.glb');
  await page.getByRole('button', { name: 'Load' }).click();
  await waitFor(page, () => document.querySelector('#ledger .bad') !== null);
  assert.equal((await sceneOf(page)).hash, before);
});

test('loading a scene shows it from its own camera', async () => {
  const { sceneRevision } = await frameHeader(page);
  await page.getByLabel('Scene file under the asset root').fill(basename(process.env.LIMN_SCENE));
  await page.getByRole('button', { name: 'Load' }).click();
  await waitFor(
    page,
    (revision) => window.limn.model.scene.cause === 'loaded' && window.limn.frame.header.sceneRevision > revision,
    sceneRevision,
  );
  assert.match(await page.locator('#ledger').textContent(), /Loaded in/);
  const { view } = await sceneOf(page);
  assert.deepEqual(await page.evaluate(() => window.limn.rig.current().eye), view.eye);
  await pickDiffuse();
});

test('killing and restarting the daemon recovers', async () => {
  await daemon.kill('SIGKILL');
  await waitFor(page, () => window.limn.model.connection.kind === 'reconnecting');
  assert.equal(
    await page
      .locator('#stage')
      .getAttribute('class')
      .then((c) => c.split(' ').includes('stale')),
    true,
  );
  assert.match(await page.locator('#stale').textContent(), /^Stale picture/);
  assert.ok((await hash()).distinct > 16, 'the last picture stays');

  const field = page.locator('#inspector').getByLabel('Roughness', { exact: true });
  const held = await field.inputValue();
  await field.fill('0.123');
  await field.press('Enter');
  assert.match(await page.locator('#ledger').textContent(), /Not sent/);
  assert.equal(await field.inputValue(), held);

  daemon = await startDaemon(port, kSize);
  await waitFor(page, () => window.limn.model.connection.kind === 'connected' && window.limn.statistics.last !== null);
  assert.equal(await page.locator('#stale').isHidden(), true);
  const peer = await Peer.connect(port);
  const told = await peer.describe();
  peer.close();
  const scene = await sceneOf(page);
  assert.deepEqual(scene.materials, told.materials);
  assert.equal(scene.hash, told.hash);
  const gridBefore = await meanGrid(page);
  await drag(page, [0.6, 0.5], [0.3, 0.5]);
  await settle(page, kEnoughSteps);
  assert.ok(gridDifference(gridBefore, await meanGrid(page)) > 6, 'the page steers the new daemon');
});

test('nothing went wrong in the page', async () => {
  assert.deepEqual(page.errors, []);
  assert.deepEqual(await page.evaluate(() => window.limn.faults), []);
});

/** Picks until the point shows a lit, opaque, rough material that does not glow; resolves to its place. */
async function pickDiffuse() {
  const tried = [];
  for (const v of [0.8, 0.65, 0.5, 0.35]) {
    for (const u of [0.5, 0.3, 0.7, 0.15, 0.85]) {
      const picked = await pick(page, u, v);
      const { materials } = await sceneOf(page);
      const material = materials[picked.material];
      tried.push(material?.name ?? 'nothing');
      if (!material || material.metallic > 0.3 || material.transmission > 0 || material.roughness < 0.3) continue;
      const lit = await page.evaluate((a) => window.limn.mean(a), await areaAround({ u, v }));
      if (Math.max(...material.emission) === 0 && Math.max(...lit) > 40) return { u, v };
    }
  }
  throw new Error(`no diffuse material among ${tried.join(', ')}`);
}

async function areaAround({ u, v }) {
  const { fullWidth, fullHeight } = await frameHeader(page);
  return { x: Math.round(u * fullWidth) - 2, y: Math.round(v * fullHeight) - 2, width: 5, height: 5 };
}

const greenShare = ([r, g, b]) => g / Math.max(1, r + g + b);
