// The frames of a file of JSON lines: what other formats must say, too.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

export function framesOf(path) {
  const lines = readFileSync(path, "utf8").trimEnd().split("\n").map(JSON.parse);
  assert.equal(lines[0].type, "header");
  const frames = lines.slice(1);
  assert.ok(frames.length > 1 && frames.every((frame) => frame.type === "frame"));
  return frames;
}

// JSON lines have four decimals of a metre.
export const ROUNDED_M = 0.000051;

export function near(got, want, limit, what) {
  assert.equal(got.length, want.length, what);
  for (let i = 0; i < got.length; ++i)
    assert.ok(Math.abs(got[i] - want[i]) <= limit, `${what}: ${Array.from(got)} is not ${Array.from(want)}`);
}
