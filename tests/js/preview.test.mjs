import assert from "node:assert/strict";
import test from "node:test";
import { PreviewClient } from "../../nodes/web/js/preview/client.js";
import { Playback } from "../../nodes/web/js/preview/playback.js";
import { meshOf, RecordReader } from "../../nodes/web/js/preview/records.js";

const HEADER = { version: 1, frames: 3, frame_rate: 10, vertices: 2, rig_points: 1, unit: 0.25, loop: false };

function record(type, payload) {
  const padded = Math.ceil(payload.length / 4) * 4;
  const bytes = new Uint8Array(8 + padded);
  bytes[0] = type;
  new DataView(bytes.buffer).setUint32(4, payload.length, true);
  bytes.set(payload, 8);
  return bytes;
}

const json = (type, data) => record(type, new TextEncoder().encode(JSON.stringify(data)));

function frame(number, displacements, anchors, particles) {
  const shorts = new Int16Array([...displacements, ...anchors]);
  const payload = new Uint8Array(4 + shorts.byteLength + 4 + particles.length * 2);
  const view = new DataView(payload.buffer);
  view.setUint32(0, number, true);
  payload.set(new Uint8Array(shorts.buffer), 4);
  view.setUint32(4 + shorts.byteLength, particles.length / 4, true);
  payload.set(new Uint8Array(new Int16Array(particles).buffer), 8 + shorts.byteLength);
  return record(1, payload);
}

const STREAM = [json(0, HEADER), frame(0, [0, 0, 0, 0], [0, 0], []), frame(1, [1, -2, 3, -4], [5, 6], [7, 8, 9, 1]), json(2, { frames: 2 })];

test("records are read however the bytes are cut", () => {
  const bytes = new Uint8Array(Buffer.concat(STREAM));
  for (const size of [1, 3, 7, 64, bytes.length]) {
    const reader = new RecordReader();
    const records = [];
    for (let at = 0; at < bytes.length; at += size) records.push(...reader.push(bytes.slice(at, at + size)));
    assert.deepEqual(records.map((one) => one.type), ["header", "frame", "frame", "end"]);
    assert.deepEqual([...records[2].frame.displacements], [1, -2, 3, -4]);
    assert.deepEqual([...records[2].frame.anchors], [5, 6]);
    assert.deepEqual([...records[2].frame.particles], [7, 8, 9, 1]);
  }
});

test("rig points of bodies that are not there leave the others in their places", () => {
  const reader = new RecordReader();
  const header = { ...HEADER, rig_points: 3, points: [-1, 1, 3] };
  const records = reader.push(new Uint8Array(Buffer.concat([json(0, header), frame(1, [0, 0, 0, 0], [9, 9, 5, 6, 7, 8], [])])));
  assert.deepEqual([...records[1].frame.anchors], [0, 0, 5, 6, 0, 0, 7, 8]);
});

test("a mesh is read from its header and arrays", () => {
  const header = new TextEncoder().encode(JSON.stringify({
    version: 1, width: 8, height: 4, names: ["hair"],
    arrays: [{ name: "positions", dtype: "float32", shape: [3, 2] }, { name: "triangles", dtype: "uint32", shape: [1, 3] }, { name: "bodies", dtype: "uint32", shape: [1, 2] }],
  }));
  const start = Math.ceil((4 + header.length) / 4) * 4;
  const buffer = new ArrayBuffer(start + 24 + 12 + 8);
  new DataView(buffer).setUint32(0, header.length, true);
  new Uint8Array(buffer).set(header, 4);
  new Float32Array(buffer, start, 6).set([0, 0, 4, 0, 0, 2]);
  new Uint32Array(buffer, start + 24, 3).set([0, 1, 2]);
  new Uint32Array(buffer, start + 36, 2).set([0, 1]);
  const mesh = meshOf(buffer);
  assert.deepEqual([...mesh.positions], [0, 0, 4, 0, 0, 2]);
  assert.deepEqual([[...mesh.triangles], [...mesh.bodies], mesh.width, mesh.names], [[0, 1, 2], [0, 1], 8, ["hair"]]);
});

function client(answer, delay = 0) {
  const [requests, records, errors] = [[], [], []];
  const fetch = (path, options) => {
    requests.push({ path, ...options });
    return answer(options, requests.length);
  };
  const onError = (error) => errors.push(error);
  return { requests, records, errors, client: new PreviewClient({ fetch, editor: "e", delay, onRecord: (one) => records.push(one), onError }) };
}

const streamed = (chunks) => new Response(new ReadableStream({ start(stream) { chunks.forEach((one) => stream.enqueue(one)); stream.close(); } }));
const settle = (ms = 20) => new Promise((done) => setTimeout(done, ms));

test("of changes in a row the first is asked for at once, and then the last", async () => {
  const used = client(async () => streamed(STREAM), 5);
  for (const strength of [1, 2, 3, 4]) used.client.request("k", { strength }, 3);
  assert.equal(used.requests.length, 1);
  await settle(40);
  const asked = used.requests.map((one) => JSON.parse(one.body));
  assert.deepEqual(asked, [1, 4].map((strength) => ({ editor: "e", key: "k", scene: { strength }, frames: 3 })));
  assert.equal(used.requests[0].signal.aborted, true);
  assert.equal(used.records.length, 4);
});

test("a newer request cancels the older one, whose answer is not shown", async () => {
  let release;
  const used = client((options, count) => (count === 1 ? new Promise((done) => { release = () => done(streamed(STREAM)); }) : Promise.resolve(streamed([json(0, { ...HEADER, frames: 9 })]))));
  used.client.request("k", {}, 3);
  await settle();
  used.client.request("k", {}, 9);
  await settle();
  assert.equal(used.requests[0].signal.aborted, true);
  release();
  await settle();
  assert.deepEqual(used.records.map((one) => one.header?.frames), [9]);
  assert.deepEqual(used.errors, []);
});

test("what the server refuses is an error with its sentence and status", async () => {
  const used = client(async () => Response.json({ error: "The mesh is gone." }, { status: 404 }));
  used.client.request("k", {}, 3);
  await settle();
  assert.deepEqual([used.errors[0].message, used.errors[0].status], ["The mesh is gone.", 404]);
});

test("a superseded stream ends in silence", async () => {
  const used = client(async () => streamed([STREAM[0], json(3, { error: "superseded" })]));
  used.client.request("k", {}, 3);
  await settle();
  assert.deepEqual([used.records.length, used.errors.length], [1, 0]);
});

function playing(count) {
  const playback = new Playback();
  playback.begin(HEADER, 0);
  for (let number = 0; number < count; number++) playback.add({ number });
  playback.advance(0);
  return playback;
}

test("the server gets its solver ready once, and nobody minds where it cannot", async () => {
  const used = client(async () => { throw new Error("no route"); });
  for (let k = 0; k < 3; k++) used.client.warmUp();
  await settle();
  assert.deepEqual(used.requests.map(({ path, method }) => [path, method]), [["/physanimator/warm-up", "POST"]]);
  assert.deepEqual(used.errors, []);
});

test("playing begins with what moves, goes at the frame rate, waits for frames, and begins anew at the end", () => {
  const playback = playing(2);
  assert.equal(playback.shown.number, 1);
  playback.advance(290);
  assert.equal(playback.shown.number, 1);
  playback.add({ number: 2 });
  playback.advance(390);
  assert.equal(playback.shown.number, 2);
  playback.advance(490);
  assert.equal(playback.shown.number, 0);
});

test("the motion before stands still on the screen until the new one has a frame", () => {
  const playback = playing(3);
  playback.advance(50);
  const before = playback.shown;
  playback.waiting = true;
  playback.advance(500);
  assert.equal(playback.shown, before);
  assert.equal(playback.moves, false);
  playback.begin(HEADER, 600);
  assert.equal(playback.shown, before);
  playback.add({ number: 0, fresh: true });
  assert.equal(playback.shown.fresh, true);
  playback.clear();
  assert.equal(playback.shown, null);
});

test("without looping it stops at the last frame, and starts over from there", () => {
  const playback = playing(3);
  playback.looping = false;
  for (const now of [200, 400, 600]) playback.advance(now);
  assert.deepEqual([playback.playing, playback.shown.number], [false, 2]);
  playback.toggle();
  assert.deepEqual([playback.playing, playback.position], [true, 0]);
});

test("scrubbing pauses and stays within the motion", () => {
  const playback = playing(3);
  playback.seek(99);
  assert.deepEqual([playback.playing, playback.shown.number], [false, 2]);
  playback.seek(-4);
  assert.equal(playback.shown.number, 0);
});
