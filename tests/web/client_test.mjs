// The page in Chromium against the toy server of web/dev: what a real server does seldom, or never on demand.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { startFakeServer } from '../../web/dev/fake_server.mjs';
import {
  atRest,
  drag,
  gridDifference,
  meanGrid,
  openPage,
  pick,
  pointInPicture,
  sceneOf,
  settle,
  startBrowser,
  typeNumber,
  waitFor,
} from './browser.mjs';
import { Peer } from './peer.mjs';

let server;
let browser;
let page;

before(async () => {
  server = await startFakeServer({ size: [160, 120] });
  browser = await startBrowser({ hasTouch: true });
  page = await openPage(browser.context, `http://127.0.0.1:${server.port}/`);
});

after(async () => {
  await browser?.close();
  await server?.close();
});

const ledger = () => page.locator('#ledger').textContent();
const pose = () => page.evaluate(() => window.limn.rig.current());
const distance = (p) => Math.hypot(...p.eye.map((c, i) => c - p.target[i]));

test('the picture and the line under it stay between the panels', async () => {
  await waitFor(page, () => /\d/.test(document.querySelector('#ledger .figures').textContent));
  const [left, picture, ledger, right] = await page.evaluate(() =>
    ['.column.left', '#picture', '#ledger', '.column.right'].map((place) => {
      const box = document.querySelector(place).getBoundingClientRect();
      return { from: box.left, to: box.right };
    }),
  );
  for (const shown of [picture, ledger]) assert.ok(shown.from >= left.to && shown.to <= right.from, JSON.stringify(shown));
});

test('a drag sends at most one camera edit a display frame, and the picture never goes back', async () => {
  const edits = server.world.edits;
  await drag(page, [0.2, 0.4], [0.8, 0.6]);
  await settle(page, 2);
  const sent = server.world.edits - edits;
  assert.ok(sent >= 1 && sent <= 40, `${sent} camera edits`);
  const presented = await page.evaluate(() => window.limn.presented);
  presented.slice(1).forEach((header, i) => {
    const earlier = presented[i];
    assert.ok(
      header.frameId > earlier.frameId &&
        header.viewRevision >= earlier.viewRevision &&
        header.sceneRevision >= earlier.sceneRevision,
    );
  });
  for (const client of server.world.clients) assert.ok(client.inFlight.size <= 2);
});

test('the right button and Shift pan, the wheel dollies', async () => {
  const start = await pose();
  await drag(page, [0.5, 0.5], [0.6, 0.5], { button: 'right' });
  const panned = await pose();
  assert.ok(Math.abs(distance(panned) - distance(start)) < 1e-9);
  assert.notDeepEqual(panned.target, start.target);
  const { x, y } = await pointInPicture(page, 0.5, 0.5);
  await page.mouse.move(x, y);
  await page.mouse.wheel(0, -240);
  await waitFor(
    page,
    (before) =>
      Math.hypot(...window.limn.rig.current().eye.map((c, i) => c - window.limn.rig.current().target[i])) < before,
    distance(panned),
  );
});

test('one finger turns, two fingers come nearer', async () => {
  const touch = await browser.context.newCDPSession(page);
  const { x, y } = await pointInPicture(page, 0.5, 0.5);
  const send = (type, points) =>
    touch.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([px, py], id) => ({ x: px, y: py, id })) });
  const start = await pose();
  await send('touchStart', [[x, y]]);
  for (let i = 1; i <= 5; i++) await send('touchMove', [[x + i * 10, y]]);
  await send('touchEnd', []);
  await waitFor(page, (eye) => window.limn.rig.current().eye[0] !== eye[0], start.eye);
  const turned = await pose();
  assert.ok(Math.abs(distance(turned) - distance(start)) < 1e-6, 'one finger does not dolly');
  await send('touchStart', [
    [x - 20, y],
    [x + 20, y],
  ]);
  for (let i = 1; i <= 5; i++)
    await send('touchMove', [
      [x - 20 - i * 10, y],
      [x + 20 + i * 10, y],
    ]);
  await send('touchEnd', []);
  await waitFor(
    page,
    (before) =>
      Math.hypot(...window.limn.rig.current().eye.map((c, i) => c - window.limn.rig.current().target[i])) <
      before * 0.8,
    distance(turned),
  );
});

test('two fingers side by side pan', async () => {
  const touch = await browser.context.newCDPSession(page);
  const { x, y } = await pointInPicture(page, 0.5, 0.5);
  const send = (type, left) => {
    const touchPoints = type === 'touchEnd' ? [] : [left, left + 40].map((px, id) => ({ x: px, y, id }));
    return touch.send('Input.dispatchTouchEvent', { type, touchPoints });
  };
  const start = await pose();
  await send('touchStart', x - 20);
  for (let i = 1; i <= 5; i++) await send('touchMove', x - 20 + i * 8);
  await send('touchEnd');
  await waitFor(page, (target) => window.limn.rig.current().target[0] !== target[0], start.target);
  const panned = await pose();
  assert.ok(Math.abs(distance(panned) - distance(start)) < 1e-6, 'it does not dolly');
  const moved = panned.target.map((c, i) => c - start.target[i]);
  assert.ok(Math.hypot(...moved) > 0.01 * distance(start), 'the picture moved');
  panned.eye.forEach((c, i) => assert.ok(Math.abs(c - start.eye[i] - moved[i]) < 1e-6, 'the eye moved with the target'));
});

test('keys act on the focused picture only', async () => {
  const start = await pose();
  await page.locator('#connection').click();
  await page.keyboard.press('ArrowLeft');
  assert.deepEqual(await pose(), start);
  await page.locator('#stage').focus();
  await page.keyboard.press('ArrowLeft');
  assert.notDeepEqual((await pose()).eye, start.eye);
  await page.keyboard.press('r');
  await waitFor(page, () => Math.abs(window.limn.rig.current().eye[2] - 5.2) < 1e-9);
  await settle(page, 2);
});

test('F shows all of the scene as it is by now', async () => {
  const { world } = server;
  const { boundsHigh } = world.scene;
  world.scene.boundsHigh = [9, 3, 3]; // somebody moved something; pages hear of it when they ask
  await page.locator('#stage').focus();
  await page.keyboard.press('f');
  await waitFor(page, () => Math.abs(window.limn.rig.current().target[0] - 3) < 1e-9);
  world.scene.boundsHigh = boundsHigh;
  await page.keyboard.press('r');
  await waitFor(page, () => Math.abs(window.limn.rig.current().eye[2] - 5.2) < 1e-9);
  await settle(page, 2);
});

test('picking opens the material and the object, in the panel and in the list', async () => {
  const picked = await pick(page, 0.5, 0.52);
  assert.equal(picked.material, 2);
  assert.deepEqual(await page.locator('#inspector h3').allTextContents(), ['Brass', 'Ball, middle']);
  assert.equal(await page.locator('[role=treeitem][aria-selected=true] > .row .label').textContent(), 'Ball, middle');
  assert.match(await ledger(), /Picked: Ball, middle, made of Brass/);
});

test('Control moves what is picked, by hand and by keys, and leaves the camera', async () => {
  const start = await pose();
  const translation = () => sceneOf(page).then((scene) => scene.nodes[2].translation);
  const before = await translation();
  await page.keyboard.down('Control');
  await drag(page, [0.5, 0.52], [0.6, 0.52]);
  const dragged = await translation();
  await page.keyboard.press('ArrowUp');
  await page.keyboard.up('Control');
  const [x, y] = await translation();
  assert.ok(dragged[0] > before[0] + 0.1, `from ${before} to ${dragged}`);
  assert.ok(y > dragged[1] && x === dragged[0], `from ${dragged} to ${[x, y]}`);
  assert.deepEqual((await pose()).eye, start.eye);
  await settle(page, 2);
  assert.deepEqual(server.world.scene.nodes[2].translation, await translation());
  const field = page.locator('#inspector').getByLabel('Translation X', { exact: true });
  await field.fill(String(before[0]));
  await field.press('Enter');
  await settle(page, 1);
});

test('what is written under the picture is spoken as well', async () => {
  const said = (text) => waitFor(page, (text) => document.getElementById('announcer').textContent === text, text);
  await atRest(page); // else it is told meanwhile that the picture has converged
  await pick(page, 0.5, 0.02);
  await said('Picked: nothing but the environment');
  await page.getByLabel('Scene file under the asset root').fill('other.glb');
  await page.getByRole('button', { name: 'Load' }).click();
  await said('the toy holds one scene only (other.glb)');
  assert.match(await ledger(), /the toy holds one scene only/);
});

test('the list is walked with keys and opens the same panel', async () => {
  await page.locator('[role=treeitem][data-key="light:0"]').focus();
  await page.keyboard.press('ArrowDown');
  await page.keyboard.press('Enter');
  assert.deepEqual(await page.locator('#inspector h3').allTextContents(), ['Spot', 'Spot']);
  assert.equal(await page.locator('#inspector').getByLabel('Outer cone angle', { exact: true }).count(), 1);
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press('Enter');
  assert.equal(
    await page.locator('#inspector').getByLabel('Outer cone angle', { exact: true }).count(),
    0,
    'a point light has no cone',
  );
});

test('a light edit tells its cost class and its latency', async () => {
  const before = await meanGrid(page);
  const field = page.locator('#inspector').getByLabel('Intensity', { exact: true });
  await field.fill('90');
  await field.press('Enter');
  await waitFor(page, () =>
    /Lamp, intensity: relight, \d+\.\d\d s to first pixels/.test(document.getElementById('ledger').textContent),
  );
  await settle(page, 4);
  assert.ok(gridDifference(before, await meanGrid(page)) > 10);
});

test('angles are shown in degrees and sent as a quaternion', async () => {
  await page.locator('[role=treeitem][data-key="node:1"]').click();
  const field = page.locator('#inspector').getByLabel('Rotation Z', { exact: true });
  await field.fill('90');
  await field.press('Enter');
  await waitFor(page, () => window.limn.outcomes.at(-1)?.label.includes('rotation'));
  await settle(page, 1);
  server.world.scene.nodes[1].rotation.forEach((c, i) =>
    assert.ok(Math.abs(c - [0, 0, Math.SQRT1_2, Math.SQRT1_2][i]) < 1e-6),
  );
});

test('a refused edit is told and taken back', async () => {
  await pick(page, 0.5, 0.52);
  const field = page.locator('#inspector').getByLabel('Roughness', { exact: true });
  await field.fill('0.777');
  await field.press('Enter');
  await waitFor(page, () => /does not like 0\.777/.test(document.getElementById('ledger').textContent));
  await waitFor(page, () => window.limn.model.scene.materials[2].roughness === 0.3);
  assert.equal(await field.inputValue(), '0.3');
});

test('a number outside the announced range is not sent', async () => {
  const edits = server.world.edits;
  const field = page.locator('#inspector').getByLabel('Roughness', { exact: true });
  await field.fill('3');
  await field.press('Enter');
  assert.equal(await field.getAttribute('aria-invalid'), 'true');
  await field.press('Escape');
  assert.equal(await field.inputValue(), '0.3');
  assert.equal(server.world.edits, edits);
});

test('an edit by somebody else shows in the open panel', async () => {
  const peer = await Peer.connect(server.port);
  peer.send({ op: 'set', target: 'material', material: 2, roughness: 0.42 });
  await page.waitForFunction(() =>
    [...document.querySelectorAll('#inspector input.number')].some((input) => input.value === '0.42'),
  );
  peer.close();
});

test('another technique brings its own parameters', async () => {
  const technique = page.locator('#render').getByLabel('Technique', { exact: true });
  await technique.selectOption('flat');
  await page.locator('#render').getByLabel('Gain', { exact: true }).waitFor();
  assert.equal(await page.locator('#render').getByLabel('Max bounces', { exact: true }).count(), 0);
  await waitFor(
    page,
    () => window.limn.model.scene.technique === 'flat' && window.limn.model.scene.parameters.gain === 1,
  );
  await technique.selectOption('path-tracing');
  await page.locator('#render').getByLabel('Max bounces', { exact: true }).waitFor();
});

test('another picture size arrives on the canvas', async () => {
  await page.locator('#render').getByLabel('Picture size', { exact: true }).selectOption('256x256');
  await waitFor(page, () => window.limn.frame.header.fullWidth === 256);
  const { width, height } = await page.evaluate(() => window.limn.hash());
  assert.deepEqual([width, height], [256, 256]);
});

test('a camera of the file moves the view', async () => {
  assert.ok((await pick(page, 0.5, 0.52)).hit);
  await page.locator('[role=treeitem][data-key="camera:0"]').click();
  await waitFor(
    page,
    () => Math.abs(window.limn.rig.current().eye[1] - 1.4) < 1e-9 && window.limn.rig.current().eye[2] === 5,
  );
  const pivot = await page.evaluate(() => window.limn.rig.pivot());
  assert.deepEqual(pivot, (await pose()).target, 'it turns about its own target, not about what was picked before');
});

test('the field of view stays as it was typed, and follows the camera back', async () => {
  const field = page.locator('#render').getByLabel('Field of view', { exact: true });
  const before = await field.inputValue();
  await typeNumber(page, '#render', 'Field of view', 30);
  await typeNumber(page, '#render', 'Exposure', 0.5);
  assert.equal(await field.inputValue(), '30');
  assert.ok(Math.abs((await pose()).lens.yfov - Math.PI / 6) < 1e-9);
  await page.locator('#stage').focus();
  await page.keyboard.press('r');
  await settle(page, 0);
  assert.equal(await field.inputValue(), before);
});

test('every input has a name, and the live region speaks', async () => {
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll('input, select, button')]
      .filter((e) => !e.getAttribute('aria-label') && !e.labels?.length && !e.textContent.trim())
      .map((e) => e.outerHTML),
  );
  assert.deepEqual(nameless, []);
  const ids = await page.evaluate(() => [...document.querySelectorAll('[id]')].map((e) => e.id));
  assert.equal(new Set(ids).size, ids.length);
  await page.waitForFunction(() => document.getElementById('announcer').textContent !== '');
  const live = await page
    .locator('output, [role=status], [role=alert], [aria-live]')
    .evaluateAll((list) => list.map((e) => e.id));
  assert.deepEqual(live, ['announcer'], 'one region speaks, and it keeps its pace');
});

test('a narrow window keeps the picture and shows one panel at a time', async () => {
  await page.setViewportSize({ width: 390, height: 780 });
  const panels = () => page.locator('.panel:visible').evaluateAll((list) => list.map((e) => e.id));
  assert.deepEqual(await panels(), ['panel-inspector']);
  await page.locator('#tabs').getByText('Statistics').click();
  assert.deepEqual(await panels(), ['panel-stats']);
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.equal(overflow, 0);
  await page.setViewportSize({ width: 1280, height: 800 });
});

test('a server that refuses the socket is told from one that is away', async () => {
  const { port } = server;
  await server.close();
  await waitFor(page, () => window.limn.model.connection.kind === 'reconnecting');
  server = await startFakeServer({ port, refuse: true });
  await waitFor(page, () => window.limn.model.connection.kind === 'refused');
  assert.match(await page.locator('#stale').textContent(), /^Stale picture — refused: the server is up/);
  await server.close();
  server = await startFakeServer({ port });
  await page.getByRole('button', { name: 'Retry now' }).click();
  await waitFor(page, () => window.limn.model.connection.kind === 'connected');
  assert.equal((await sceneOf(page)).materials[2].roughness, 0.3, "the new server's truth is shown");
});

test('nothing went wrong in the page', async () => {
  assert.deepEqual(page.errors, []);
  assert.deepEqual(await page.evaluate(() => window.limn.faults), []);
});
