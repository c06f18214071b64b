/** The look of the editor, in the host's colours; every class carries the pack's name. */
export const STYLE = `
.physanimator-editor {
  --physanimator-back: var(--comfy-menu-bg, #1e1e22);
  --physanimator-field: var(--comfy-input-bg, #2a2a30);
  --physanimator-text: var(--input-text, #ddd);
  --physanimator-dim: var(--descrip-text, #999);
  --physanimator-rim: var(--border-color, #4e4e54);
  --physanimator-accent: var(--p-primary-color, #3b82f6);
  container-type: size;
  box-sizing: border-box; width: 100%; height: 100%; min-height: max(300px, var(--node-height, 0px) - 180px);
  color: var(--physanimator-text); font: 13px/1.35 Inter, system-ui, sans-serif; text-align: left; scrollbar-color: var(--physanimator-dim) transparent;
}
.physanimator-editor *, .physanimator-editor *::before { box-sizing: border-box; }
.physanimator-frame {
  display: grid; width: 100%; height: 100%; min-height: 0; overflow: hidden; border-radius: 6px;
  background: var(--physanimator-back); border: 1px solid var(--physanimator-rim);
  grid-template: "toolbar toolbar" auto "stage inspector" minmax(0, 1fr) "status inspector" auto "timeline timeline" auto / minmax(0, 1fr) 232px;
}
.physanimator-frame[data-panel="false"] { grid-template-columns: minmax(0, 1fr) 0; }
.physanimator-frame[data-panel="false"] .physanimator-side { display: none; }
.physanimator-toolbar { grid-area: toolbar; display: flex; flex-wrap: wrap; gap: 2px 0; padding: 3px; border-bottom: 1px solid var(--physanimator-rim); }
.physanimator-tools, .physanimator-actions { display: contents; }
.physanimator-title { display: none; margin: 0; font-size: 18px; font-weight: 600; }
.physanimator-label { margin-left: 5px; white-space: nowrap; }
.physanimator-toolbar:is(:not([data-labels]), [data-labels="none"]) .physanimator-label { display: none; }
.physanimator-toolbar[data-labels="tools"] .physanimator-actions .physanimator-label { display: none; }
.physanimator-group { display: flex; gap: 1px; padding: 0 4px; border-right: 1px solid var(--physanimator-rim); }
.physanimator-actions .physanimator-group:last-child, .physanimator-tools:last-child .physanimator-group:last-child { border-right: 0; }
.physanimator-editor button {
  display: inline-flex; align-items: center; justify-content: center; min-width: 26px; height: 26px; margin: 0; padding: 0 4px;
  color: inherit; background: transparent; border: 1px solid transparent; border-radius: 5px; font: inherit; cursor: pointer;
}
.physanimator-editor button:hover:not(:disabled) { background: var(--physanimator-field); }
.physanimator-editor button[aria-pressed="true"], .physanimator-editor button[aria-pressed="true"]:hover:not(:disabled) { color: #fff; background: var(--physanimator-accent); }
.physanimator-editor button:disabled { opacity: 0.35; cursor: default; }
.physanimator-editor :is(button, input, select, canvas, textarea):focus-visible { outline: 2px solid var(--physanimator-accent); outline-offset: -2px; }
.physanimator-stage { grid-area: stage; position: relative; min-width: 0; min-height: 0; overflow: hidden;
  background: repeating-conic-gradient(rgba(128, 128, 128, 0.16) 0% 25%, transparent 0% 50%) 0 0 / 20px 20px, var(--physanimator-field); }
.physanimator-stage canvas { position: absolute; inset: 0; width: 100%; height: 100%; pointer-events: none; }
.physanimator-editor input.physanimator-keys { position: absolute; inset: 0; width: 100%; height: 100%; margin: 0; padding: 0; border: 0; opacity: 0; touch-action: none; user-select: none; cursor: crosshair; }
.physanimator-scroll { position: absolute; inset: auto 9px 0 0; height: 9px; touch-action: none; background: rgba(128, 128, 128, 0.18); }
.physanimator-scroll[data-way="down"] { inset: 0 0 9px auto; width: 9px; height: auto; }
.physanimator-scroll[hidden] { display: none; }
.physanimator-handle { position: absolute; height: 100%; border-radius: 5px; border: 2px solid transparent; background: var(--physanimator-dim) padding-box; }
.physanimator-scroll[data-way="down"] .physanimator-handle { width: 100%; }
.physanimator-scroll:hover .physanimator-handle { background: var(--physanimator-text) padding-box; }
.physanimator-stage:focus-within { box-shadow: inset 0 0 0 1px var(--physanimator-accent); }
.physanimator-notes { position: absolute; inset: auto 8px 8px; display: flex; flex-direction: column; align-items: flex-start; gap: 4px; pointer-events: none; }
.physanimator-note { max-width: 100%; padding: 4px 8px; border-radius: 5px; color: #fff; background: rgba(16, 18, 24, 0.86); overflow-wrap: anywhere; }
.physanimator-note[data-kind="error"], .physanimator-note button { pointer-events: auto; }
.physanimator-notes[data-away] { opacity: 0.15; }
.physanimator-note[data-kind="error"] { background: rgba(150, 28, 36, 0.94); }
.physanimator-note button { color: #fff; background: var(--physanimator-accent); margin-left: 8px; padding: 0 8px; }
.physanimator-note button:hover:not(:disabled) { background: var(--physanimator-accent); filter: brightness(1.15); }
.physanimator-note .physanimator-close, .physanimator-note .physanimator-close:hover:not(:disabled) { float: right; min-width: 20px; height: 20px; padding: 0; background: transparent; }
.physanimator-side { grid-area: inspector; display: flex; flex-direction: column; min-height: 0; border-left: 1px solid var(--physanimator-rim); }
.physanimator-inspector { flex: 1 1 0; min-height: 0; overflow: auto; padding: 6px 8px; scrollbar-width: thin; }
.physanimator-layers { flex: 0 1 auto; max-height: 55%; min-height: 84px; display: flex; flex-direction: column; padding: 6px 4px 4px 8px; border-bottom: 1px solid var(--physanimator-rim); }
.physanimator-layers[hidden] { display: none; }
.physanimator-layer-list { flex: 1; min-height: 0; margin: 0; padding: 0; overflow: auto; list-style: none; scrollbar-width: thin; }
.physanimator-layer { padding-right: 4px; border-radius: 4px; }
.physanimator-layer-line { display: flex; align-items: center; gap: 3px; height: 24px; }
.physanimator-layer-said { flex: 0 1 auto; min-width: 0; overflow: hidden; text-overflow: ellipsis; white-space: nowrap; color: var(--physanimator-dim); font-size: 12px; cursor: pointer; }
.physanimator-layer-said[hidden], .physanimator-editor .physanimator-layer:not([data-chosen="true"]) button.physanimator-place { display: none; }
.physanimator-layer-more { display: flex; gap: 4px; height: 23px; padding: 0 0 3px 6px; }
.physanimator-layer-more[hidden] { display: none; }
.physanimator-layer[data-target="above"] { box-shadow: 0 -2px var(--physanimator-accent); }
.physanimator-layer[data-target="below"] { box-shadow: 0 2px var(--physanimator-accent); }
.physanimator-layer[data-chosen="true"] { background: var(--physanimator-field); box-shadow: inset 2px 0 var(--physanimator-accent); }
.physanimator-layer[data-shown="false"] { opacity: 0.5; }
.physanimator-editor .physanimator-layer button { height: 22px; padding: 0 2px; }
.physanimator-editor .physanimator-layer button.physanimator-eye[aria-pressed] { min-width: 22px; color: var(--physanimator-text); background: transparent; }
.physanimator-editor .physanimator-layer button.physanimator-eye[aria-pressed="false"] { opacity: 0.3; }
.physanimator-editor .physanimator-layer button.physanimator-layer-name[aria-pressed] { flex: 1 0 30%; touch-action: none; min-width: 0; display: block; text-align: left; color: var(--physanimator-text); background: transparent; overflow: hidden; text-overflow: ellipsis; white-space: nowrap; }
.physanimator-editor .physanimator-layer button.physanimator-place { flex: none; min-width: 18px; }
.physanimator-editor .physanimator-layer select { flex: 1 1 0; min-width: 0; height: 20px; padding: 0; appearance: auto; }
.physanimator-list-only { display: flex; flex-direction: column; min-height: 120px; border: 1px solid var(--physanimator-rim); border-radius: 6px; background: var(--physanimator-back); overflow: hidden; }
.physanimator-list-only .physanimator-layers { flex: 1; max-height: none; border-bottom: 0; }
.physanimator-list-line { display: flex; align-items: center; justify-content: space-between; gap: 8px; padding: 4px 8px; color: var(--physanimator-dim); }
.physanimator-editor .physanimator-list-line button { flex: none; color: #fff; background: var(--physanimator-accent); padding: 0 10px; }
.physanimator-editor .physanimator-list-line button[hidden], .physanimator-list-line:has(> div:empty) { display: none; }
.physanimator-layer input[type="checkbox"] { flex: none; margin: 0; }
.physanimator-heading { margin: 2px 0 6px; font-weight: 600; }
.physanimator-field { display: flex; flex-wrap: wrap; align-items: center; justify-content: space-between; gap: 0 6px; min-height: 26px; }
.physanimator-editor input[type="range"] { appearance: none; height: 14px; padding: 0; border: 0; background: linear-gradient(var(--physanimator-rim) 0 0) center / 100% 3px no-repeat; cursor: pointer; touch-action: none; }
.physanimator-editor input[type="range"]:disabled { opacity: 0.4; cursor: default; }
.physanimator-editor input[type="range"]::-webkit-slider-thumb { appearance: none; width: 12px; height: 12px; border-radius: 50%; background: var(--physanimator-accent); }
.physanimator-editor input[type="range"]::-moz-range-thumb { width: 12px; height: 12px; border: 0; border-radius: 50%; background: var(--physanimator-accent); }
.physanimator-editor input.physanimator-slide { flex: 1 0 100%; width: 100%; margin: 0 0 4px; }
.physanimator-caption { min-width: 0; overflow-wrap: anywhere; }
.physanimator-section { justify-content: flex-start; margin-top: 8px; font-weight: 600; }
.physanimator-caption { color: var(--physanimator-dim); }
.physanimator-inputs { display: flex; align-items: center; gap: 4px; }
.physanimator-unit { width: 48px; color: var(--physanimator-dim); font-size: 12px; white-space: nowrap; }
.physanimator-editor :is(input[type="number"], select) {
  width: 56px; height: 22px; margin: 0; padding: 0 4px; color: var(--physanimator-text); background: var(--physanimator-field);
  border: 1px solid var(--physanimator-rim); border-radius: 4px; font: inherit; appearance: textfield;
}
.physanimator-editor .physanimator-inputs select { width: 104px; padding: 0; appearance: auto; }
.physanimator-editor input[aria-invalid] { border-color: #f44; }
.physanimator-inputs input[type="number"] + input[type="number"] { margin-left: 0; }
.physanimator-field[data-field="gravity"] input, .physanimator-field[data-field="motion.direction"] input { width: 44px; }
.physanimator-field:is([data-field="mu"], [data-field="lambda"], [data-field="youngs_modulus"]) input { width: 78px; }
.physanimator-table { display: block; padding: 1px 0; }
.physanimator-key { display: flex; align-items: center; gap: 4px; margin-top: 2px; }
.physanimator-keyhead { justify-content: space-between; }
.physanimator-table button { height: 22px; white-space: nowrap; background: var(--physanimator-field); }
.physanimator-timeline { grid-area: timeline; border-top: 1px solid var(--physanimator-rim); }
.physanimator-bar { display: flex; align-items: center; gap: 4px; height: 30px; padding: 2px 6px; contain: strict; }
.physanimator-slider { flex: 1; min-width: 40px; margin: 0; }
.physanimator-readout { min-width: 84px; text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.physanimator-editor input.physanimator-length { width: 48px; }
.physanimator-bar .physanimator-unit, .physanimator-key .physanimator-unit { width: auto; }
.physanimator-lanes { --physanimator-names: 104px; position: relative; height: 62px; margin: 0 6px 4px; overflow-y: auto; scrollbar-width: thin; scrollbar-gutter: stable; }
.physanimator-track { position: relative; min-height: 100%; overflow: hidden; contain: layout paint style; }
.physanimator-row { display: flex; align-items: center; height: 19px; border-radius: 3px; cursor: pointer; }
.physanimator-lane-name { flex: none; width: var(--physanimator-names); padding: 0 6px 0 2px; overflow: hidden; text-overflow: ellipsis; white-space: nowrap; font-size: 12px; color: var(--physanimator-dim); }
.physanimator-lane { position: relative; flex: 1; min-width: 0; height: 13px; border-radius: 2px; background: rgba(128, 128, 128, 0.16); }
.physanimator-row[data-selected="true"] { background: var(--physanimator-field); }
.physanimator-row[data-selected="true"] .physanimator-lane-name { color: var(--physanimator-text); }
.physanimator-row[data-selected="true"] .physanimator-lane { outline: 1px solid var(--physanimator-text); outline-offset: -1px; }
.physanimator-ruler { position: absolute; inset: 0 0 0 var(--physanimator-names); overflow: hidden; pointer-events: none; }
.physanimator-span { position: absolute; inset: 2px auto 2px 0; border-radius: 2px; background: var(--physanimator-colour); opacity: 0.75; }
.physanimator-tick { position: absolute; inset: 0 auto 0 0; width: 2px; background: var(--physanimator-colour); }
.physanimator-edge { position: absolute; top: -1px; bottom: -1px; width: 9px; margin-left: -4px; cursor: ew-resize; touch-action: none; }
.physanimator-edge[data-edge="start"] { margin-left: 0; }
.physanimator-edge[data-edge="end"] { margin-left: -9px; }
.physanimator-edge::before { content: ""; position: absolute; inset: 0 0 0 auto; width: 3px; border-radius: 1px; background: var(--physanimator-text); opacity: 0; }
.physanimator-edge[data-edge="start"]::before { inset: 0 auto 0 0; }
.physanimator-lane:hover .physanimator-edge::before, .physanimator-row[data-selected="true"] .physanimator-edge::before { opacity: 0.9; }
.physanimator-now { position: absolute; inset: 0; width: calc(100% - 1px); border-left: 1px solid var(--physanimator-text); pointer-events: none; }
.physanimator-dialog { container-type: inline-size; width: 100vw; height: 100vh; max-width: none; max-height: none; margin: 0; padding: 10px; border: 0; background: rgba(0, 0, 0, 0.7); }
.physanimator-status { grid-area: status; display: flex; justify-content: space-between; gap: 4px 12px; min-width: 0; padding: 3px 8px; border-top: 1px solid var(--physanimator-rim);
  color: var(--physanimator-dim); font-size: 12px; font-variant-numeric: tabular-nums; }
.physanimator-status > * { overflow: hidden; text-overflow: ellipsis; white-space: nowrap; }
.physanimator-status > :first-child { white-space: normal; }
.physanimator-status > :last-child { flex: none; }
.physanimator-said { display: grid; }
.physanimator-said > * { grid-area: 1 / 1; min-width: 0; overflow: hidden; text-overflow: ellipsis; }
.physanimator-said > [aria-hidden] { visibility: hidden; }
.physanimator-empty { padding: 6px 2px; color: var(--physanimator-dim); }
.physanimator-dialog .physanimator-frame {
  color: var(--physanimator-text); font-size: 14px; grid-template: "toolbar toolbar toolbar" auto "tools stage inspector" minmax(0, 1fr) "tools status inspector" auto "timeline timeline timeline" auto / auto minmax(0, 1fr) 264px;
}
.physanimator-dialog .physanimator-frame[data-panel="false"] { grid-template-columns: auto minmax(0, 1fr) 0; }
.physanimator-dialog .physanimator-toolbar { display: contents; }
.physanimator-dialog .physanimator-title { display: block; grid-area: toolbar; align-self: center; padding: 6px 12px; }
.physanimator-dialog .physanimator-actions { grid-area: toolbar; justify-self: end; display: flex; flex-wrap: wrap; justify-content: flex-end; gap: 2px 0; max-width: calc(100% - 180px); padding: 6px; }
.physanimator-dialog .physanimator-tools { grid-area: tools; display: flex; flex-direction: column; gap: 6px; padding: 6px; overflow-y: auto; scrollbar-width: thin; border-top: 1px solid var(--physanimator-rim); border-right: 1px solid var(--physanimator-rim); }
.physanimator-dialog .physanimator-tools .physanimator-group { flex-direction: column; padding: 0 0 6px; border-right: 0; border-bottom: 1px solid var(--physanimator-rim); }
.physanimator-dialog .physanimator-tools .physanimator-group:last-child { border-bottom: 0; }
.physanimator-dialog .physanimator-tools button { justify-content: flex-start; padding: 0 10px 0 7px; }
.physanimator-dialog .physanimator-toolbar .physanimator-tools .physanimator-label { display: inline; }
.physanimator-dialog .physanimator-toolbar .physanimator-actions .physanimator-label { display: inline; }
.physanimator-dialog :is(.physanimator-stage, .physanimator-side) { border-top: 1px solid var(--physanimator-rim); }
.physanimator-dialog :is(.physanimator-tools, .physanimator-actions, .physanimator-bar) button { min-width: 36px; height: 36px; }
.physanimator-dialog :is(.physanimator-tools, .physanimator-bar) svg { width: 22px; height: 22px; }
.physanimator-dialog .physanimator-heading { font-size: 15px; }
.physanimator-dialog .physanimator-field { min-height: 30px; }
.physanimator-dialog .physanimator-bar { height: 42px; }
.physanimator-dialog .physanimator-lanes { --physanimator-names: 180px; height: 100px; }
.physanimator-dialog .physanimator-row { height: 24px; }
.physanimator-dialog .physanimator-lane { height: 16px; }
.physanimator-dialog .physanimator-lane-name { font-size: 13px; }
@media (max-width: 1350px) {
  .physanimator-dialog .physanimator-toolbar .physanimator-actions .physanimator-label { display: none; }
}
@media (max-width: 760px), (max-height: 620px) {
  .physanimator-dialog .physanimator-toolbar .physanimator-tools .physanimator-label { display: none; }
  .physanimator-dialog .physanimator-lanes { height: 54px; }
}
@container (max-width: 519px) {
  .physanimator-status > :first-child { white-space: nowrap; }
  .physanimator-bar .physanimator-unit { display: none; }
  .physanimator-editor > .physanimator-frame, .physanimator-editor > .physanimator-frame[data-panel="false"] {
    grid-template: "toolbar" max-content "stage" minmax(140px, 1fr) "status" max-content "inspector" max-content "timeline" max-content / minmax(0, 1fr); overflow-y: auto; scrollbar-width: thin;
  }
  .physanimator-editor > .physanimator-frame .physanimator-inspector { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); column-gap: 14px; align-content: start;
    grid-auto-rows: max-content; flex: none; max-height: 150px; }
  .physanimator-editor > .physanimator-frame .physanimator-side { border-left: 0; border-top: 1px solid var(--physanimator-rim); }
  .physanimator-layers { max-height: 110px; }
  .physanimator-editor > .physanimator-frame .physanimator-timeline { position: sticky; bottom: 0; z-index: 1; background: var(--physanimator-back); }
  .physanimator-heading, .physanimator-section, .physanimator-table, .physanimator-field[data-field="region"] { grid-column: 1 / -1; }
}
@container (max-width: 379px) {
  .physanimator-editor > .physanimator-frame .physanimator-group { display: contents; }
  .physanimator-editor > .physanimator-frame .physanimator-inspector { grid-template-columns: minmax(0, 1fr); }
  .physanimator-status { flex-wrap: wrap; }
  .physanimator-status > :first-child { white-space: normal; }
  .physanimator-editor > .physanimator-frame .physanimator-notes { inset: auto 4px 4px; }
  .physanimator-editor > .physanimator-frame .physanimator-note { padding: 2px 6px; font-size: 12px; line-height: 1.25; }
  .physanimator-editor > .physanimator-frame .physanimator-note button { height: 20px; margin-left: 6px; }
  .physanimator-lanes { --physanimator-names: 72px; }
  .physanimator-bar { flex-wrap: wrap; height: auto; contain: none; }
  .physanimator-slider { order: 1; flex: 1 0 100%; }
  .physanimator-readout { flex: 1; }
}
@media (pointer: coarse) {
  .physanimator-editor button { min-width: 34px; height: 34px; }
  .physanimator-bar { height: 40px; }
  .physanimator-editor .physanimator-row { height: 26px; }
  .physanimator-editor .physanimator-lane { height: 22px; }
  .physanimator-editor input.physanimator-slide { height: 24px; }
  .physanimator-edge { width: 20px; }
  .physanimator-scroll { height: 18px; }
  .physanimator-scroll[data-way="down"] { width: 18px; }
}
`;
