/**
 * Draws the illustration as a textured mesh over the clean plate, or in layers, in WebGL.
 *
 * @typedef {import("./records.js").Mesh} Mesh
 * @typedef {import("../scene/geometry.js").View} View
 */

import { LayeredPicture } from "./layered_picture.js";

const VERTEX = `
attribute vec2 rest;
attribute vec2 displacement;
uniform vec2 origin;
uniform vec2 size;
uniform vec2 stage;
uniform vec3 view;
uniform float unit;
varying vec2 place;
void main() {
  place = (rest - origin) / size;
  vec2 at = ((rest + displacement * unit) * view.x + view.yz) / stage;
  gl_Position = vec4(at.x * 2.0 - 1.0, 1.0 - at.y * 2.0, 0.0, 1.0);
}`;

const FRAGMENT = `
precision mediump float;
uniform sampler2D picture;
uniform vec4 ink;
varying vec2 place;
void main() { gl_FragColor = ink.a > 0.0 ? ink : texture2D(picture, place); }`;

/** Colour of the mesh's edges, multiplied by how opaque it is. */
const INK = /** @type {const} */ ([0, 0.55, 0.7, 0.7]);

export class Player {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    /** @type {Mesh | null} */
    this.mesh = null;
    /** @type {WebGLRenderingContext | null} */
    this.gl = null;
    /** @type {TexImageSource | null} */
    this.picture = null;
    /** @type {TexImageSource | null} */
    this.plate = null;
    /** @type {import("./layered_picture.js").DrawnLayer[]} from back to front; none where the picture is flat */
    this.layers = [];
    /** @type {LayeredPicture | null} */
    this.layered = null;
    /** @type {number[]} indices of the layers as they lie, from back to front; empty for as they came */
    this.arrangement = [];
    /** @type {Set<number>} indices of layers that are not drawn */
    this.unseen = new Set();
    this.ready = false;
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      this.ready = false;
    });
    canvas.addEventListener("webglcontextrestored", () => this.#restore());
  }

  /** A page has only a few contexts: each editor takes one when there is something to play. */
  #open() {
    if (this.gl) return;
    const wanted = { alpha: true, premultipliedAlpha: true, preserveDrawingBuffer: true };
    const context = (/** @type {WebGLContextAttributes} */ more) => this.canvas.getContext("webgl", { ...wanted, ...more });
    // Smooth edges where a graphics card draws them; without one they would take several times as long as all the rest.
    const gl = context({ failIfMajorPerformanceCaveat: true }) ?? context({ antialias: false });
    this.gl = /** @type {WebGLRenderingContext | null} */ (gl);
    if (this.gl) this.#prepare(this.gl);
  }

  /** @param {WebGLRenderingContext} gl */
  #prepare(gl) {
    const program = linked(gl);
    gl.useProgram(program);
    this.places = {
      rest: gl.getAttribLocation(program, "rest"),
      displacement: gl.getAttribLocation(program, "displacement"),
      origin: gl.getUniformLocation(program, "origin"),
      size: gl.getUniformLocation(program, "size"),
      stage: gl.getUniformLocation(program, "stage"),
      view: gl.getUniformLocation(program, "view"),
      unit: gl.getUniformLocation(program, "unit"),
      ink: gl.getUniformLocation(program, "ink"),
    };
    gl.enableVertexAttribArray(this.places.rest);
    gl.enableVertexAttribArray(this.places.displacement);
    gl.getExtension("OES_element_index_uint");
    const plate = { rest: gl.createBuffer(), displacement: gl.createBuffer() };
    this.buffers = { rest: gl.createBuffer(), displacement: gl.createBuffer(), triangles: gl.createBuffer(), edges: gl.createBuffer(), plate };
    this.textures = { picture: texture(gl), plate: texture(gl) };
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.ready = true;
  }

  #restore() {
    if (!this.gl) return;
    this.layered = null;
    this.#prepare(this.gl);
    if (this.mesh && this.layers.length) this.loadLayers(this.mesh, this.layers);
    else if (this.mesh && this.picture && this.plate) this.load(this.mesh, this.picture, this.plate);
  }

  /**
   * @param {Mesh} mesh
   * @param {TexImageSource} picture  the illustration
   * @param {TexImageSource} plate  what is behind the bodies
   */
  load(mesh, picture, plate) {
    this.#open();
    this.mesh = mesh;
    this.picture = picture;
    this.plate = plate;
    const { gl, textures } = this;
    if (!gl || !textures) return;
    this.#fill(gl, mesh);
    upload(gl, textures.picture, picture);
    upload(gl, textures.plate, plate);
  }

  /**
   * @param {Mesh} mesh
   * @param {import("./layered_picture.js").DrawnLayer[]} layers  from back to front
   */
  loadLayers(mesh, layers) {
    this.#open();
    this.mesh = mesh;
    this.layers = layers;
    const { gl } = this;
    if (!gl) return;
    this.#fill(gl, mesh);
    this.layered?.release(gl);
    this.layered = new LayeredPicture(gl, mesh, layers, (one, picture) => {
      const made = texture(one);
      upload(one, made, picture);
      return made;
    });
    this.arrange(this.arrangement);
  }

  /** @param {number[]} indices  of the layers from back to front */
  arrange(indices) {
    this.arrangement = indices;
    if (indices.length) this.layered?.arrange(indices);
  }

  /** The layers as they lie, from back to front. */
  get stacked() {
    return this.layered?.stacked ?? this.layers;
  }

  /**
   * @param {WebGLRenderingContext} gl
   * @param {Mesh} mesh
   */
  #fill(gl, mesh) {
    const { buffers } = this;
    if (!buffers) return;
    fill(gl, gl.ARRAY_BUFFER, buffers.rest, mesh.positions);
    fill(gl, gl.ELEMENT_ARRAY_BUFFER, buffers.triangles, mesh.triangles);
    fill(gl, gl.ELEMENT_ARRAY_BUFFER, buffers.edges, edgesOf(mesh.triangles));
    const { width, height } = mesh;
    fill(gl, gl.ARRAY_BUFFER, buffers.plate.rest, new Float32Array([0, 0, width, 0, 0, height, width, height]));
    fill(gl, gl.ARRAY_BUFFER, buffers.plate.displacement, new Int16Array(8));
  }

  unload() {
    this.mesh = null;
    this.layers = [];
    if (this.gl) this.layered?.release(this.gl);
    this.layered = null;
    this.clear();
  }

  clear() {
    this.gl?.clearColor(0, 0, 0, 0);
    this.gl?.clear(this.gl.COLOR_BUFFER_BIT);
  }

  /**
   * @param {View} view
   * @param {number} across  of the stage [CSS px]
   * @param {number} down
   * @param {Int16Array} displacements  [unit]
   * @param {number} unit  [px]
   * @param {boolean} meshShown  its edges too
   */
  draw(view, across, down, displacements, unit, meshShown) {
    const { gl, mesh, places, buffers, textures } = this;
    if (!gl || !mesh || !places || !buffers || !textures || !this.ready) return;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    this.clear();
    gl.uniform2f(places.origin, 0, 0);
    gl.uniform2f(places.size, mesh.width, mesh.height);
    gl.uniform2f(places.stage, across, down);
    gl.uniform3f(places.view, view.scale, view.x, view.y);
    gl.uniform1f(places.unit, unit);
    fill(gl, gl.ARRAY_BUFFER, buffers.displacement, displacements, gl.STREAM_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffers.triangles);
    if (this.layered) this.#drawLayers(gl, this.layered);
    else this.#drawPicture(gl, mesh);
    if (meshShown) this.#drawEdges(gl, mesh);
  }

  /**
   * @param {WebGLRenderingContext} gl
   * @param {Mesh} mesh
   */
  #drawPicture(gl, mesh) {
    const { buffers, textures } = this;
    if (!buffers || !textures) return;
    this.#point(gl, buffers.plate.rest, buffers.plate.displacement);
    gl.bindTexture(gl.TEXTURE_2D, textures.plate);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    this.#point(gl, buffers.rest, buffers.displacement);
    gl.bindTexture(gl.TEXTURE_2D, textures.picture);
    gl.drawElements(gl.TRIANGLES, mesh.triangles.length, gl.UNSIGNED_INT, 0);
  }

  /**
   * @param {WebGLRenderingContext} gl
   * @param {LayeredPicture} layered
   */
  #drawLayers(gl, layered) {
    const { places, buffers } = this;
    if (!places || !buffers) return;
    layered.draw(gl, this.unseen, {
      cover: ([left, top, width, height]) => {
        gl.uniform2f(places.origin, left, top);
        gl.uniform2f(places.size, width, height);
      },
      still: (rest, offset) => this.#point(gl, rest, buffers.plate.displacement, offset),
      moving: () => this.#point(gl, buffers.rest, buffers.displacement),
    });
    this.#point(gl, buffers.rest, buffers.displacement);
  }

  /**
   * @param {WebGLRenderingContext} gl
   * @param {Mesh} mesh  of which the vertices are in place already
   */
  #drawEdges(gl, mesh) {
    const { places, buffers } = this;
    if (!places || !buffers) return;
    gl.enable(gl.BLEND);
    gl.uniform4f(places.ink, ...INK);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffers.edges);
    gl.drawElements(gl.LINES, 2 * mesh.triangles.length, gl.UNSIGNED_INT, 0);
    gl.uniform4f(places.ink, 0, 0, 0, 0);
    gl.disable(gl.BLEND);
  }

  /**
   * @param {WebGLRenderingContext} gl
   * @param {WebGLBuffer | null} rest
   * @param {WebGLBuffer | null} displacement
   * @param {number} [offset]  of the first vertex at rest [bytes]
   */
  #point(gl, rest, displacement, offset = 0) {
    const places = /** @type {{rest: number, displacement: number}} */ (this.places);
    gl.bindBuffer(gl.ARRAY_BUFFER, rest);
    gl.vertexAttribPointer(places.rest, 2, gl.FLOAT, false, 0, offset);
    gl.bindBuffer(gl.ARRAY_BUFFER, displacement);
    gl.vertexAttribPointer(places.displacement, 2, gl.SHORT, false, 0, 0);
  }

  /** Give the context back. */
  release() {
    this.ready = false;
    this.gl?.getExtension("WEBGL_lose_context")?.loseContext();
  }
}

/**
 * The ends of each triangle's edges.
 *
 * @param {Uint32Array} triangles
 */
function edgesOf(triangles) {
  const ends = new Uint32Array(2 * triangles.length);
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = triangles.subarray(i, i + 3);
    ends.set([a, b, b, c, c, a], 2 * i);
  }
  return ends;
}

/** @param {WebGLRenderingContext} gl */
function linked(gl) {
  const program = /** @type {WebGLProgram} */ (gl.createProgram());
  for (const [type, source] of /** @type {[number, string][]} */ ([[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]])) {
    const shader = /** @type {WebGLShader} */ (gl.createShader(type));
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  return program;
}

/** @param {WebGLRenderingContext} gl */
function texture(gl) {
  const made = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, made);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
  return made;
}

/**
 * @param {WebGLRenderingContext} gl
 * @param {WebGLTexture | null} target
 * @param {TexImageSource} source
 */
function upload(gl, target, source) {
  gl.bindTexture(gl.TEXTURE_2D, target);
  gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, true); // the canvas is so, too: sprites let the stage show through
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, source);
}

/**
 * @param {WebGLRenderingContext} gl
 * @param {number} kind
 * @param {WebGLBuffer | null} buffer
 * @param {ArrayBufferView} data
 * @param {number} usage
 */
function fill(gl, kind, buffer, data, usage = gl.STATIC_DRAW) {
  gl.bindBuffer(kind, buffer);
  gl.bufferData(kind, data, usage);
}
