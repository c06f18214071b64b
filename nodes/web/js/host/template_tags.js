/** Tags of the templates that are words of a language; names of models and file formats are the same in all. */

import { words } from "./words.js";

export const TAGS = words(
  "physics", "hair", "cloth", "wind", "cut out", "puppet", "pin", "layers", "rig", "loop", "sway", "collision", "contact",
  "weight paint", "stiffness", "metrics", "compare", "figure", "material", "mesh", "optical flow", "sketch", "inpainting",
  "clean plate", "anime", "interpolation", "smooth", "video", "tracks", "line art", "keyframes", "inbetween", "paper",
);
