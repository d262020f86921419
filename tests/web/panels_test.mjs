// The panels in Chromium against the toy server of web/dev: list, fields, undo, saving and the size of the picture.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { startFakeServer } from '../../web/dev/fake_server.mjs';
import {
  atRest,
  openPage,
  pick,
  requireFromWeb,
  sceneOf,
  settle,
  startBrowser,
  typeNumber,
  waitFor,
} from './browser.mjs';
import { Peer } from './peer.mjs';

const { PNG } = requireFromWeb('pngjs');

let server;
let browser;
let page;

before(async () => {
  server = await startFakeServer({ size: [160, 120] });
  browser = await startBrowser();
  page = await openPage(browser.context, `http://127.0.0.1:${server.port}/`);
});

after(async () => {
  await browser?.close();
  await server?.close();
});

test('a group that was folded stays so while somebody else edits', async () => {
  const group = page.locator('[role=treeitem][data-key="group:nodes"]');
  await pick(page, 0.5, 0.52);
  assert.equal(await group.locator('[aria-selected=true]').count(), 1);
  await group.locator('> .row .twist').click();
  const peer = await Peer.connect(server.port);
  const edited = async (fields) => {
    peer.send({ op: 'set', target: 'material', material: 1, ...fields });
    const [[name, value]] = Object.entries(fields);
    await waitFor(
      page,
      ([name, value]) => JSON.stringify(window.limn.model.scene.materials[1][name]) === JSON.stringify(value),
      [name, value],
    );
    assert.equal(await group.getAttribute('aria-expanded'), 'false', `after an edit of ${name}`);
  };
  await edited({ roughness: 0.6 });
  await edited({ emission: [0, 1, 0] }); // another row in the list
  await edited({ emission: [0, 0, 0] });
  peer.close();
  await page.locator('[role=treeitem][data-key="light:0"]').click();
  await pick(page, 0.5, 0.52);
  assert.equal(await group.getAttribute('aria-expanded'), 'true', 'what is picked is shown');
});

test('a light that was turned off and on again keeps its colour', async () => {
  await page.locator('[role=treeitem][data-key="environment:0"]').click();
  const radiance = () => sceneOf(page).then((scene) => scene.environment.radiance);
  await typeNumber(page, '#inspector', 'Strength', 0);
  assert.deepEqual(await radiance(), [0, 0, 0]);
  await typeNumber(page, '#inspector', 'Strength', 0.4);
  (await radiance()).forEach((c, i) => assert.ok(Math.abs(c - [0.25, 0.3, 0.4][i]) < 1e-6));
});

test('an arrow key moves the slider of a whole number to the next', async () => {
  const field = page.locator('#render').getByLabel('Max bounces', { exact: true });
  await page.locator('#render').getByLabel('Max bounces, slider', { exact: true }).focus();
  await page.keyboard.press('ArrowRight');
  assert.equal(await field.inputValue(), '9');
  await page.keyboard.press('ArrowLeft');
  assert.equal(await field.inputValue(), '8');
  await settle(page, 1);
});

test('a drag of a slider is undone as a whole, and redone', async () => {
  const roughness = () => sceneOf(page).then((scene) => scene.materials[2].roughness);
  await pick(page, 0.5, 0.52);
  const before = await roughness();
  const box = await page.locator('#inspector').getByLabel('Roughness, slider', { exact: true }).boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.9, box.y + box.height / 2, { steps: 8 });
  await page.mouse.up();
  const after = await roughness();
  assert.ok(after > before + 0.2, `from ${before} to ${after}`);
  await page.keyboard.press('Control+z');
  assert.equal(await roughness(), before);
  await settle(page, 0);
  assert.equal(server.world.scene.materials[2].roughness, before);
  await page.keyboard.press('Control+Shift+Z');
  assert.equal(await roughness(), after);
  await page.getByRole('button', { name: 'Undo' }).click();
  assert.equal(await roughness(), before);
  await page.locator('#inspector').getByLabel('Roughness', { exact: true }).focus();
  await page.keyboard.press('Control+y');
  assert.equal(await roughness(), before, 'in a text field the keys are for what is typed');
  await settle(page, 0);
});

test('what was edited before a connection broke can be undone after it', async () => {
  const before = server.world.scene.environment.rotation;
  await page.locator('[role=treeitem][data-key="environment:0"]').click();
  await typeNumber(page, '#inspector', 'Rotation', 20);
  assert.notEqual(server.world.scene.environment.rotation, before);
  await page.evaluate(() => {
    window.joined = new Promise((resolve) =>
      window.limn.model.on('scene', ({ cause }) => cause === 'joined' && resolve()),
    );
  });
  for (const client of server.world.clients) client.socket.terminate();
  await page.evaluate(() => window.joined);
  await page.getByRole('button', { name: 'Undo' }).click();
  await settle(page, 0);
  assert.equal(server.world.scene.environment.rotation, before);
});

test('the picture is saved as it is shown', async () => {
  await atRest(page);
  const waiting = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Save PNG' }).click();
  const download = await waiting;
  assert.equal(download.suggestedFilename(), 'fake.png');
  const png = PNG.sync.read(readFileSync(await download.path()));
  const shown = await page.evaluate(() => window.limn.hash());
  assert.ok(shown.distinct > 16);
  assert.equal(createHash('sha256').update(png.data).digest('hex'), shown.sha256);
});

test('a picture of the size of the window follows the window', async () => {
  const size = page.locator('#render').getByLabel('Picture size', { exact: true });
  const followed = () =>
    waitFor(page, () => {
      const { clientWidth, clientHeight } = document.getElementById('stage');
      const { fullWidth, fullHeight } = window.limn.frame.header;
      return fullWidth === clientWidth && fullHeight === clientHeight;
    });
  await page.setViewportSize({ width: 1120, height: 420 });
  await size.selectOption('window');
  await followed();
  await page.setViewportSize({ width: 1120, height: 380 });
  await followed();
  assert.equal(await size.inputValue(), 'window');
  await size.selectOption('256x256');
  await page.setViewportSize({ width: 1280, height: 800 });
  // Nothing may follow, and no event tells of that: this waits longer than a resized window takes to settle (250 ms).
  await page.waitForTimeout(1000);
  await settle(page, 0);
  assert.equal(await size.inputValue(), '256x256');
  assert.deepEqual([server.world.scene.width, server.world.scene.height], [256, 256]);
});

test('nothing went wrong in the page', async () => {
  assert.deepEqual(page.errors, []);
  assert.deepEqual(await page.evaluate(() => window.limn.faults), []);
});
