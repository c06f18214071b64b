/**
 * Draws the layers of an artwork over one another in WebGL: still ones as they are, moving ones on their meshes.
 *
 * @typedef {import("./records.js").Mesh} Mesh
 *
 * @typedef {object} DrawnLayer  from back to front
 * @property {number} layer  its index in the artwork
 * @property {number | null} body  which of the mesh's bodies it is, from the back; null where it stands still
 * @property {[number, number, number, number]} box  left, top, width and height of what its picture shows [px]
 * @property {string} blend
 * @property {TexImageSource} picture
 */

export class LayeredPicture {
  /**
   * @param {WebGLRenderingContext} gl
   * @param {Mesh} mesh
   * @param {DrawnLayer[]} layers
   * @param {(gl: WebGLRenderingContext, picture: TexImageSource) => WebGLTexture | null} upload
   */
  constructor(gl, mesh, layers, upload) {
    this.mesh = mesh;
    this.layers = layers;
    /** Numbers of the layers from back to front. */
    this.order = layers.map((_, number) => number);
    this.textures = layers.map((layer) => upload(gl, layer.picture));
    this.corners = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.corners);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(layers.flatMap(({ box }) => cornersOf(box))), gl.STATIC_DRAW);
  }

  /**
   * @param {WebGLRenderingContext} gl
   * @param {Set<number>} unseen  indices of layers that are left out
   * @param {object} hands
   * @param {(box: [number, number, number, number]) => void} hands.cover  let the texture cover a box
   * @param {(rest: WebGLBuffer | null, offset: number) => void} hands.still  point to corners that stand still
   * @param {() => void} hands.moving  point to the vertices of the mesh
   */
  draw(gl, unseen, { cover, still, moving }) {
    gl.enable(gl.BLEND);
    for (const number of this.order) {
      const layer = this.layers[number];
      if (unseen.has(layer.layer)) continue;
      blend(gl, layer.blend);
      cover(layer.box);
      gl.bindTexture(gl.TEXTURE_2D, this.textures[number]);
      if (layer.body === null) {
        still(this.corners, number * 32);
        gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
        continue;
      }
      moving();
      const [first, end] = this.mesh.bodies.subarray(2 * layer.body, 2 * layer.body + 2);
      gl.drawElements(gl.TRIANGLES, 3 * (end - first), gl.UNSIGNED_INT, 12 * first);
    }
    blend(gl, "normal");
    gl.disable(gl.BLEND);
  }

  /** @param {number[]} indices  of layers from back to front */
  arrange(indices) {
    this.order.sort((one, other) => indices.indexOf(this.layers[one].layer) - indices.indexOf(this.layers[other].layer));
  }

  /** The layers as they lie now, from back to front. */
  get stacked() {
    return this.order.map((number) => this.layers[number]);
  }

  /** @param {WebGLRenderingContext} gl */
  release(gl) {
    for (const texture of this.textures) gl.deleteTexture(texture);
    gl.deleteBuffer(this.corners);
  }
}

/** @param {[number, number, number, number]} box */
function cornersOf([left, top, width, height]) {
  return [left, top, left + width, top, left, top + height, left + width, top + height];
}

/**
 * How a layer mixes with what is below; all colours are multiplied by their alpha.
 *
 * @param {WebGLRenderingContext} gl
 * @param {string} mode
 */
function blend(gl, mode) {
  /** @type {Record<string, [number, number]>} */
  const factors = {
    multiply: [gl.DST_COLOR, gl.ONE_MINUS_SRC_ALPHA],
    screen: [gl.ONE, gl.ONE_MINUS_SRC_COLOR],
    add: [gl.ONE, gl.ONE],
  };
  const [source, target] = factors[mode] ?? [gl.ONE, gl.ONE_MINUS_SRC_ALPHA];
  gl.blendFuncSeparate(source, target, gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
}

/**
 * The body that is seen at a point, in front of all others.
 *
 * @param {Mesh} mesh
 * @param {Pick<DrawnLayer, "layer" | "body">[]} layers  from back to front
 * @param {Set<number>} unseen
 * @param {[number, number]} point  [px]
 * @param {Int16Array | null} displacements  [unit]
 * @param {number} unit  [px]
 * @returns {number | null} index of its layer
 */
export function layerAt(mesh, layers, unseen, [x, y], displacements, unit) {
  const { positions, triangles, bodies } = mesh;
  /** @type {(vertex: number, axis: number) => number} */
  const place = (vertex, axis) => positions[2 * vertex + axis] + (displacements ? displacements[2 * vertex + axis] * unit : 0);
  /** @type {(a: number, b: number) => number} */
  const side = (a, b) => (place(b, 0) - place(a, 0)) * (y - place(a, 1)) - (place(b, 1) - place(a, 1)) * (x - place(a, 0));
  for (const { layer, body } of [...layers].reverse()) {
    if (body === null || unseen.has(layer)) continue;
    for (let i = 3 * bodies[2 * body]; i < 3 * bodies[2 * body + 1]; i += 3) {
      const [a, b, c] = triangles.subarray(i, i + 3);
      const sides = [side(a, b), side(b, c), side(c, a)];
      if (sides.every((one) => one >= 0) || sides.every((one) => one <= 0)) return layer;
    }
  }
  return null;
}
