/**
 * The editor: puts the parts together. It knows nothing of the host; what it needs of it is handed in.
 *
 * @typedef {import("../scene/document.js").Point} Point
 * @typedef {import("../scene/document.js").Reference} Reference
 * @typedef {import("../scene/document.js").SceneDocument} SceneDocument
 *
 * @typedef {object} EditorOptions
 * @property {{read: (text: string) => SceneDocument, write: (document: SceneDocument) => string}} format  of the value
 * @property {string[][]} groups  of buttons
 * @property {boolean} moves  whether there is time and motion
 * @property {string} [empty]  what to do while there are no points
 * @property {string} [title]  of the large view
 * @property {import("../preview/client.js").Fetch} fetch
 * @property {(text: string) => void} onChange  a new value
 * @property {() => void} onKept  the same, a moment later where something is about to move
 * @property {() => void} onRun  the user wants this node to run
 * @property {import("./picking.js").PickOptions | null} [picks]  where parts are picked
 */

import { say } from "../host/words.js";
import { ACTIONS } from "../panels/toolbar.js";
import { canonical } from "../scene/canonical.js";
import { emptyDocument, itemAt, withItem, withValue, workOf } from "../scene/document.js";
import { sideOf } from "../scene/items.js";
import { withFoundHolds, withLostHolds } from "../scene/holds.js";
import { inOrder, isAsRun, withNames } from "../scene/layers.js";
import { handlesOf } from "../scene/shapes.js";
import { Layers } from "../stage/layers.js";
import { Scheduler } from "../stage/scheduler.js";
import { Backdrop } from "./backdrop.js";
import { Commands } from "./commands.js";
import { listenTo } from "./input.js";
import { layout } from "./layout.js";
import { Live } from "./live.js";
import { Notes } from "./notes.js";
import { Picking } from "./picking.js";
import { Store } from "./store.js";
import { BRUSHES, toolsOf } from "./toolbox.js";
import { Unheld } from "./unheld.js";

/** Length of a preview [s], where the scene is no loop. */
const PREVIEW = 3;
/** After this time the host hears of a change whatever moves [ms]. */
const LATEST = 300;
/** Radius of the brush to begin with, in longest sides of the picture. */
const BRUSH = 0.02;

export class Editor {
  /** @param {EditorOptions} options */
  constructor(options) {
    this.options = options;
    this.text = "";
    /** Length of the preview [frames]; 0 follows the scene. */
    this.frames = 0;
    this.brushRadius = 20;
    /** @type {any} until the host hears of the last change; 0 where it has */
    this.untold = 0;
    /** Whether buttons, values and timeline are behind the document. */
    this.stale = false;
    /** @type {Reference | null} rig point whose region is to be drawn anew */
    this.replacing = null;
    /** @type {Point | null} */
    this.pointer = null;
    /** Name of the layer that is selected in the list, empty for none. */
    this.chosen = "";
    this.shown = { mesh: false, items: true, panel: options.moves && !options.picks };
    /** @type {(() => void) | null} looks at the graph at once; from the host */
    this.look = null;
    this.picking = options.picks ? new Picking(this, options.picks) : null;
    this.store = new Store(emptyDocument(1280, 720), {
      show: () => this.show(),
      showSoon: () => this.showSoon(),
      keep: () => this.#keep(),
    });
    this.notes = new Notes();
    this.unheld = new Unheld(this);
    this.scheduler = new Scheduler((now, asked) => this.#draw(now, asked));
    this.backdrop = new Backdrop(this);
    this.commands = new Commands(this);
    this.tools = toolsOf(this, options.groups.flat());
    this.tool = /** @type {import("../stage/tool.js").Tool} */ (this.tools.get(options.groups[0][0]));
    const parts = layout(this);
    this.root = parts.root;
    this.frame = parts.frame;
    this.dialog = parts.dialog;
    this.stage = parts.stage;
    this.toolbar = parts.toolbar;
    this.inspector = parts.inspector;
    this.layerList = parts.layerList;
    this.timeline = parts.timeline;
    this.status = parts.status;
    this.picking?.mount();
    this.layers = new Layers(this.stage);
    this.live = new Live(this.stage.film, options.fetch, {
      redraw: () => this.redraw(),
      trouble: (error) => this.backdrop.trouble(error),
      unheld: (bodies) => this.unheld.show(bodies),
      started: () => this.notes.show("run", ""),
      moved: () => setTimeout(() => this.tell()),
      ended: (end) => (this.inspector.material.moduli = end.stiffness ?? []),
    });
    listenTo(this);
    this.show();
  }

  // What the tools use.

  get document() {
    return this.store.document;
  }

  get selection() {
    return this.store.selection;
  }

  /** Part to which points are added. */
  get part() {
    return this.picking?.part ?? 0;
  }

  newPart() {
    this.picking?.more();
  }

  get pixel() {
    return 1 / this.stage.view.scale;
  }

  /** Handles of the selected item. */
  get handles() {
    const item = itemAt(this.document, this.selection);
    return item && this.selection ? handlesOf(this.document, this.selection, item) : [];
  }

  /**
   * @param {SceneDocument} document
   * @param {Reference | null} [selection]
   * @param {string} [key]
   */
  commit(document, selection, key) {
    this.replacing = null;
    // With the names of the bodies in it the document finds them again where layers come and go.
    const named = withNames(document, this.layerList.layers);
    this.store.commit(withLostHolds(named, this.store.history.present), selection, key);
  }

  /** @param {import("../scene/holds.js").Hold[]} holds  pins that a run has found, which become part of the document */
  takeHolds(holds) {
    const { document, selection } = this;
    const { layers } = this.layerList;
    const held = withFoundHolds(document, holds, layers);
    if (held === document) return;
    const more = held.rig_points.length - (document.rig_points?.length ?? 0);
    const moved = selection?.list === "rig_points" ? { ...selection, index: selection.index + more } : selection;
    this.store.amend((each) => withFoundHolds(each, holds, layers), moved);
  }

  /** @param {SceneDocument} document */
  propose(document) {
    this.store.propose(document);
  }

  /** @param {Reference | null} reference */
  select(reference) {
    this.replacing = null;
    this.store.select(reference);
  }

  /** @param {import("../scene/layers.js").Layer[]} layers  from front to back; none where the picture is flat */
  setLayers(layers) {
    const before = this.layerList.layers.map((layer) => layer.name);
    // Who is not looked at is known by number, which holds as long as the layers are the same.
    if (layers.some((layer, i) => layer.name !== before[i])) this.live.player.unseen.clear();
    this.layerList.setLayers(layers);
    this.inspector.material.layers = layers;
    this.show();
  }

  /** @param {import("../scene/materials.js").Materials | null} materials  of the bodies */
  setMaterials(materials) {
    this.inspector.material.materials = materials;
    this.inspector.body.number = -1;
  }

  /**
   * @param {string} name of the body whose material is shown; empty where it has none
   * @param {number} number  of it
   */
  chooseBody(name, number) {
    this.inspector.body = { name, number };
    this.select(null);
    if (this.layerList.layers.length) this.choose(name);
    else this.show();
  }

  /** @param {import("../scene/layers.js").Layer[]} layers  of which none moves by its name */
  refuseLayers(layers) {
    this.backdrop.waiting = false;
    this.live.setRun(null, null);
    this.setLayers(layers);
    this.backdrop.offerRun(say("No layer moves by its name: switch on in the list what is to move, then run this node."));
    this.redraw();
  }

  /** @param {string} name of the layer to select; empty for none */
  choose(name) {
    this.chosen = name;
    this.inspector.body = { name, number: -1 };
    if (this.chosenLayer) this.layerList.reveal(this.chosenLayer);
    this.show();
  }

  /** @param {Point} point at which somebody clicked beside all that is drawn */
  chooseAt(point) {
    const { materials } = this.inspector.material;
    if (!this.layerList.layers.length && materials) {
      const number = materials.order[this.live.bodyAt(point) ?? -1] ?? -1;
      return this.chooseBody(materials.bodies[number]?.name ?? "", number);
    }
    const index = this.live.layerAt(point);
    this.choose(this.layerList.layers.find((layer) => layer.index === index)?.name ?? "");
  }

  get chosenLayer() {
    return this.layerList.layers.find((layer) => layer.name === this.chosen) ?? null;
  }

  /** @param {string} sentence */
  say(sentence) {
    this.notes.say(sentence);
  }

  /** @param {string[]} sentences about what the node has made; they stay until something changes or it runs again */
  advise(sentences) {
    this.notes.show("advice", sentences.join("\n"), { closes: true });
  }

  redraw() {
    this.scheduler.request();
  }

  // What the host uses.

  /** @param {string} text the value of the node */
  load(text) {
    if (text === this.text) return;
    this.text = text;
    try {
      const document = this.options.format.read(text);
      this.notes.show("value", "");
      // Spelled in another way it is the same scene, with the same steps to undo.
      if (canonical(document) !== canonical(this.document)) this.store.load(document);
      this.resize(document);
    } catch (error) {
      const anew = () => this.commit(emptyDocument(this.document.width, this.document.height), null);
      const { message } = /** @type {Error} */ (error);
      this.notes.show("value", message, { kind: "error", button: [say("Start anew"), anew] });
    }
    this.backdrop.refit();
    this.simulate();
  }

  simulate() {
    if (this.picking) return this.picking.changed();
    if (!this.options.moves) return;
    if (this.live.run && !isAsRun(this.document, this.layerList.layers)) {
      this.live.hold();
      this.backdrop.offerRun(say("Other layers are to move: run this node to see them move."));
    } else if (this.live.run) {
      this.live.request(this.document, this.frameCount);
      if (!this.live.playback.moving && this.live.asked) this.backdrop.prepare();
    } else if (!this.backdrop.arriving) this.backdrop.offerRun();
  }

  get frameCount() {
    const rate = this.document.frame_rate ?? 24;
    return this.frames || Math.max(2, Math.round((this.document.loop ?? PREVIEW) * rate));
  }

  release() {
    clearTimeout(this.untold);
    this.picking?.release();
    this.root.dataset.released = "true";
    this.scheduler.stop();
    this.stage.release();
    this.toolbar.release();
    this.live.release();
    if (this.dialog.open) this.dialog.close();
  }

  // What the parts use.

  /** @param {SceneDocument} document */
  resize(document) {
    if (this.stage.setSize(document, workOf(document))) this.brushRadius = Math.max(1, Math.round(sideOf(document) * BRUSH));
  }

  /**
   * @param {Reference | null} reference  null for the scene itself
   * @param {[string, any][]} changes  values by their paths
   * @param {string} key
   */
  change(reference, changes, key) {
    const { document } = this;
    /** @type {(holder: any) => any} */
    const changed = (holder) => changes.reduce((made, [path, value]) => withValue(made, path, value), holder);
    if (!reference) this.commit(changed(document), this.selection, key);
    else this.commit(withItem(document, reference, changed(itemAt(document, reference))), reference, key);
  }

  /**
   * @param {Point} point
   * @param {PointerEvent} event
   */
  press(point, event) {
    this.pointer = point;
    this.tool.down(point, event);
    this.redraw();
  }

  /** @param {Point | null} point */
  hover(point) {
    this.pointer = point;
    if (point) this.tool.hover(point);
    this.stage.keys.style.cursor = this.stage.spaceHeld ? "grab" : this.tool.cursor;
    if (BRUSHES.includes(this.tool.id)) this.redraw();
  }

  /** Bring buttons, values and timeline up to date at once, and draw. */
  show() {
    this.#showPanels();
    this.redraw();
  }

  /** Do so with the next drawing, where changes may follow each other faster than they are seen. */
  showSoon() {
    this.stale = true;
    this.redraw();
  }

  #showPanels() {
    this.stale = false;
    const { history, selection, document } = this.store;
    const { empty = "" } = this.options;
    if (empty && !this.picking) this.notes.keep("empty", document.query_points?.length ? "" : empty);
    const pressed = { ...this.shown, expand: this.dialog.open };
    for (const id of this.tools.keys()) Object.assign(pressed, { [id]: id === this.tool.id });
    const [past, future] = [history.past.length > 0, history.future.length > 0];
    this.picking?.show();
    this.toolbar.show(pressed, { undo: !past, redo: !future, duplicate: !selection, delete: !selection });
    this.frame.dataset.panel = String(this.shown.panel);
    const paints = BRUSHES.includes(this.tool.id) && this.tool.id !== "erase";
    this.inspector.show(document, selection, paints ? { radius: this.brushRadius } : null);
    this.layerList.show(document, this.chosenLayer, this.live.player.unseen);
    this.live.player.arrange(inOrder(document, this.layerList.layers).map((layer) => layer.index).reverse());
    const { playback } = this.live;
    if (!playback.header) playback.duration = this.frameCount;
    playback.frameRate = document.frame_rate ?? 24;
    this.timeline.showItems(document, selection, playback.duration / playback.frameRate);
  }

  /** Place of the chosen body from the back where the picture is flat; -1 for none. */
  get #chosenBody() {
    const { body, material } = this.inspector;
    return body.number < 0 || this.layerList.layers.length ? -1 : (material.materials?.order.indexOf(body.number) ?? -1);
  }

  /** What the tool does, how large the picture is shown, and its size. */
  #showStatus() {
    const { width, height } = this.document;
    const zoom = Math.round(this.stage.view.scale * 100);
    const said = [this.picking?.viewed ? say("The frames of the last run") : ACTIONS[this.tool.id].title, `${zoom} % · ${width} × ${height} px`];
    const parts = [this.status.firstElementChild?.firstElementChild, this.status.lastElementChild];
    parts.forEach((part, i) => part && part.textContent !== said[i] && Object.assign(part, { textContent: said[i], title: said[i] }));
  }

  /** Let the host hear of the last change at once, if it has not yet. */
  tell() {
    if (!this.untold) return;
    clearTimeout(this.untold);
    this.untold = 0;
    this.options.onKept();
  }

  #keep() {
    this.tell();
    this.simulate();
    this.text = this.options.format.write(this.document);
    this.notes.show("value", "");
    this.notes.show("advice", "");
    this.resize(this.document);
    this.options.onChange(this.text);
    // What the host does about a change can take longer than the simulation of the first frames, which it would hold up.
    this.untold = setTimeout(() => this.tell(), LATEST);
    if (!this.live.playback.waiting) this.tell();
  }

  /**
   * @param {number} now  [ms]
   * @param {boolean} asked  whether something besides the time has changed
   */
  #draw(now, asked) {
    const { stage, live } = this;
    const { shown: frame, plays } = live.playback;
    // An editor out of sight rests; it is drawn again when it gets its size back.
    const more = live.playback.advance(now) && stage.across > 0;
    if (!asked && frame === live.playback.shown && plays === live.playback.plays) return more;
    if (this.stale) this.#showPanels();
    const { shows } = live;
    const meshShown = this.shown.mesh || !live.player.ready;
    const brushing = BRUSHES.includes(this.tool.id) && this.pointer;
    this.layers.draw({
      document: this.document,
      settled: this.store.history.present,
      selection: this.selection,
      view: stage.view,
      background: shows ? null : this.backdrop.picture,
      restingMesh: meshShown && !live.playback.shown ? live.mesh : null,
      movingMesh: meshShown && live.playback.shown && !shows ? live.mesh : null,
      frame: live.playback.shown,
      unit: live.unit,
      draft: this.tool.draft,
      cuts: this.shown.items ? (this.picking?.cuts ?? null) : null,
      brush: brushing ? { at: brushing, radius: this.brushRadius } : null,
      itemsShown: this.shown.items,
      particlesShown: !this.picking,
      outline: this.chosenLayer ? live.outlineOf(this.chosenLayer.index) : live.outlineOfBody(this.#chosenBody),
    });
    live.draw(stage.view, stage.across, stage.down, this.shown.mesh);
    stage.bars.show(stage.view, stage.size, stage.across, stage.down);
    this.#showStatus();
    if (this.options.moves) this.timeline.showPosition(live.playback);
    return more;
  }
}
