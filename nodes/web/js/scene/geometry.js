/**
 * Plane geometry and the view on the picture. Points are [x, y], x to the right, y down.
 *
 * @typedef {import("./document.js").Point} Point
 * @typedef {{scale: number, x: number, y: number}} View  stage = picture * scale + (x, y)
 */

const NEAREST = 64;
/** So much larger than the whole picture a piece of it must be, for a page to be shown in pieces. */
const LONG = 2.5;

/**
 * @param {View} view
 * @param {Point} point  of the picture [px]
 * @returns {Point} on the stage [CSS px]
 */
export function toStage(view, [x, y]) {
  return [x * view.scale + view.x, y * view.scale + view.y];
}

/**
 * @param {View} view
 * @param {Point} point  on the stage [CSS px]
 * @returns {Point} of the picture [px]
 */
export function toPicture(view, [x, y]) {
  return [(x - view.x) / view.scale, (y - view.y) / view.scale];
}

/**
 * The view that shows the whole picture in the middle.
 *
 * @param {number} width  of the picture [px]
 * @param {number} height
 * @param {number} across  of the stage [CSS px]
 * @param {number} down
 * @param {number} margin  [CSS px]
 * @returns {View}
 */
export function fittingView(width, height, across, down, margin = 8) {
  const room = [Math.max(across - 2 * margin, 1), Math.max(down - 2 * margin, 1)];
  const scale = Math.min(room[0] / width, room[1] / height);
  return { scale, x: (across - width * scale) / 2, y: (down - height * scale) / 2 };
}

/**
 * @param {number} width  of the picture
 * @param {number} height
 * @param {number} across  of the stage
 * @param {number} down
 * @returns {boolean} whether of the whole picture hardly anything can be seen
 */
export function isLong(width, height, across, down) {
  return Math.min(across, down) / Math.min(width, height) >= LONG * fittingView(width, height, across, down, 0).scale;
}

/**
 * The view to begin with: the whole picture, or of a long page a piece in which something can be seen.
 *
 * @param {number} width  of the picture
 * @param {number} height
 * @param {number} across  of the stage
 * @param {number} down
 * @param {number} margin
 * @param {Point} about  of the picture, which a piece of it shows
 * @returns {View}
 */
export function startingView(width, height, across, down, margin, about) {
  if (!isLong(width, height, across, down)) return fittingView(width, height, across, down, margin);
  // A square over the whole of the shorter side.
  const scale = Math.max(Math.min(across, down) - 2 * margin, 1) / Math.min(width, height);
  return { scale, x: pannedTo(about[0], width * scale, across, scale, margin), y: pannedTo(about[1], height * scale, down, scale, margin) };
}

/**
 * @param {number} about  what shall be in the middle, as far as the picture reaches [px of the picture]
 * @param {number} length  of the picture on the stage
 * @param {number} room  of the stage
 * @param {number} scale
 * @param {number} margin
 */
function pannedTo(about, length, room, scale, margin) {
  if (length + 2 * margin <= room) return (room - length) / 2;
  return Math.min(Math.max(room / 2 - about * scale, room - margin - length), margin);
}

/**
 * @param {View} view
 * @param {Point} stagePoint  that stays where it is
 * @param {number} factor
 * @param {number} least  smallest scale
 * @returns {View}
 */
export function zoomed(view, stagePoint, factor, least) {
  const scale = Math.min(Math.max(view.scale * factor, least), NEAREST);
  const [x, y] = toPicture(view, stagePoint);
  return { scale, x: stagePoint[0] - x * scale, y: stagePoint[1] - y * scale };
}

/**
 * A point as it is kept: to a tenth of a pixel.
 *
 * @param {Point} point
 * @returns {Point}
 */
export function rounded([x, y]) {
  return [tenth(x), tenth(y)];
}

/** @param {number} value */
export function tenth(value) {
  return Math.round(value * 10) / 10 || 0;
}

/**
 * @param {Point} a
 * @param {Point} b
 */
export function distance(a, b) {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}

/**
 * @param {Point} p
 * @param {Point} a
 * @param {Point} b
 */
export function distanceToSegment(p, a, b) {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const squared = dx * dx + dy * dy;
  const share = squared ? ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / squared : 0;
  const t = Math.min(Math.max(share, 0), 1);
  return Math.hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy);
}

/**
 * @param {Point} point
 * @param {Point[]} path
 * @param {boolean} closed
 */
export function distanceToPath(point, path, closed = false) {
  if (path.length === 1) return distance(point, path[0]);
  let least = Infinity;
  for (let i = closed ? 0 : 1; i < path.length; i++) {
    least = Math.min(least, distanceToSegment(point, path.at(i - 1) ?? path[0], path[i]));
  }
  return least;
}

/**
 * Whether a point lies inside a closed outline (even-odd rule).
 *
 * @param {Point} point
 * @param {Point[]} outline
 */
export function isInside([x, y], outline) {
  let inside = false;
  for (let i = 0, j = outline.length - 1; i < outline.length; j = i++) {
    const [xi, yi] = outline[i];
    const [xj, yj] = outline[j];
    if (yi > y !== yj > y && x < ((xj - xi) * (y - yi)) / (yj - yi) + xi) inside = !inside;
  }
  return inside;
}

/**
 * @param {Point[]} outline
 * @returns {Point} middle of the corners
 */
export function middle(outline) {
  const sum = outline.reduce((total, p) => [total[0] + p[0], total[1] + p[1]], [0, 0]);
  return [sum[0] / outline.length, sum[1] / outline.length];
}

/** @param {Point[]} outline [px^2], without sign */
export function areaOf(outline) {
  let twice = 0;
  for (let i = 0, j = outline.length - 1; i < outline.length; j = i++) {
    twice += outline[j][0] * outline[i][1] - outline[i][0] * outline[j][1];
  }
  return Math.abs(twice) / 2;
}

/** @param {Point[]} path */
export function lengthOf(path) {
  let length = 0;
  for (let i = 1; i < path.length; i++) length += distance(path[i - 1], path[i]);
  return length;
}

/**
 * The point at a share of a path's length, and the unit direction there.
 *
 * @param {Point[]} path
 * @param {number} share  0 to 1
 * @returns {{point: Point, direction: Point}}
 */
export function along(path, share) {
  let rest = lengthOf(path) * share;
  for (let i = 1; i < path.length; i++) {
    const length = distance(path[i - 1], path[i]);
    if (length > 0 && (rest <= length || i === path.length - 1)) {
      const [a, b] = [path[i - 1], path[i]];
      /** @type {Point} */
      const direction = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
      return { point: [a[0] + direction[0] * rest, a[1] + direction[1] * rest], direction };
    }
    rest -= length;
  }
  return { point: path[0], direction: [1, 0] };
}

/**
 * Which points of a drawn path to keep, so that the rest lies within a tolerance of what is kept (Ramer, Douglas and
 * Peucker).
 *
 * @param {Point[]} path
 * @param {number} tolerance  [px]
 * @returns {number[]} rising indices, the first and the last among them
 */
export function simplified(path, tolerance) {
  const kept = new Set([0, path.length - 1]);
  const open = [[0, path.length - 1]];
  for (let span = open.pop(); span; span = open.pop()) {
    const [first, last] = span;
    let [farthest, most] = [-1, tolerance];
    for (let i = first + 1; i < last; i++) {
      const away = distanceToSegment(path[i], path[first], path[last]);
      if (away > most) [farthest, most] = [i, away];
    }
    if (farthest < 0) continue;
    kept.add(farthest);
    open.push([first, farthest], [farthest, last]);
  }
  return [...kept].sort((a, b) => a - b);
}
